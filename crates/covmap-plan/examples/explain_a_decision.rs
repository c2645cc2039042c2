//! Draws a half-known room by hand, and explains the choices of three strategies in it.
//!
//! ```text
//! cargo run -p covmap-plan --example explain_a_decision
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap::{Cell, CoverageMap, Grid, Raster};
use covmap_model::{ModelParameters, SensorModel};
use covmap_plan::{Planner, PlannerParameters, Strategy};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};
use std::error::Error;

/// `#` is surely solid, `.` surely free, `?` probably free, a space unknown; r = 0.2 m.
const ROOM: [&str; 12] = [
    "####################  ",
    "#.................??  ",
    "#.................??  ",
    "#.................??  ",
    "#.....########....??  ",
    "#.....#      #....??  ",
    "#.....#      #....??  ",
    "#.....########....??  ",
    "#......???????....??  ",
    "#......???????....??  ",
    "#......???????....??  ",
    "####################  ",
];

fn main() -> Result<(), Box<dyn Error>> {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.2)?;
    let grid = Grid::new(Point2::origin(), 0.2, ROOM[0].len(), ROOM.len())?;
    let mut map = CoverageMap::new(grid, 11)?;
    let mut changes = Vec::new();
    for (y, row) in (0..).zip(ROOM.iter().rev()) {
        for (x, sign) in (0..).zip(row.chars()) {
            // The likelihood of the other bins, and the bin with likelihood 1.
            let (others, bin) = match sign {
                '#' => (0.01, 10),
                '.' => (0.01, 0),
                '?' => (0.2, 0),
                _ => continue,
            };
            let mut evidence = [others; 11];
            evidence[bin] = 1.0;
            changes.extend(map.multiply(Cell::new(x, y), &evidence));
        }
    }

    let from = Cell::new(3, 8);
    let pose = Isometry2::from(grid.center(from).coords);
    let scan = Scan { pose, time: 0.0, ranges: vec![Range::Missing; 24] };
    for strategy in [Strategy::Cl, Strategy::Ig, Strategy::IgCl { alpha: 0.3 }] {
        let parameters = PlannerParameters { strategy, ..PlannerParameters::standard() };
        let outside = Raster::filled(grid, false);
        let mut planner = Planner::new(&parameters, &model, &outside, 0.27, 0.0)?;
        planner.observe(&map, &scan, &changes);
        let decision = planner.choose(&map, from).ok_or("nothing is open")?;
        println!(
            "{strategy}: {} candidates, straight lines to go: {}",
            decision.candidates,
            decision.path.len()
        );
        for c in decision.best.iter().take(3) {
            let Cell { x, y } = c.cell;
            println!(
                "  ({x:>2}, {y:>2})  E[I] {:.4} nats  d_c {:.2} m  score {:.3}",
                c.gain, c.cost, c.score
            );
        }
    }
    Ok(())
}
