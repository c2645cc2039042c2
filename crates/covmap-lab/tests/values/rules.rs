//! The rules of the loop, with a robot in a corridor that does as it is told.

use super::{all_close, close, mission};
use covmap::Cell;
use covmap_explore::{Ending, Event, Limits, Mission, Robot, Run, Sensed, explore};
use covmap_plan::{BodyEvidence, CellStatus, Reach, Strategy};
use covmap_sonar::{Drive, Range};
use nalgebra::{Isometry2, Point2};
use std::convert::Infallible;
use std::ops::ControlFlow;

/// A robot whose sensors always read the same, and that bumps into a wall at `wall` [m] with its front,
/// .3 m ahead.
struct Told {
    readings: [Range; 2],
    wall: f64,
}

impl Robot for Told {
    type Error = Infallible;

    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, Infallible> {
        Ok(Sensed { pose: *expected, ranges: self.readings.to_vec() })
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Result<Drive, Infallible> {
        let stop = self.wall - 0.3;
        let at = Point2::new(stop, from.y);
        Ok(if to.x <= stop { Drive::Arrived } else { Drive::Bumped { at } })
    }
}

/// An unexpected event that happens once.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mishap {
    /// The battery is empty at the third scan.
    Fails,
    /// The robot is stopped half way on its second drive.
    IsStopped,
    /// At its second scan the robot is a cell farther to the right.
    Drifts,
    /// At its second scan the robot is far away.
    IsLost,
}

/// A robot with a mishap.
struct Unlucky {
    told: Told,
    mishap: Mishap,
    scans: usize,
    drives: usize,
}

#[derive(Debug, thiserror::Error)]
#[error("the battery is empty")]
struct EmptyBattery;

