//! One run in the lab for each strategy, to the last bit.
//!
//! The hashes change with the behaviour, or with the format of the trace, and only on purpose. Then
//! this command writes new hashes, and the commit gives the reason:
//!
//! ```sh
//! COVMAP_RENEW_GOLDEN=1 cargo test -p covmap-tests golden
//! ```

use covmap_explore::{Limits, TraceHasher, explore};
use covmap_io::read_ron;
use covmap_lab::{Config, SimulatedRobot};
use covmap_world::{Scenario, World};
use std::fmt::Write;
use std::ops::ControlFlow;

/// The strategies in the spelling of the command line, and whether the robot measures while
/// driving.
const RUNS: [(&str, Option<f64>); 6] = [
    ("CL", None),
    ("IG", None),
    ("IG_WIN:2", None),
    ("IG_CL:0.3", None),
    ("COUNT:2:2", None),
    ("CL", Some(0.5)),
];

/// Returns the hash over all events and the belief of a run in cells of .2 m, and the number of
/// scans.
fn run(strategy: &str, while_driving: Option<f64>) -> (String, usize) {
    let mut config = Config::b21r();
    config.resolution = 0.2;
    config.planner.strategy = strategy.parse().unwrap();
    let scenario: Scenario = read_ron(crate::root().join("scenarios/lab.ron")).unwrap();
    let world = World::from_scenario(&scenario, config.sonar.surface).unwrap();
    let limits = Limits { while_driving, max_scans: Some(400) };
    let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
    let mut hash = TraceHasher::default();
    let run = explore(&mission, &mut robot, &mut |event, _| {
        hash.add(event);
        ControlFlow::Continue(())
    });
    let run = run.unwrap();
    hash.add_bytes(&run.map.to_bytes());
    (hash.finish(), run.scans.len())
}

#[test]
fn golden_runs_of_every_strategy_are_the_same_to_the_last_bit() {
    let mut golden = String::new();
    for (strategy, while_driving) in RUNS {
        let (hash, scans) = run(strategy, while_driving);
        let driving = while_driving.map_or(String::new(), |every| format!(" every {every} m"));
        writeln!(golden, "{strategy}{driving}, {scans} scans: {hash}").unwrap();
    }
    let path = crate::root().join("tests/golden/lab.txt");
    if std::env::var_os("COVMAP_RENEW_GOLDEN").is_some() {
        std::fs::write(&path, &golden).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let how = "if it is meant to differ: COVMAP_RENEW_GOLDEN=1 cargo test -p covmap-tests golden";
    assert_eq!(golden, expected, "{how}");
}
