//! The robot is never shut in by its own rules; if it is shut in otherwise, the run says so.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests")]

use covmap_explore::{Ending, Limits, Mission, Robot, Run, Sensed, explore};
use covmap_lab::{Config, CutOff, Score, SimulatedRobot, Truth};
use covmap_plan::{CellStatus, Strategy};
use covmap_sonar::{Drive, Range};
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use nalgebra::{Isometry2, Point2};
use std::convert::Infallible;
use std::ops::ControlFlow;

fn config(strategy: Strategy) -> Config {
    let mut config = Config::b21r();
    config.resolution = 0.2;
    config.planner.strategy = strategy;
    config
}

fn world((width, height): (f64, f64), shapes: Vec<Shape>) -> World {
    let rough = |shape| Obstacle { shape, surface: Surface::Rough };
    let obstacles = shapes.into_iter().map(rough).collect();
    let extent = Extent { width, height };
    let scenario = Scenario { name: "room".into(), extent, start: None, obstacles };
    World::from_scenario(&scenario, Surface::Rough).unwrap()
}

fn at(x: f64, y: f64) -> Option<Isometry2<f64>> {
    Some(Isometry2::new([x, y].into(), 0.0))
}

/// Explores with a robot, and scores the run.
fn run_with(world: &World, mission: &Mission, robot: &mut impl Robot) -> (Run, Score, CutOff) {
    let run = explore(mission, robot, &mut |_, _| ControlFlow::Continue(())).unwrap();
    let truth = Truth::new(world, mission);
    let score = truth.score(&run.map, &truth.scored_cells(world, mission, &run));
    let cut_off = CutOff::new(&truth, mission, &run);
    (run, score, cut_off)
}

fn run(
    world: &World,
    config: &Config,
    start: Option<Isometry2<f64>>,
    seed: u64,
    limits: Limits,
) -> (Run, Score, CutOff) {
    let mission = covmap_lab::mission(world, config, start, limits).unwrap();
    let mut robot = SimulatedRobot::new(world, config, seed).unwrap();
    run_with(world, &mission, &mut robot)
}

/// Four thin posts around a place: straight steps of .2 m end at them, diagonal steps lead out.
fn posts_around(x: f64, y: f64) -> Vec<Shape> {
    let post = |(dx, dy)| Shape::Circle { center: (x + dx, y + dy), radius: 0.02 };
    [(0.44, 0.0), (-0.44, 0.0), (0.0, 0.44), (0.0, -0.44)].into_iter().map(post).collect()
}

#[test]
fn a_robot_between_posts_leaves_by_a_diagonal_and_gets_back() {
    let world = world((4.0, 4.0), posts_around(2.1, 2.1));
    for seed in 1..=4 {
        // On the centre of a cell, and off it.
        for (x, y) in [(2.1, 2.1), (2.13, 2.08)] {
            let config = config(Strategy::Cl);
            let (run, score, cut_off) = run(&world, &config, at(x, y), seed, Limits::default());
            assert_eq!(run.ending, Ending::Explored, "{seed} {x}");
            assert!(score.completeness >= 0.95, "{seed} {x}: {score:?} {cut_off:?}");
        }
    }
}

/// Two rooms, and a door of .8 m in a wall turned by some degrees.
fn slanted_door(degrees: f64) -> World {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let along = |from: f64, to: f64| Shape::Wall {
        from: (3.0 + cos * from, 3.0 + sin * from),
        to: (3.0 + cos * to, 3.0 + sin * to),
        thickness: 0.15,
    };
    world((6.0, 6.0), vec![along(-6.0, -0.4), along(0.4, 6.0)])
}

#[test]
fn a_door_that_is_wide_enough_is_a_door_at_any_angle() {
    for (degrees, strategy) in
        [(45.0, Strategy::Cl), (135.0, Strategy::Ig), (20.0, Strategy::Cl), (70.0, Strategy::Cl)]
    {
        let world = slanted_door(degrees);
        let start = if degrees < 60.0 { at(3.0, 1.2) } else { at(1.2, 3.0) };
        let start = if degrees == 135.0 { at(1.5, 1.5) } else { start };
        let mission =
            covmap_lab::mission(&world, &config(strategy), start, Limits::default()).unwrap();
        // The robot can truly get to both sides.
        let reachable = Truth::new(&world, &mission).reachable;
        let side = |p: Point2<f64>| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            (p - Point2::new(3.0, 3.0)).perp(&nalgebra::Vector2::new(cos, sin)) > 0.0
        };
        let reached = |far: bool| {
            let of =
                |(cell, reached): (_, &bool)| *reached && side(mission.grid.center(cell)) == far;
            reachable.iter().filter(|cell| of(*cell)).count()
        };
        assert!(reached(true) > 150 && reached(false) > 150, "{degrees}");
        let (_, score, cut_off) = run(&world, &config(strategy), start, 1, Limits::default());
        assert_eq!(score.completeness, 1.0, "{degrees}: {cut_off:?}");
        assert_eq!(cut_off, CutOff::default(), "{degrees}");
    }
}