impl Robot for Unlucky {
    type Error = EmptyBattery;

    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, EmptyBattery> {
        self.scans += 1;
        let ranges = self.told.readings.to_vec();
        let drift = match (self.mishap, self.scans) {
            (Mishap::Fails, 3) => return Err(EmptyBattery),
            (Mishap::Drifts, 2) => 1.0,
            (Mishap::IsLost, 2) => 1e3,
            _ => 0.0,
        };
        let mut pose = *expected;
        pose.translation.x += drift;
        Ok(Sensed { pose, ranges })
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Result<Drive, EmptyBattery> {
        self.drives += 1;
        if self.mishap == Mishap::IsStopped && self.drives == 2 {
            return Ok(Drive::Stopped { at: from + (to - from) * 0.5 });
        }
        Ok(self.told.drive(from, to).unwrap_or(Drive::Arrived))
    }
}

/// A run along six cells, with a wall behind the last one and at most twelve scans.
fn run_unlucky(mishap: Mishap) -> Run {
    let told = Told { readings: SILENT, wall: 6.0 };
    let mut robot = Unlucky { told, mishap, scans: 0, drives: 0 };
    let mission = mission(6, &[0.0, 180.0], 1.0, budget(12, None));
    explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap()
}

#[test]
fn a_robot_that_fails_ends_the_run_and_keeps_the_map() {
    let run = run_unlucky(Mishap::Fails);
    assert_eq!((run.ending, run.scans.len()), (Ending::RobotFailed, 2));
    assert_eq!(run.failure.as_deref(), Some("the battery is empty"));
    assert!(run.map.grid().cells().any(|cell| run.map.is_known(cell)));
    let lost = run_unlucky(Mishap::IsLost);
    assert_eq!((lost.ending, lost.scans.len()), (Ending::RobotFailed, 1));
    assert!(lost.failure.is_some_and(|reason| reason.contains("outside of the map")));
}

#[test]
fn a_robot_that_is_stopped_or_drifts_goes_on_from_where_it_is() {
    for mishap in [Mishap::IsStopped, Mishap::Drifts] {
        let run = run_unlucky(mishap);
        assert!(run.failure.is_none(), "{mishap:?}: {:?}", run.ending);
        // The robot went on to the end of the corridor.
        let places = places(&run);
        assert!(places.iter().any(|x| *x < 2.0) && places.iter().any(|x| *x > 4.0), "{places:?}");
        // The path has no gap: it ends where the last scan was taken.
        let last = places[places.len() - 1];
        close(run.trajectory[run.trajectory.len() - 1].x, last, 1e-12);
    }
    let drifted = run_unlucky(Mishap::Drifts);
    assert!(
        (drifted.scans[1].pose.translation.x - drifted.scans[0].pose.translation.x).abs() > 0.5
    );
}

/// Readings without an echo.
const SILENT: [Range; 2] = [Range::NoEcho; 2];

/// A run along six cells from the middle of the second, with rays of 1 m to both sides.
fn run(wall: f64, limits: Limits) -> (Run, Vec<Event>) {
    run_of(&mission(6, &[0.0, 180.0], 1.0, limits), wall)
}

fn run_of(mission: &Mission, wall: f64) -> (Run, Vec<Event>) {
    run_told(mission, Told { readings: SILENT, wall })
}

fn run_told(mission: &Mission, mut robot: Told) -> (Run, Vec<Event>) {
    let mut events = Vec::new();
    let run = explore(mission, &mut robot, &mut |event, _| {
        events.push(event.clone());
        ControlFlow::Continue(())
    });
    (run.unwrap(), events)
}

/// The places of the scans [m].
fn places(run: &Run) -> Vec<f64> {
    run.scans.iter().map(|scan| scan.pose.translation.x).collect()
}

fn budget(scans: usize, while_driving: Option<f64>) -> Limits {
    Limits { while_driving, max_scans: Some(scans) }
}

#[test]
fn after_a_bump_the_robot_goes_back_to_where_it_came_from() {
    // The robot gets from 2.5 m as far as 3 m on its way to 3.5 m.
    let (run, events) = run(3.3, Limits::default());
    let bump = events.iter().position(|e| matches!(e, Event::Bump { .. })).unwrap();
    let Event::Bump { cell, at, towards } = &events[bump] else { panic!() };
    assert_eq!(*cell, Cell::new(3, 0));
    close(at.x, 3.0, 1e-12);
    close(towards.x, 3.5, 1e-12);
    let xs: Vec<f64> = run.trajectory.iter().map(|p| p.x).collect();
    let turn = xs.iter().position(|x| (x - 3.0).abs() < 1e-12).unwrap();
    all_close(&xs[turn - 1..turn + 2], &[2.5, 3.0, 2.5], 1e-12);
    // The path includes the way there and back.
    let length: f64 = xs.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    close(run.path_length, length, 1e-12);
    // In a corridor all turns are half turns.
    let ways: Vec<f64> =
        xs.windows(2).map(|pair| pair[1] - pair[0]).filter(|way| *way != 0.0).collect();
    let turned = ways.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    close(run.turns(), std::f64::consts::PI * f64::from(u32::try_from(turned).unwrap()), 1e-9);
    assert!(xs.iter().all(|x| *x <= 3.0 + 1e-12));
    // The next decision is made from the cell that the robot came from; no path enters the other cell.
    let next = events[bump..].iter().find_map(|e| match e {
        Event::Decision { from, .. } => Some(*from),
        _ => None,
    });
    assert!(next.is_none_or(|from| from == Cell::new(2, 0)));
    let entered = events[bump + 1..].iter().any(
        |e| matches!(e, Event::Decision { decision, .. } if decision.path.contains(&Cell::new(3, 0))),
    );
    assert!(!entered);
    assert_eq!(run.bumped_at, [*at]);
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
fn every_decision_is_made_where_the_last_one_led() {
    let (_, events) = run(f64::INFINITY, budget(8, None));
    let decisions: Vec<(Cell, Cell)> = events
        .iter()
        .filter_map(|e| match e {
            Event::Decision { from, decision, .. } => Some((*from, decision.target)),
            _ => None,
        })
        .collect();
    assert!(decisions.len() >= 6 && decisions[0].0 == Cell::new(1, 0));
    assert!(decisions.iter().any(|(from, to)| from != to));
    assert!(decisions.windows(2).all(|pair| pair[0].1 == pair[1].0), "{decisions:?}");
}

#[test]
fn the_robot_measures_every_so_many_metres_on_its_way() {
    // View-points are 2 m apart, beyond another cell; on the way the robot measures every .3 m.
    let mut mission = mission(9, &[0.0, 180.0], 3.0, budget(9, Some(0.3)));
    mission.config.planner.scan_spacing = 2.0;
    let (run, events) = run_of(&mission, f64::INFINITY);
    let expected = [1.5, 1.8, 2.1, 2.4, 2.7, 3.0, 3.3, 3.5, 3.8];
    all_close(&places(&run), &expected, 1e-9);
    assert_eq!((run.ending, run.decisions), (Ending::BudgetSpent, 2));
    let scans = events.iter().filter(|e| matches!(e, Event::Scan { .. })).count();
    assert_eq!(scans, 9);
}

#[test]
fn to_stay_in_a_cell_is_to_go_to_its_centre() {
    let mut mission = mission(6, &[0.0, 180.0], 1.0, budget(2, None));
    mission.start = Isometry2::new([1.6, 0.5].into(), 0.0);
    let (run, events) = run_of(&mission, f64::INFINITY);
    let stays =
        |e: &Event| matches!(e, Event::Decision { decision, .. } if decision.path.is_empty());
    assert!(stays(&events[1]), "{:?}", events[1]);
    all_close(&places(&run), &[1.6, 1.5], 1e-12);
}

#[test]
fn where_the_robot_stood_in_a_run_it_can_stand_again() {
    // From its start in cell 0 the robot drives over cell 1 to cell 2. After the scan there, the cells 1
    // and 3 look like walls.
    let mut mission = mission(6, &[0.0, 180.0], 1.0, budget(30, None));
    mission.start = Isometry2::new([0.5, 0.5].into(), 0.0);
    mission.config.planner.body_evidence = BodyEvidence::PlannerOnly;
    let mut stands = None;
    let robot = &mut Told { readings: SILENT, wall: f64::INFINITY };
    let run = explore(&mission, robot, &mut |event, view| {
        let Event::Scan { scan, .. } = event else { return ControlFlow::Continue(()) };
        if (scan.pose.translation.x - 2.5).abs() > 1e-9 {
            return ControlFlow::Continue(());
        }
        let (mut map, mut planner) = (view.map.clone(), view.planner.clone());
        let walls = [1, 3].map(|x| Cell::new(x, 0));
        for wall in walls {
            let change = (0..9).filter_map(|_| map.multiply(wall, &[0.01, 0.01, 0.98])).last();
            let far = Point2::new(-99.0, -99.0);
            planner.body_moved(&map, far, far, change.as_slice());
        }
        let reach = planner.reach(Cell::new(0, 0));
        stands = Some([1, 2, 3].map(|x| *reach.get(Cell::new(x, 0)).unwrap() == Reach::Reached));
        ControlFlow::Break(())
    });
    assert_eq!((run.unwrap().ending, stands), (Ending::Interrupted, Some([true, true, false])));
}

#[test]
fn where_the_robot_stood_is_free_and_what_it_sees_is_measured() {
    let (run, _) = run(f64::INFINITY, budget(1, None));
    // The cells beside the robot got one reading without an echo; a cell of 1 m is wider than its body.
    let known: Vec<i32> =
        run.map.grid().cells().filter(|c| run.map.is_known(*c)).map(|c| c.x).collect();
    assert_eq!(known, [0, 2]);
    assert!([0, 2].iter().all(|x| run.map.mode(Cell::new(*x, 0)) == 0.0));
}

#[test]
fn cells_under_the_body_are_free_for_good() {
    // With a radius of .8 m the body covers all of its cell, whose corners are .71 m away.
    let mut mission = mission(6, &[0.0, 180.0], 1.0, budget(1, None));
    mission.config.robot.radius = 0.8;
    let pinned = |mission: &Mission| {
        let (run, _) = run_of(mission, f64::INFINITY);
        run.map.grid().cells().filter(|c| run.map.is_pinned(*c)).map(|c| c.x).collect::<Vec<_>>()
    };
    assert_eq!(pinned(&mission), [1]);
    mission.config.planner.body_evidence = BodyEvidence::PlannerOnly;
    assert_eq!(pinned(&mission), [0; 0]);
}

#[test]
fn candidates_that_lose_by_measuring_are_counted() {
    // The echoes end early in the cells beside the robot, which look covered. The model expects the next
    // echoes in the middle of these cells, where they would say that one half is covered.
    let mut mission = mission(6, &[0.0, 180.0], 1.0, budget(6, None));
    (mission.config.planner.strategy, mission.config.planner.entropy_threshold) =
        (Strategy::Ig, 0.2);
    let readings = [Range::Echo(0.6); 2];
    let (run, events) = run_told(&mission, Told { readings, wall: f64::INFINITY });
    let of = |e: &Event| match e {
        Event::Decision { decision, .. } => decision.negative_gains,
        _ => 0,
    };
    let counted: usize = events.iter().map(of).sum();
    assert!(counted > 0);
    assert_eq!(run.negative_gains, counted);
}
