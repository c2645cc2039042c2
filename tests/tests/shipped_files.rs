//! Every shipped configuration and scenario loads and runs.

use crate::files;
use covmap::{CoverageMap, Grid, ReadOut};
use covmap_explore::{Ending, Limits, explore};
use covmap_io::{read_ron, write_ron};
use covmap_lab::{CellCounts, Config, SimulatedRobot, Truth};
use covmap_plan::Planner;
use covmap_world::{Scenario, World};
use nalgebra::Point2;
use std::ops::ControlFlow;
use std::path::Path;

fn config(path: &Path) -> Config {
    read_ron(path).unwrap_or_else(|error| panic!("{error}"))
}

fn world(path: &Path, config: &Config) -> World {
    let scenario: Scenario = read_ron(path).unwrap_or_else(|error| panic!("{error}"));
    World::from_scenario(&scenario, config.sonar.surface)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn default_config() -> Config {
    config(&crate::root().join("configs/b21r.ron"))
}

/// Returns the shipped configurations; campaigns, which name worlds, lie in the same folder.
fn configurations() -> Vec<std::path::PathBuf> {
    let is_campaign =
        |path: &std::path::PathBuf| std::fs::read_to_string(path).unwrap().contains("worlds: [");
    files("configs", "ron").into_iter().filter(|path| !is_campaign(path)).collect()
}

#[test]
fn every_configuration_makes_a_model_and_a_planner() {
    for path in configurations() {
        let config = config(&path);
        let (ring, model) = config.build().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(model.footprint().beams(), ring.beams().len());
        let world = world(&crate::root().join("scenarios/lab.ron"), &config);
        let mission = covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
        let radius = config.robot.radius;
        Planner::new(&config.planner, &model, &mission.outside, radius, 0.0)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
}

#[test]
fn the_default_configuration_is_the_default_of_the_code() {
    assert_eq!(default_config(), Config::b21r());
}

#[test]
fn every_read_out_reads_maps_of_the_default() {
    let bins = default_config().model.bins;
    let read_outs = files("configs/read-out", "ron");
    assert!(!read_outs.is_empty());
    for path in read_outs {
        let read_out: ReadOut = read_ron(&path).unwrap_or_else(|error| panic!("{error}"));
        let grid = Grid::new(Point2::origin(), 0.1, 2, 2).unwrap();
        let map = CoverageMap::new(grid, bins).unwrap();
        let read = map.read_by(&read_out).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(read.bins(), bins, "{}", path.display());
    }
}

#[test]
fn a_configuration_is_read_back_as_it_was_written() {
    let path = std::env::temp_dir().join(format!("covmap-{}.ron", std::process::id()));
    for shipped in configurations() {
        let written = config(&shipped);
        write_ron(&path, &written, None).unwrap();
        assert_eq!(config(&path), written, "{}", shipped.display());
    }
    std::fs::remove_file(path).unwrap();
}

#[test]
fn the_robot_fits_at_every_start() {
    let config = default_config();
    for path in files("scenarios", "ron") {
        let world = world(&path, &config);
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert_eq!(world.name(), name, "a scenario is called as its file");
        let start = world.given_start().unwrap_or_else(|| panic!("{name} has no start"));
        assert!(world.clearance(start.translation.vector.into()) >= config.robot.radius, "{name}");
        covmap_lab::mission(&world, &config, None, Limits::default()).unwrap();
    }
}

#[test]
fn every_scenario_is_explored_for_a_while() {
    let mut config = default_config();
    config.resolution = 0.2;
    for path in files("scenarios", "ron") {
        let world = world(&path, &config);
        let limits = Limits { max_scans: Some(5), ..Limits::default() };
        let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
        let mut robot = SimulatedRobot::new(&world, &config, 1).unwrap();
        let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap();
        assert_eq!((run.ending, run.scans.len()), (Ending::BudgetSpent, 5), "{}", world.name());
        let counts = CellCounts::of(run.certificate.values());
        assert!(counts.open > 0, "{}", world.name());
        let truth = Truth::new(&world, &mission);
        let score = truth.score(&run.map, &truth.scored_cells(&world, &mission, &run));
        assert!(score.completeness > 0.0 && score.completeness <= 1.0, "{}", world.name());
        assert!(score.mean_log_likelihood.is_finite(), "{}", world.name());
    }
}
