//! A strategy of your own: the most gain for each metre of travel cost.
//!
//! ```text
//! cargo run -p covmap-lab --example your_own_strategy
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap_explore::{Event, Limits, View, explore_by};
use covmap_lab::{Config, SimulatedRobot, mission};
use covmap_plan::CandidateRecord;
use covmap_world::{Extent, Scenario, World};
use std::ops::ControlFlow;

/// Scores a candidate by its gain for each metre of travel cost.
fn per_metre(candidate: &CandidateRecord) -> f64 {
    candidate.gain / (candidate.cost + 0.1)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut config = Config::b21r();
    config.resolution = 0.2;
    let extent = Extent { width: 4.0, height: 3.0 };
    let scenario = Scenario { name: "room".into(), extent, start: None, obstacles: vec![] };
    let world = World::from_scenario(&scenario, config.sonar.surface)?;
    let mission = mission(&world, &config, None, Limits::default())?;
    let mut robot = SimulatedRobot::new(&world, &config, 1)?;
    let mut on = |_: &Event, _: &View<'_>| ControlFlow::Continue(());
    let run =
        explore_by(&mission, &mut robot, &mut on, &mut (per_metre as fn(&CandidateRecord) -> f64))?;
    println!("{:?} after {} scans, {:.1} m", run.ending, run.scans.len(), run.path_length);
    Ok(())
}
