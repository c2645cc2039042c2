//! The tally of measurements: of each cell, and until the cell was explored.

use crate::ConfigError;
use covmap::{CoverageMap, Raster};
use covmap_explore::Mission;
use covmap_model::{Counting, ScanCounts, SensorModel, intercepted};
use covmap_sonar::Scan;

/// Distance at which a beam counts half in the extended counting \[m\].
const HALF_DISTANCE: f64 = 2.0;

/// The number of measurements of each cell, with any strategy (section 5.1).
#[derive(Debug)]
pub struct Tally {
    model: SensorModel,
    threshold: f64,
    plain: ScanCounts,
    discounted: ScanCounts,
    /// Both counts at the scan after which a cell first had an entropy of at most ε.
    first: Raster<Option<(f64, f64)>>,
}

/// The results of a tally.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurements {
    /// The largest number of measurements of an observable cell when it first had an entropy of at
    /// most ε: footnote 2 of the paper.
    pub until_explored: f64,
    /// The same with the weights `1/(1 + d^l/2 m)`.
    pub until_explored_discounted: f64,
    /// The mean number of measurements of an observable cell.
    pub mean: f64,
    /// The standard deviation of this number.
    pub deviation: f64,
    /// The smallest number of measurements of an observable cell.
    pub least: f64,
    /// The largest number of measurements of an observable cell.
    pub most: f64,
}

impl Tally {
    /// Returns a tally without a measurement.
    ///
    /// # Errors
    /// If the configuration is invalid.
    pub fn new(mission: &Mission) -> Result<Self, ConfigError> {
        let (_, model) = mission.config.build()?;
        let counts = |counting| ScanCounts::new(mission.grid, counting);
        Ok(Self {
            model,
            threshold: mission.config.planner.entropy_threshold,
            plain: counts(Counting::Plain),
            discounted: counts(Counting::Discounted { half_distance: HALF_DISTANCE }),
            first: Raster::filled(mission.grid, None),
        })
    }

    /// Adds a scan, which `map` already holds.
    pub fn add(&mut self, map: &CoverageMap, scan: &Scan) {
        let cells = intercepted(&self.model, map.grid(), scan);
        self.plain.add(&cells);
        self.discounted.add(&cells);
        for (cell, _) in cells {
            let Some(first @ None) = self.first.get_mut(cell) else { continue };
            if map.is_known(cell) && map.entropy(cell) <= self.threshold {
                let count = |counts: &ScanCounts| counts.weights().get(cell).copied();
                *first = count(&self.plain).zip(count(&self.discounted));
            }
        }
    }

    /// Returns the results over the observable cells.
    pub fn finish(&self, observable: &Raster<bool>) -> Measurements {
        let cells = || observable.iter().filter(|(_, o)| **o).map(|(cell, _)| cell);
        let first = || cells().filter_map(|cell| self.first.get(cell).copied().flatten());
        let counts: Vec<f64> =
            cells().map(|cell| self.plain.weights().get(cell).copied().unwrap_or(0.0)).collect();
        let mean = crate::score::mean(counts.iter().copied());
        let variance = crate::score::mean(counts.iter().map(|n| (n - mean) * (n - mean)));
        let least = counts.iter().copied().reduce(f64::min);
        Measurements {
            until_explored: first().map(|(plain, _)| plain).fold(0.0, f64::max),
            until_explored_discounted: first().map(|(_, weight)| weight).fold(0.0, f64::max),
            mean,
            deviation: variance.sqrt(),
            least: least.unwrap_or(0.0),
            most: counts.into_iter().fold(0.0, f64::max),
        }
    }
}

impl Measurements {
    /// Returns all numbers with their names.
    pub fn named(&self) -> [(&'static str, f64); 6] {
        [
            ("measurements.until_explored", self.until_explored),
            ("measurements.until_explored_discounted", self.until_explored_discounted),
            ("measurements.mean", self.mean),
            ("measurements.sd", self.deviation),
            ("measurements.min", self.least),
            ("measurements.max", self.most),
        ]
    }
}
