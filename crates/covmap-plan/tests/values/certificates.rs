//! The status of each cell: the first that applies.

use super::corridor::{Corridor, plain, two_bins};
use covmap_plan::CellStatus::{Exhausted, NotSeen, Open, Outside, Resolved, Unreachable};
use covmap_plan::{PlannerParameters, StallRule, Strategy};

/// A robot that looks 2 m to the right along twelve cells; the last two lie outside. It does not know
/// the cells 3, 5, 10 and 11.
fn corridor() -> Corridor {
    let (model, parameters) = (two_bins(2.0), plain(Strategy::Cl));
    let mut corridor = Corridor::build(12, &[0.0], &model, &parameters, 0.3, |x| x >= 10);
    corridor.free_but(&[3, 5, 10, 11]);
    corridor
}

#[test]
fn every_cell_has_one_word() {
    let mut corridor = corridor();
    let statuses: Vec<_> = (0..12).map(|x| corridor.status(0, x)).collect();
    // The robot gets as far as cell 2, from where it sees 3 and 4. Cell 5 may come into sight later;
    // a resolved cell is resolved from anywhere.
    let mut expected = [Resolved; 12];
    (expected[3], expected[5]) = (Open, NotSeen);
    (expected[10], expected[11]) = (Outside, Outside);
    assert_eq!(statuses, expected);
    // When no cell is open, or behind a wall, cell 5 does not.
    corridor.know(3, &[0.001, 0.999]);
    assert_eq!(corridor.status(0, 5), Unreachable);
    // A known cell outside is outside none the less.
    corridor.know(10, &[0.999, 0.001]);
    assert_eq!(corridor.status(0, 10), Outside);
}

#[test]
fn a_cell_is_resolved_with_an_entropy_of_at_most_epsilon() {
    let mut corridor = corridor();
    // ε = .1: .0980 and .1058.
    corridor.know(3, &[0.98, 0.02]);
    assert_eq!(corridor.status(0, 3), Resolved);
    corridor.know(3, &[0.978, 0.022]);
    assert_eq!(corridor.status(0, 3), Open);
    // Beyond cell 3, which is free now, the robot sees cell 5.
    assert_eq!(corridor.status(0, 5), Open);
}

#[test]
fn a_cell_that_is_given_up_is_exhausted_also_out_of_sight() {
    let mut corridor = corridor();
    corridor.look(2, 3, 0.5);
    (0..5).for_each(|_| corridor.look_in_vain(2));
    assert_eq!(corridor.status(0, 3), Exhausted);
    corridor.know(1, &[0.01, 0.99]);
    assert_eq!(corridor.status(0, 3), Exhausted);
    // When the cell is known after all, it is resolved.
    corridor.know(3, &[0.999, 0.001]);
    assert_eq!(corridor.status(0, 3), Resolved);
}

#[test]
fn what_is_hidden_behind_a_wall_is_out_of_reach() {
    let mut corridor = corridor();
    corridor.know(1, &[0.01, 0.99]);
    assert_eq!([1, 3].map(|x| corridor.status(0, x)), [Resolved, Unreachable]);
    // From beyond the wall the cell is open.
    assert_eq!(corridor.status(2, 3), Open);
}

#[test]
fn open_cells_are_those_that_are_known_and_not_finished() {
    let mut corridor = corridor();
    let open = |corridor: &Corridor| corridor.planner.open_cells(&corridor.map);
    assert_eq!(open(&corridor), 0);
    // One cell is not resolved; then it is given up, and there is another one.
    corridor.look(2, 3, 0.5);
    assert_eq!(open(&corridor), 1);
    (0..5).for_each(|_| corridor.look_in_vain(2));
    assert_eq!(open(&corridor), 0);
    corridor.know(5, &[0.8, 0.2]);
    assert_eq!(open(&corridor), 1);
}

#[test]
fn what_no_measurement_touched_is_not_resolved() {
    // ε = .7 is above ln 2, the entropy of an unknown cell.
    let parameters = PlannerParameters { entropy_threshold: 0.7, ..plain(Strategy::Cl) };
    let mut corridor = Corridor::new(6, &[0.0], &two_bins(2.0), &parameters);
    corridor.free_but(&[4]);
    assert_eq!((corridor.status(0, 4), corridor.candidates(0)), (Open, vec![2, 3]));
    corridor.know(4, &[0.5, 0.5]);
    assert_eq!((corridor.status(0, 4), corridor.candidates(0)), (Resolved, vec![]));
}

#[test]
fn what_lies_outside_is_no_reason() {
    let (model, parameters) = (two_bins(2.0), plain(Strategy::Cl));
    let mut corridor = Corridor::build(6, &[0.0], &model, &parameters, 0.3, |x| x >= 4);
    corridor.free_but(&[4, 5]);
    assert_eq!(corridor.candidates(0), [0; 0]);
}

#[test]
fn a_cell_in_sight_from_too_far_away_is_neither_open_nor_exhausted() {
    // The robot gets no nearer than 4 m to cell 7; after a stall from 6 m the limit is 3 m.
    let mut parameters = plain(Strategy::Cl);
    parameters.stall_rule = StallRule::Banded { first: 6.0, closest: 1.0 };
    let mut corridor = Corridor::new(8, &[0.0], &two_bins(6.0), &parameters);
    corridor.free_but(&[4, 7]);
    assert_eq!(corridor.status(0, 7), Open);
    corridor.look(1, 7, 0.6);
    (0..5).for_each(|_| corridor.look_in_vain(1));
    assert!(![Open, Exhausted, Resolved].contains(&corridor.status(0, 7)));
}
