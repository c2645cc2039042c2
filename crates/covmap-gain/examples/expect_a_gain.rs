//! Prints the expected information gain at two places, by the equations as printed and from the
//! cache.
//!
//! ```text
//! cargo run -p covmap-gain --example expect_a_gain
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap::{CoverageMap, Grid};
use covmap_gain::{
    GainCache, InformationGain, RangePrediction, Upkeep, ViewPoints, expected_information_gain,
};
use covmap_model::{ModelParameters, SensorModel, integrate};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1)?;
    let grid = Grid::new(Point2::new(-4.0, -3.0), 0.1, 80, 60)?;
    let mut map = CoverageMap::new(grid, model.parameters().bins)?;
    let prediction = RangePrediction {
        gain: InformationGain::Eq14,
        unknown_reflection: 0.0,
        uniform_share: 0.0,
        novelty: 1.0,
    };
    let mut cache = GainCache::new(&model, 0.0, grid, prediction, Upkeep::Kept)?;

    // Five scans on the left, among walls; nothing is known of the right.
    let pose = Isometry2::translation(-2.0, 0.0);
    for _ in 0..5 {
        let scan = Scan { pose, time: 0.0, ranges: vec![Range::Echo(1.2); 24] };
        for change in integrate(&model, &mut map, &scan) {
            cache.update(&map, change.cell);
        }
    }

    for (place, x) in [("where it measured", -2.0), ("where it did not", 2.0)] {
        let cell = grid.cell_at(Point2::new(x, 0.0)).ok_or("outside of the grid")?;
        let index = grid.index(cell).ok_or("outside of the grid")?;
        cache.refresh_gains(&ViewPoints::one(&grid, index));
        let literal = expected_information_gain(&map, &model, cache.stencil(), prediction, cell);
        println!(
            "{place}: {} cells in sight, E[I] {:.6} nats, by the literal equations {literal:.6}",
            cache.cells_in_sight(index).len(),
            cache.gain(index),
        );
    }
    Ok(())
}
