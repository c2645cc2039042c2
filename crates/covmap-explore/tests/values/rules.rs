//! The rules of the loop, with a robot in a corridor that does as it is told.

use super::{all_close, close, mission};
use covmap::Cell;
use covmap_explore::{Ending, Event, Limits, Robot, Run, explore};
use covmap_plan::CellStatus;
use covmap_sonar::Range;
use covmap_world::Drive;
use nalgebra::{Isometry2, Point2};
use std::ops::ControlFlow;

/// Nothing answers it, and it bumps into a wall at `wall` [m] with its front, .3 m ahead.
struct Told {
    beams: usize,
    wall: f64,
}

impl Robot for Told {
    fn sense(&mut self, _: &Isometry2<f64>) -> Vec<Range> {
        vec![Range::NoEcho; self.beams]
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Drive {
        let stop = self.wall - 0.3;
        if to.x <= stop { Drive::Arrived } else { Drive::Bumped { at: Point2::new(stop, from.y) } }
    }
}

/// A run along six cells from the middle of the second, with rays of 1 m to both sides.
fn run(wall: f64, limits: Limits) -> (Run, Vec<Event>) {
    let mission = mission(6, &[0.0, 180.0], 1.0, limits);
    let mut events = Vec::new();
    let run = explore(&mission, &mut Told { beams: 2, wall }, &mut |event, _| {
        events.push(event.clone());
        ControlFlow::Continue(())
    });
    (run.unwrap(), events)
}

/// Where the scans were taken [m].
fn places(run: &Run) -> Vec<f64> {
    run.scans.iter().map(|scan| scan.pose.translation.x).collect()
}

fn budget(scans: usize, while_driving: Option<f64>) -> Limits {
    Limits { while_driving, max_scans: Some(scans) }
}

#[test]
fn after_a_bump_the_robot_goes_back_to_where_it_came_from() {
    // It gets from 2.5 m as far as 3 m on its way to 3.5 m.
    let (run, events) = run(3.3, Limits::default());
    let bump = events.iter().position(|e| matches!(e, Event::Bump { .. })).unwrap();
    let Event::Bump { cell, at, towards } = &events[bump] else { panic!() };
    assert_eq!(*cell, Cell::new(3, 0));
    close(at.x, 3.0, 1e-12);
    close(towards.x, 3.5, 1e-12);
    let xs: Vec<f64> = run.trajectory.iter().map(|p| p.x).collect();
    let turn = xs.iter().position(|x| (x - 3.0).abs() < 1e-12).unwrap();
    all_close(&xs[turn - 1..turn + 2], &[2.5, 3.0, 2.5], 1e-12);
    // The way there and back is driven.
    let length: f64 = xs.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    close(run.path_length, length, 1e-12);
    assert!(xs.iter().all(|x| *x <= 3.0 + 1e-12));
    // The next decision is made from the cell that it came from, and no one enters that cell.
    let next = events[bump..].iter().find_map(|e| match e {
        Event::Decision { from, .. } => Some(*from),
        _ => None,
    });
    assert!(next.is_none_or(|from| from == Cell::new(2, 0)));
    let entered = events[bump + 1..].iter().any(
        |e| matches!(e, Event::Decision { decision, .. } if decision.path.contains(&Cell::new(3, 0))),
    );
    assert!(!entered);
    assert_eq!(run.bumps, 1);
    assert!(run.certificate.values().iter().all(|status| *status != CellStatus::Open));
}

#[test]
fn the_robot_measures_at_view_points() {
    let (run, events) = run(f64::INFINITY, budget(4, None));
    assert_eq!((run.ending, run.scans.len()), (Ending::BudgetSpent, 4));
    let targets = events.iter().filter_map(|e| match e {
        Event::Decision { decision, .. } => Some(f64::from(decision.target.x) + 0.5),
        _ => None,
    });
    let expected: Vec<f64> = std::iter::once(1.5).chain(targets).collect();
    all_close(&places(&run), &expected[..4], 1e-12);
    // At .5 m/s.
    let mut way = 0.0;
    for (scan, before) in run.scans.iter().zip(std::iter::once(1.5).chain(places(&run))) {
        way += (scan.pose.translation.x - before).abs();
        close(scan.time, way / 0.5, 1e-9);
    }
    assert_eq!(run.decisions, 3);
}

#[test]
fn the_robot_measures_every_so_many_metres_on_its_way() {
    // From 1.5 m to the view-point at 2.5 m, from there to 3.5 m, …: every .4 m since the last scan.
    let (run, events) = run(f64::INFINITY, budget(7, Some(0.4)));
    let moves: Vec<f64> = places(&run).windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(moves.iter().all(|way| way.abs() <= 0.4 + 1e-9), "{moves:?}");
    assert!(moves.iter().any(|way| (way.abs() - 0.4).abs() < 1e-9), "{moves:?}");
    assert!(moves.iter().any(|way| (way.abs() - 0.2).abs() < 1e-9), "{moves:?}");
    assert_eq!(run.scans.len(), 7);
    let scans = events.iter().filter(|e| matches!(e, Event::Scan { .. })).count();
    assert_eq!(scans, 7);
}

#[test]
fn where_the_robot_stood_is_free_and_what_it_sees_is_measured() {
    let (run, _) = run(f64::INFINITY, budget(1, None));
    // The cells beside it got one reading without an echo; a cell of 1 m is wider than its body.
    let known: Vec<i32> =
        run.map.grid().cells().filter(|c| run.map.is_known(*c)).map(|c| c.x).collect();
    assert_eq!(known, [0, 2]);
    assert!([0, 2].iter().all(|x| run.map.mode(Cell::new(*x, 0)) == 0.0));
}
