//! The paper's first baseline: an occupancy grid with log-odds.

use crate::{Outcome, SensorModel};
use covmap::{Cell, Grid, Raster};
use covmap_sonar::Scan;
use serde::{Deserialize, Serialize};

/// Weights of a beam in the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OccupancyParameters {
    /// Probability of "occupied" for a cell in which a beam ends.
    pub hit: f64,
    /// Probability of "occupied" for a cell that a beam passes through.
    pub miss: f64,
    /// Probability of "occupied" for a cell that a beam without an echo passes through.
    pub no_echo: f64,
    /// Bounds on the probability, if any.
    pub clamp: Option<(f64, f64)>,
}

impl Default for OccupancyParameters {
    /// Hit .7, miss .4, with an echo or without, no clamps.
    fn default() -> Self {
        Self { hit: 0.7, miss: 0.4, no_echo: 0.4, clamp: None }
    }
}

fn log_odds(p: f64) -> f64 {
    libm::log(p / (1.0 - p))
}

/// An occupancy grid \[Moravec & Elfes 1985\]: each cell is either occupied or free, and
/// each beam adds its log-odds to the cells of the same footprint as the coverage map's.
#[derive(Debug, Clone)]
pub struct OccupancyGrid {
    parameters: OccupancyParameters,
    log_odds: Raster<Option<f64>>,
    pinned: Raster<bool>,
}

impl OccupancyGrid {
    /// Creates a grid of unknown cells.
    pub fn new(grid: Grid, parameters: OccupancyParameters) -> Self {
        let log_odds = Raster::filled(grid, None);
        Self { parameters, log_odds, pinned: Raster::filled(grid, false) }
    }

    /// Integrates a scan: a cell in which a beam ends is hit, a cell before it is missed.
    ///
    /// # Panics
    /// If the scan does not fit the model's ring.
    pub fn integrate(&mut self, model: &SensorModel, scan: &Scan) {
        let (hit, miss) = (log_odds(self.parameters.hit), log_odds(self.parameters.miss));
        let no_echo = log_odds(self.parameters.no_echo);
        let bounds = self.parameters.clamp.map(|(low, high)| (log_odds(low), log_odds(high)));
        let half = 0.5 * model.resolution();
        let grid = *self.log_odds.grid();
        model.for_each_covered(&grid, scan, |cell, cell_distance, outcome| {
            let (delta, miss) = match outcome {
                Outcome::Echo(d) => (cell_distance - d, miss),
                Outcome::Beyond(_) => (f64::NEG_INFINITY, miss),
                Outcome::NoEcho => (f64::NEG_INFINITY, no_echo),
            };
            let pinned = self.pinned.get(cell).copied().unwrap_or(true);
            if let Some(value) = self.log_odds.get_mut(cell).filter(|_| delta <= half && !pinned) {
                let sum = value.unwrap_or(0.0) + if delta < -half { miss } else { hit };
                *value = Some(bounds.map_or(sum, |(low, high)| sum.max(low).min(high)));
            }
        });
    }

    /// Declares that a cell is free for good, because the robot's body was there.
    pub fn pin_free(&mut self, cell: Cell) {
        if let Some(pinned) = self.pinned.get_mut(cell) {
            *pinned = true;
        }
        if let Some(value) = self.log_odds.get_mut(cell) {
            *value = Some(log_odds(covmap::PROBABILITY_FLOOR));
        }
    }

    /// Returns the probability that each cell is occupied; `None` where nothing is known.
    pub fn probabilities(&self) -> Raster<Option<f64>> {
        self.log_odds.map(|value| value.map(|l| 1.0 / (1.0 + libm::exp(-l))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ModelParameters;
    use covmap_sonar::{Range, SonarRing};
    use nalgebra::{Isometry2, Point2};

    fn repeat(clamp: Option<(f64, f64)>, times: usize) -> Raster<Option<f64>> {
        let model = SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.1).unwrap();
        let grid = Grid::new(Point2::new(-2.0, -2.0), 0.1, 40, 40).unwrap();
        let parameters = OccupancyParameters { clamp, ..OccupancyParameters::default() };
        let mut occupancy = OccupancyGrid::new(grid, parameters);
        let mut ranges = vec![Range::Missing; 24];
        ranges[0] = Range::Echo(1.0);
        let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges };
        (0..times).for_each(|_| occupancy.integrate(&model, &scan));
        occupancy.probabilities()
    }

    #[test]
    fn a_cell_that_is_detected_again_and_again_converges_to_occupied() {
        let cells = repeat(None, 30);
        let at = |x, y| *cells.get(cells.grid().cell_at(Point2::new(x, y)).unwrap()).unwrap();
        assert!(at(1.25, 0.15).unwrap() > 0.99);
        assert!(at(0.75, 0.05).unwrap() < 0.01);
        assert_eq!(at(-1.0, 0.0), None);
        assert_eq!(at(1.55, 0.15), None);
    }

    #[test]
    fn clamps_keep_the_grid_open_to_change() {
        let largest =
            |p: &Raster<Option<f64>>| p.values().iter().flatten().fold(0.0, |a: f64, b| a.max(*b));
        assert!((largest(&repeat(Some((0.12, 0.97)), 30)) - 0.97).abs() < 1e-9);
    }
}
