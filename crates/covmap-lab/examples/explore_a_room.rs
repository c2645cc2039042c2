//! Explores a room with a pillar to the end, and counts the cells of the certificate by status.
//!
//! ```text
//! cargo run -p covmap-lab --example explore_a_room
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap_explore::{Event, Limits, explore};
use covmap_lab::{CellCounts, Config, SimulatedRobot};
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use std::error::Error;
use std::io::Write;
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn Error>> {
    let mut config = Config::b21r();
    config.resolution = 0.2;
    let scenario = Scenario {
        name: "room".into(),
        extent: Extent { width: 4.0, height: 3.0 },
        start: None,
        obstacles: vec![Obstacle {
            shape: Shape::Circle { center: (2.6, 1.6), radius: 0.3 },
            surface: Surface::Rough,
        }],
    };
    let world = World::from_scenario(&scenario, config.sonar.surface)?;
    let mission = covmap_lab::mission(&world, &config, None, Limits::default())?;
    let mut robot = SimulatedRobot::new(&world, &config, 1)?;

    // The hook receives every event; `ControlFlow::Break` would end the run.
    let run = explore(&mission, &mut robot, &mut |event, view| {
        if let Event::Decision { decision, .. } = event {
            print!(
                "\r{:>4} scans, {:>5.1} m, {:>3} candidates, {:>4} known cells are open",
                view.scans,
                view.path_length,
                decision.candidates,
                view.planner.open_cells(view.map)
            );
            let _ = std::io::stdout().flush();
        }
        ControlFlow::Continue(())
    })?;

    let cells = CellCounts::of(run.certificate.values());
    println!("\n{:?} after {} scans and {:.1} m", run.ending, run.scans.len(), run.path_length);
    println!("  {:>4} cells are resolved: known, with an entropy of at most ε", cells.resolved);
    println!("  {:>4} are exhausted: their entropy did not fall any longer", cells.exhausted);
    println!("  {:>4} are open", cells.open);
    println!("  {:>4} are unreachable: out of sight of all that can be reached", cells.unreachable);
    println!("  {:>4} are outside the extent", cells.outside);
    Ok(())
}
