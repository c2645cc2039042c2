//! Passages that look blocked; the robot tries them when nothing else is left.
//!
//! A corridor with cells that look covered. Beyond them are rooms that end with an unknown cell. The
//! robot sees its neighbours.

use super::corridor::{Corridor, plain, two_bins};
use covmap::Cell;
use covmap_plan::{PlannerParameters, Strategy};

/// A robot that tries passages of up to `length` [m].
fn corridor(cells: usize, length: f64, unknown: &[i32], covered: &[i32]) -> Corridor {
    let parameters = PlannerParameters { passage_length: length, ..plain(Strategy::Cl) };
    let mut corridor = Corridor::new(cells, &[0.0, 180.0], &two_bins(1.0), &parameters);
    corridor.free_but(unknown);
    covered.iter().for_each(|x| corridor.know(*x, &[0.001, 0.999]));
    corridor
}

/// The passage that is tried.
fn passage(corridor: &mut Corridor, from: i32) -> Option<Vec<i32>> {
    let decision = corridor.choose(from)?;
    Some(decision.passage.iter().map(|cell| cell.x).collect())
}

#[test]
fn a_passage_is_tried_up_to_its_length() {
    // Two covered cells between the robot and a room.
    let tried = |length| passage(&mut corridor(12, length, &[11], &[3, 4]), 0);
    assert_eq!([2.0, 1.99].map(tried), [Some(vec![3, 4]), None]);
    // The robot does not try it again after a bump.
    let mut corridor = corridor(12, 2.0, &[11], &[3, 4]);
    corridor.planner.bump(Cell::new(3, 0), Cell::new(4, 0), nalgebra::Point2::origin());
    assert_eq!(passage(&mut corridor, 0), None);
}

#[test]
fn what_can_be_reached_without_a_passage_comes_first() {
    let mut corridor = corridor(12, 2.0, &[0, 11], &[5]);
    assert_eq!((passage(&mut corridor, 3), corridor.target(3)), (Some(vec![]), 1));
    corridor.know(0, &[0.999, 0.001]);
    assert_eq!((passage(&mut corridor, 3), corridor.target(3)), (Some(vec![5]), 10));
}

#[test]
fn a_passage_to_a_pocket_is_not_tried() {
    // Beyond cell 3 lie four cells of the size of the robot, or three.
    let tried = |cells: usize, unknown| passage(&mut corridor(cells, 2.0, &[unknown], &[3]), 0);
    assert_eq!((tried(9, 8), tried(8, 7)), (Some(vec![3]), None));
}

#[test]
fn the_nearest_passage_is_tried_first() {
    // Rooms at both ends, behind the cells 6 and 13.
    let mut corridor = corridor(20, 1.0, &[0, 19], &[6, 13]);
    assert_eq!([8, 11].map(|from| passage(&mut corridor, from).unwrap()), [[6], [13]]);
}
