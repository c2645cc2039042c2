//! Exhausted cells are given up rightly: one more scan would not have resolved them.
#![allow(clippy::unwrap_used, reason = "tests")]

use covmap::{Cell, CoverageMap};
use covmap_explore::{Ending, Limits, Run, explore};
use covmap_lab::{Config, SimulatedRobot};
use covmap_model::{Body, Looks, SensorModel};
use covmap_plan::{CellStatus, Promise};
use covmap_sonar::Scan;
use covmap_world::{Scenario, World};
use nalgebra::Isometry2;
use std::ops::ControlFlow;

/// The belief at the end of a run, made anew from the scans and the events of the body, for further scans.
struct Believer {
    model: SensorModel,
    map: CoverageMap,
    body: Body,
    looks: Looks,
}

impl Believer {
    fn at_the_end(run: &Run, config: &Config) -> Self {
        let (_, model) = config.build().unwrap();
        let map = CoverageMap::new(*run.map.grid(), config.model.bins).unwrap();
        let body = Body::new(*map.grid(), config.robot.radius);
        let mut believer = Self { looks: Looks::new(&model), model, map, body };
        let mut happened = run.body.iter().peekable();
        for (number, scan) in run.scans.iter().enumerate() {
            while let Some((_, event)) = happened.next_if(|(scans, _)| *scans <= number) {
                believer.body.happened(&mut believer.map, event);
            }
            let changes = believer.looks.integrate(&believer.model, &mut believer.map, scan);
            believer.body.hold(&mut believer.map, changes);
        }
        happened.for_each(|(_, event)| {
            believer.body.happened(&mut believer.map, event);
        });
        believer
    }

    /// The entropy of a cell after one more scan \[nats\].
    fn entropy_after(&self, scan: &Scan, cell: Cell) -> f64 {
        let (mut map, mut body, mut looks) =
            (self.map.clone(), self.body.clone(), self.looks.clone());
        let changes = looks.integrate(&self.model, &mut map, scan);
        body.hold(&mut map, changes);
        map.entropy(cell)
    }
}

/// Explores a shipped building, and takes the scan that promises most about each of up to `most`
/// exhausted cells. Returns the number of these cells, and the number of them that were resolved.
fn looked_again(building: &str, resolution: f64, seed: u64, most: usize) -> (usize, usize) {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let text = std::fs::read_to_string(format!("{root}/scenarios/{building}.ron")).unwrap();
    let scenario: Scenario = ron::from_str(&text).unwrap();
    let config = Config { resolution, ..Config::b21r() };
    let world = World::from_scenario(&scenario, config.sonar.surface).unwrap();
    let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, seed).unwrap();
    let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap();
    assert_eq!(run.ending, Ending::Explored);
    let believer = Believer::at_the_end(&run, &config);
    assert_eq!(believer.map.to_bytes(), run.map.to_bytes());

    let exhausted = run.certificate.iter().filter(|(_, is)| **is == CellStatus::Exhausted);
    let promised = exhausted.filter_map(|(cell, _)| Some((cell, (*run.promises.get(cell)?)?)));
    let promised: Vec<(Cell, Promise)> = promised.collect();
    let step = promised.len().div_ceil(most).max(1);
    let mut looked = 0;
    let resolves = |(cell, promise): &&(Cell, Promise)| {
        looked += 1;
        let at = mission.grid.center(promise.from);
        let pose = Isometry2::new(at.coords, mission.start.rotation.angle());
        let scan = Scan { pose, time: 0.0, ranges: robot.fire(&pose) };
        believer.entropy_after(&scan, *cell) <= config.planner.entropy_threshold
    };
    let resolved = promised.iter().step_by(step).filter(resolves).count();
    (looked, resolved)
}

#[test]
fn one_more_scan_resolves_hardly_a_cell_that_was_given_up() {
    let (looked, resolved) = looked_again("lab", 0.2, 1, 100);
    assert!(looked >= 50, "{looked}");
    assert!(20 * resolved <= looked, "{resolved} of {looked}");
}

#[test]
#[ignore = "minutes: cargo test --release -p covmap-lab --test exhausted -- --ignored --nocapture"]
#[allow(clippy::print_stdout, reason = "the measured table, with --nocapture")]
fn one_more_scan_resolves_hardly_a_cell_in_any_building() {
    let buildings =
        [("lab", 0.2), ("lab", 0.1), ("apartment", 0.2), ("apartment", 0.1), ("office", 0.2)];
    let (mut looked, mut resolved) = (0, 0);
    for (building, resolution) in buildings {
        let (of_looked, of_resolved) = looked_again(building, resolution, 1, 200);
        println!("{building}, r = {resolution}: {of_resolved} of {of_looked} resolved");
        looked += of_looked;
        resolved += of_resolved;
    }
    assert!(20 * resolved <= looked, "{resolved} of {looked}");
}
