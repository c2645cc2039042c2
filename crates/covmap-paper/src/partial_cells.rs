//! The experiment of Fig. 1 and 2: a cell with a coverage of 20 % is measured again and again.

use crate::error::Result;
use covmap::{Cell, CoverageMap, Grid};
use covmap_io::parse_ron;
use covmap_lab::{Config, SimulatedRobot};
use covmap_model::{OccupancyGrid, OccupancyParameters, integrate};
use covmap_sonar::Scan;
use covmap_world::{Scenario, World};
use nalgebra::Point2;
use rayon::prelude::*;
use std::path::Path;

/// The number of measurements of the cell.
pub(crate) const MEASUREMENTS: usize = 100;
/// The number of measurements before the posterior of Fig. 2.
pub(crate) const FIG_2: usize = 30;
/// The coverage of the cell.
pub(crate) const COVERAGE: f64 = 0.2;

/// The side of the cell \[m\], and its lower left corner, as in the scenarios.
const SIDE: f64 = 0.1;
const CORNER: [f64; 2] = [2.5, 2.0];

/// Four ways to cover 20 % of a cell.
const CASES: [(char, &str, &str); 4] = [
    ('a', "a slab at the far side, solid behind", include_str!("../../../scenarios/fig1a.ron")),
    ('b', "a slab at the near side, free behind", include_str!("../../../scenarios/fig1b.ron")),
    ('c', "the corner of a block", include_str!("../../../scenarios/fig1c.ron")),
    ('d', "an oblique wall", include_str!("../../../scenarios/fig1d.ron")),
];

/// One way to cover the cell, and the beliefs about it.
#[derive(Debug, Clone)]
pub struct PartialCell {
    /// The letter of the case.
    pub case: char,
    /// The description of the case.
    pub what: &'static str,
    /// One series for each seed.
    pub series: Vec<Series>,
}

/// The beliefs about the cell after 1, 2, … measurements.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// The occupancy by unclamped log-odds.
    pub occupancy: Vec<f64>,
    /// The most likely coverage.
    pub mode: Vec<f64>,
    /// The posterior after [`FIG_2`] measurements.
    pub posterior: Vec<f64>,
}

/// Measures the cell of all four scenarios with the seeds 1, 2, … `seeds`.
pub(crate) fn measure(config: &Config, seeds: u64) -> Result<Vec<PartialCell>> {
    let config = Config { resolution: SIDE, ..config.clone() };
    let case = |(case, what, text): (char, &'static str, &str)| -> Result<PartialCell> {
        let name = format!("scenarios/fig1{case}.ron");
        let scenario: Scenario = parse_ron(Path::new(&name), text)?;
        let world = World::from_scenario(&scenario, config.sonar.surface)?;
        let series = (1..=seeds).into_par_iter().map(|seed| series(&world, &config, seed));
        Ok(PartialCell { case, what, series: series.collect::<Result<_>>()? })
    };
    CASES.into_iter().map(case).collect()
}

/// Measures the one cell; the same code as for any map updates its map.
fn series(world: &World, config: &Config, seed: u64) -> Result<Series> {
    let (_, model) = config.build()?;
    let grid = Grid::new(Point2::from(CORNER), SIDE, 1, 1)?;
    let cell = Cell::new(0, 0);
    let mut map = CoverageMap::new(grid, config.model.bins)?;
    let mut occupancy = OccupancyGrid::new(grid, OccupancyParameters::default());
    let mut robot = SimulatedRobot::new(world, config, seed)?;
    let pose = world.given_start().unwrap_or_default();
    let mut series = Series::default();
    for measurement in 1..=MEASUREMENTS {
        let scan = Scan { pose, time: 0.0, ranges: robot.fire(&pose) };
        integrate(&model, &mut map, &scan);
        occupancy.integrate(&model, &scan);
        let occupied = occupancy.probabilities().get(cell).copied().flatten();
        series.occupancy.push(occupied.unwrap_or(0.5));
        series.mode.push(if map.is_known(cell) { map.mode(cell) } else { f64::NAN });
        if measurement == FIG_2 {
            series.posterior = map.histogram(cell).probabilities().to_vec();
        }
    }
    Ok(series)
}

impl PartialCell {
    /// Returns a value of each seed.
    pub fn values(&self, of: impl Fn(&Series) -> f64) -> Vec<f64> {
        self.series.iter().map(of).collect()
    }
}

/// Returns mean, 5th and 95th percentile of the finite values.
pub(crate) fn spread(values: &[f64]) -> (f64, f64, f64) {
    let mut values: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return (f64::NAN, f64::NAN, f64::NAN) };
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (mean, values[last * 5 / 100], values[last - last * 5 / 100])
}
