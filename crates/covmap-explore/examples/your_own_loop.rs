//! A loop of your own, with sensors that always read the same; it needs no simulator.
//!
//! ```text
//! cargo run -p covmap-explore --example your_own_loop
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap::{Grid, Raster};
use covmap_explore::{Explorer, Limits, Mission, Parameters, RobotParameters};
use covmap_model::ModelParameters;
use covmap_plan::{CellStatus, PlannerParameters};
use covmap_sonar::{Range, RingSpecification, Scan};
use nalgebra::{Isometry2, Point2};

fn sense(_pose: &Isometry2<f64>) -> Vec<Range> {
    vec![Range::Echo(1.5); 24] // your sensors
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let grid = Grid::new(Point2::origin(), 0.2, 40, 30)?;
    let mission = Mission {
        config: Parameters {
            resolution: 0.2,
            robot: RobotParameters { radius: 0.27, speed: 0.5, ring: RingSpecification::B21r },
            model: ModelParameters::b21r(),
            planner: PlannerParameters::standard(),
        },
        grid,
        outside: Raster::filled(grid, false),
        start: Isometry2::translation(4.1, 3.1),
        limits: Limits::default(),
        explains: true,
    };
    let mut explorer = Explorer::new(&mission)?;
    for _ in 0..10 {
        let pose = Isometry2::new(explorer.at().coords, 0.0);
        explorer.see(&Scan { pose, time: 0.0, ranges: sense(&pose) })?;

        let Some(decision) = explorer.decide() else { break };
        for cell in decision.path {
            // Drive. If the robot bumps at a place on the way, call `moved` with that place, then
            // `bumped(cell, grid.center(cell))`, then `moved` back, and decide anew.
            explorer.moved(grid.center(cell));
            explorer.arrived(cell);
        }
    }
    let certificate = explorer.certificate();
    let open = certificate.values().iter().filter(|status| **status == CellStatus::Open).count();
    println!("{open} cells are open");
    Ok(())
}
