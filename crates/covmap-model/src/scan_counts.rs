//! The paper's second baseline: the number of scans of each cell.

use covmap::{Cell, Grid, Raster};
use serde::{Deserialize, Serialize};

/// Weight of an interception.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Counting {
    /// One, at any distance.
    Plain,
    /// `1 / (1 + d^l/half_distance)`: "we additionally discounted longer beams".
    Discounted {
        /// Distance at which a beam counts half \[m\].
        half_distance: f64,
    },
}

impl Counting {
    /// Returns the weight of a beam that intercepts a cell at `cell_distance` \[m\].
    pub fn weight(&self, cell_distance: f64) -> f64 {
        match self {
            Counting::Plain => 1.0,
            Counting::Discounted { half_distance } => 1.0 / (1.0 + cell_distance / half_distance),
        }
    }
}

/// Weighted number of measurements that intercepted each cell (section 5.1).
#[derive(Debug, Clone)]
pub struct ScanCounts {
    counting: Counting,
    weights: Raster<f64>,
}

impl ScanCounts {
    /// Creates counts of cells that no scan has intercepted yet.
    pub fn new(grid: Grid, counting: Counting) -> Self {
        Self { counting, weights: Raster::filled(grid, 0.0) }
    }

    /// Adds the cells that a scan intercepted ([`crate::intercepted`]).
    pub fn add(&mut self, intercepted: &[(Cell, f64)]) {
        for (cell, cell_distance) in intercepted {
            if let Some(weight) = self.weights.get_mut(*cell) {
                *weight += self.counting.weight(*cell_distance);
            }
        }
    }

    /// Returns the weight of every cell.
    pub fn weights(&self) -> &Raster<f64> {
        &self.weights
    }
}
