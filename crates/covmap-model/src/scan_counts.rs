//! The paper's second baseline: counting how often a cell was scanned.

use covmap::{Cell, Grid, Raster};
use serde::{Deserialize, Serialize};

/// How much an interception counts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Counting {
    /// One, however far.
    Plain,
    /// `1 / (1 + d^l/half_distance)`: "we additionally discounted longer beams".
    Discounted {
        /// The distance at which a beam counts half \[m\].
        half_distance: f64,
    },
}

impl Counting {
    /// The weight of a beam that intercepts a cell at `cell_distance` \[m\].
    pub fn weight(&self, cell_distance: f64) -> f64 {
        match self {
            Counting::Plain => 1.0,
            Counting::Discounted { half_distance } => 1.0 / (1.0 + cell_distance / half_distance),
        }
    }
}

/// How often each cell was intercepted by a measurement (section 5.1).
#[derive(Debug, Clone)]
pub struct ScanCounts {
    counting: Counting,
    weights: Raster<f64>,
}

impl ScanCounts {
    /// No cell was scanned yet.
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

    /// The weight of every cell.
    pub fn weights(&self) -> &Raster<f64> {
        &self.weights
    }
}