#[test]
fn a_robot_amid_open_space_goes_on_until_it_found_the_walls() {
    // Farther than the usable range to all sides.
    let world = world((9.0, 9.0), Vec::new());
    let (run, score, cut_off) =
        run(&world, &config(Strategy::IgCl { alpha: 0.1 }), at(4.5, 4.5), 1, Limits::default());
    assert_eq!(run.ending, Ending::Explored);
    assert!(score.completeness >= 0.99, "{score:?} {cut_off:?}");
}

/// A simulated robot with a part that breaks.
struct Broken<'a> {
    robot: SimulatedRobot<'a>,
    /// The reading of each sensor instead of its measurement.
    says: Option<Range>,
    /// The number of drives after which the robot cannot drive any more.
    drives: usize,
}

impl Robot for Broken<'_> {
    type Error = Infallible;

    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, Infallible> {
        let Sensed { pose, ranges } = self.robot.sense(expected)?;
        let ranges = self.says.map_or(ranges.clone(), |says| vec![says; ranges.len()]);
        Ok(Sensed { pose, ranges })
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Result<Drive, Infallible> {
        if self.drives == 0 {
            return Ok(Drive::Bumped { at: from });
        }
        self.drives -= 1;
        self.robot.drive(from, to)
    }
}

fn run_broken(says: Option<Range>, drives: usize) -> Run {
    let world = world((4.0, 4.0), Vec::new());
    let config = config(Strategy::Cl);
    let mission = covmap_lab::mission(&world, &config, at(2.1, 2.1), Limits::default()).unwrap();
    let robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    run_with(&world, &mission, &mut Broken { robot, says, drives }).0
}

#[test]
fn a_robot_that_hears_nothing_did_not_explore() {
    assert_eq!(run_broken(Some(Range::Missing), usize::MAX).ending, Ending::NothingHeard);
    assert_eq!(run_broken(Some(Range::NoEcho), usize::MAX).ending, Ending::NothingHeard);
    assert_eq!(run_broken(None, usize::MAX).ending, Ending::Explored);
}

#[test]
fn a_robot_that_is_boxed_in_did_not_explore() {
    assert_eq!(run_broken(None, 0).ending, Ending::StartBlocked);
    // The robot gets some steps far, and then no farther.
    let run = run_broken(None, 9);
    assert_eq!(run.ending, Ending::BoxedIn);
    assert!(run.path_length > 0.5);
}

#[test]
fn a_pen_that_one_scan_spends_is_no_exploration() {
    // A pen in which the robot can move by a step or two, in a room.
    let wall = |from, to| Shape::Wall { from, to, thickness: 0.1 };
    let pen = vec![
        wall((1.6, 1.6), (1.6, 2.6)),
        wall((2.6, 1.6), (2.6, 2.6)),
        wall((1.6, 1.6), (2.6, 1.6)),
        wall((1.6, 2.6), (2.6, 2.6)),
    ];
    let world = world((4.0, 4.0), pen);
    let (run, ..) = run(&world, &config(Strategy::Cl), at(2.1, 2.1), 1, Limits::default());
    assert!(matches!(run.ending, Ending::BoxedIn | Ending::StartBlocked), "{:?}", run.ending);
}

#[test]
fn a_run_that_was_stopped_tells_not_seen_from_unreachable() {
    let world = slanted_door(90.0);
    let some = Limits { max_scans: Some(2), ..Limits::default() };
    let config = config(Strategy::Cl);
    let count = |run: &Run, status: CellStatus| {
        run.certificate.values().iter().filter(|s| **s == status).count()
    };
    let (stopped, ..) = run(&world, &config, at(1.5, 3.0), 1, some);
    assert_eq!(stopped.ending, Ending::BudgetSpent);
    // More than the room behind the door, 3 × 6 m, is not seen.
    assert!(count(&stopped, CellStatus::NotSeen) > 300);
    let (whole, score, _) = run(&world, &config, at(1.5, 3.0), 1, Limits::default());
    assert_eq!((score.completeness, count(&whole, CellStatus::NotSeen)), (1.0, 0));
}

/// A robot that bumps into an obstacle at the door that is not there.
struct Haunted<'a>(SimulatedRobot<'a>);

impl Robot for Haunted<'_> {
    type Error = Infallible;

    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, Infallible> {
        self.0.sense(expected)
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Result<Drive, Infallible> {
        if to.x > 2.8 { Ok(Drive::Bumped { at: from }) } else { self.0.drive(from, to) }
    }
}

#[test]
fn what_is_cut_off_is_named_with_what_cuts_it_off() {
    let world = slanted_door(90.0);
    let config = config(Strategy::Cl);
    let mission = covmap_lab::mission(&world, &config, at(1.5, 3.0), Limits::default()).unwrap();
    let mut robot = Haunted(SimulatedRobot::new(&world, &config, 1).unwrap());
    let (run, score, cut_off) = run_with(&world, &mission, &mut robot);
    assert_eq!(run.ending, Ending::Explored);
    assert!(score.completeness < 0.9 && cut_off.cells > 50, "{score:?} {cut_off:?}");
    assert!(cut_off.bumps > 0, "{cut_off:?}");
    // Cells that the robot could see through the door are not cut off.
    let truth = Truth::new(&world, &mission);
    let unseen = |(cell, reached): &(_, &bool)| **reached && !Truth::is_known_free(&run.map, *cell);
    assert!(cut_off.cells <= truth.reachable.iter().filter(unseen).count());
}
