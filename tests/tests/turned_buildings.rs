//! Buildings at every angle: the robot passes every door that is wide enough.

use crate::root;
use covmap_explore::{Ending, Limits, explore};
use covmap_io::read_ron;
use covmap_lab::{Config, CutOff, Score, SimulatedRobot, Truth};
use covmap_statistics::{stream, uniform};
use covmap_world::{Scenario, World};
use nalgebra::Vector2;
use std::f64::consts::TAU;
use std::ops::ControlFlow;

/// Explores a shipped building in cells of .2 m, turned by an angle \[rad\] and shifted by less
/// than a cell.
fn explored(building: &str, angle: f64, shift: Vector2<f64>) -> (Ending, Score, CutOff) {
    let scenario: Scenario = read_ron(root().join(format!("scenarios/{building}.ron"))).unwrap();
    let mut config: Config = read_ron(root().join("configs/b21r.ron")).unwrap();
    config.resolution = 0.2;
    let world = World::from_scenario(&scenario.moved(angle, shift), config.sonar.surface).unwrap();
    let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap();
    let truth = Truth::new(&world, &mission);
    let score = truth.score(&run.map, &truth.scored_cells(&world, &mission, &run));
    (run.ending, score, CutOff::new(&truth, &mission, &run))
}

#[track_caller]
#[allow(clippy::print_stdout, reason = "the measured table, with --nocapture")]
fn check(building: &str, angle: f64, shift: Vector2<f64>) {
    let (ending, score, cut_off) = explored(building, angle, shift);
    let degrees = angle.to_degrees();
    println!(
        "{building} turned by {degrees:.1}°: {ending:?}, completeness {:.4}, cut off {cut_off:?}",
        score.completeness
    );
    assert_eq!(ending, Ending::Explored, "{building} {degrees}");
    assert!(score.completeness >= 1.0, "{building} {degrees}: {score:?}");
    assert_eq!(cut_off.cells, 0, "{building} {degrees}: {cut_off:?}");
}

#[test]
fn the_lab_is_explored_at_odd_angles() {
    for degrees in [7.0, 29.0, 45.0] {
        check("lab", f64::to_radians(degrees), Vector2::new(0.07, 0.03));
    }
}

#[test]
#[ignore = "minutes: cargo test --release --test workflow turned -- --ignored --nocapture"]
fn every_door_of_turned_buildings_is_found() {
    let mut random = stream(1, "turned buildings", 0);
    for _ in 0..30 {
        let angle = TAU * uniform(&mut random);
        let shift = Vector2::new(uniform(&mut random), uniform(&mut random)) * 0.2;
        check("lab", angle, shift);
        check("office", angle, shift);
    }
}
