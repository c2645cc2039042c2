//! The examples of a fit match the events of a run.

use crate::root;
use covmap::{CoverageMap, Grid, Raster};
use covmap_explore::{Limits, Mission, Run, explore};
use covmap_fit::{BodyRecord, Example};
use covmap_io::read_ron;
use covmap_lab::{Config, FitPlan, SimulatedRobot, Truth};
use covmap_plan::{BodyEvidence, Strategy};
use covmap_world::{Scenario, Surface, World};
use nalgebra::Point2;
use std::ops::ControlFlow;

/// Explores the lab with smooth walls for a while, in cells of .2 m; the robot bumps into the
/// walls.
fn run(body_evidence: BodyEvidence) -> (Mission, Run, World) {
    let scenario: Scenario = read_ron(root().join("scenarios/lab.ron")).unwrap();
    let mut config = Config { resolution: 0.2, ..Config::b21r() };
    config.planner.strategy = Strategy::Cl;
    config.planner.body_evidence = body_evidence;
    let smooth = scenario.with_surface(Surface::Smooth);
    let world = World::from_scenario(&smooth, Surface::Smooth).unwrap();
    let limits = Limits { max_scans: Some(60), ..Limits::default() };
    let mission = covmap_lab::mission(&world, &config, None, limits).unwrap();
    let mut robot = SimulatedRobot::new(&world, &config, 3).unwrap();
    let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(())).unwrap();
    (mission, run, world)
}

fn example(mission: &Mission, run: &Run) -> Example {
    Example {
        name: "run".into(),
        ring: mission.config.build().unwrap().0,
        scans: run.scans.clone(),
        body: BodyRecord { radius: mission.config.robot.radius, events: run.body.clone() },
        grid: mission.grid,
        truth: Vec::new(),
    }
}

#[test]
fn the_map_of_an_example_is_the_belief_of_its_run_to_the_last_bit() {
    let (mission, run, _) = run(BodyEvidence::Belief);
    assert!(!run.bumped_at.is_empty(), "nothing was touched");
    let example = example(&mission, &run);
    let map = example.map(&mission.config.model).unwrap();
    assert_eq!(map.to_bytes(), run.map.to_bytes());
    let deaf = Example { body: BodyRecord::default(), ..example };
    assert_ne!(deaf.map(&mission.config.model).unwrap().to_bytes(), run.map.to_bytes());
}

#[test]
fn a_body_that_is_no_evidence_leaves_no_record() {
    let (mission, run, _) = run(BodyEvidence::PlannerOnly);
    assert!(run.body.is_empty());
    let map = example(&mission, &run).map(&mission.config.model).unwrap();
    assert_eq!(map.to_bytes(), run.map.to_bytes());
}

#[test]
fn scored_are_the_measured_cells_without_those_under_the_body_and_deep_in_walls() {
    let grid = Grid::new(Point2::origin(), 0.2, 5, 1).unwrap();
    let mut map = CoverageMap::new(grid, 11).unwrap();
    let cells: Vec<_> = grid.cells().collect();
    map.pin_free(cells[0]);
    for cell in &cells[2..] {
        map.multiply(*cell, &[0.5; 11].map(|p: f64| p + 0.1));
    }
    let (mission, _, world) = run(BodyEvidence::Belief);
    // The cells: free and pinned; free and not measured; partly covered; first solid layer; deeper.
    let mut truth = Truth::new(&world, &mission);
    truth.coverage = Raster::from_fn(grid, |cell| [0.0, 0.0, 0.3, 1.0, 1.0][cell.x as usize]);
    assert_eq!(truth.measured_cells(&map), cells[2..4]);
}

/// Fits a file anew; the parameters must be those of the configuration that it made, to a millionth: what is
/// written in a configuration is what this program fits, not what an earlier one did.
#[test]
fn paper_ron_is_what_its_fit_file_makes() {
    let plan = FitPlan::read(&root().join("configs/fit/paper.ron")).unwrap();
    let training = plan.examples(&plan.file.training, &()).unwrap();
    let fitted = plan.search(&training, &()).unwrap().parameters;
    let shipped: Config = read_ron(root().join("configs/paper.ron")).unwrap();
    for axis in &plan.file.axes {
        let [made, shipped] =
            [&fitted, &shipped.model].map(|model| axis.parameter.get(model).unwrap());
        assert!(
            (made - shipped).abs() < 1e-6,
            "{:?}: {made}, but {shipped} is shipped",
            axis.parameter
        );
    }
    // All other parameters are those that the fit began with.
    let mut begun = plan.begin.config.model.clone();
    for axis in &plan.file.axes {
        axis.set(&mut begun, axis.place(&shipped.model).unwrap());
    }
    assert_eq!(begun.footprint, shipped.model.footprint);
    assert_eq!(begun.bins, shipped.model.bins);
}
