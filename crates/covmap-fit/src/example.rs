//! What the model is fitted to: scans, and the truth of a fixed set of cells.

use crate::{ByClass, Class};
use covmap::{Cell, CoverageMap, Grid, LIKELIHOOD_FLOOR, crps, log_likelihood};
use covmap_model::{ModelError, ModelParameters, SensorModel, integrate};
use covmap_sonar::{Scan, SonarRing};
use serde::Serialize;

/// The scans of one trajectory, and the true coverage of some cells.
///
/// The cells are fixed before any map is built, from geometry alone: a model cannot make
/// itself look better by leaving cells unknown. A cell that a map does not know counts with
/// a uniform posterior.
#[derive(Debug, Clone)]
pub struct Example {
    /// What it is, for reports.
    pub name: String,
    /// The sensors that made the scans.
    pub ring: SonarRing,
    /// The scans, in order.
    pub scans: Vec<Scan>,
    /// The grid of the map.
    pub grid: Grid,
    /// The cells that count, with their true coverage.
    pub truth: Vec<(Cell, f64)>,
}

/// How well a map explains the cells of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ClassScore {
    /// How many cells.
    pub cells: usize,
    /// Mean log-likelihood of the truth, with the floor of `covmap` \[nats\].
    pub log_likelihood: f64,
    /// Mean continuous ranked probability score.
    pub crps: f64,
    /// Mean absolute error of the expected coverage.
    pub error: f64,
}

/// How well a map explains the truth: all cells, and those of each class.
pub type ExampleScore = ByClass<ClassScore>;

impl Example {
    /// The map that a model builds from the scans.
    ///
    /// # Errors
    /// If the parameters make no model for the ring and the grid.
    pub fn map(&self, parameters: &ModelParameters) -> Result<CoverageMap, ModelError> {
        self.map_of(&SensorModel::new(parameters, &self.ring, self.grid.resolution())?)
    }

    pub(crate) fn map_of(&self, model: &SensorModel) -> Result<CoverageMap, ModelError> {
        let bins = model.parameters().bins;
        let mut map = CoverageMap::new(self.grid, bins).map_err(|_| ModelError::Bins(bins))?;
        self.scans.iter().for_each(|scan| drop(integrate(model, &mut map, scan)));
        Ok(map)
    }
}

/// The true coverages of the cells of some examples, in their order.
pub(crate) fn truths(examples: &[Example]) -> impl Iterator<Item = f64> {
    examples.iter().flat_map(|e| &e.truth).map(|(_, coverage)| *coverage)
}

/// What a cell's posterior is worth: log-likelihood, CRPS, and error of the expected coverage.
pub(crate) fn measures(posterior: &[f64], truth: f64) -> [f64; 3] {
    let likelihood = log_likelihood(posterior, truth, LIKELIHOOD_FLOOR);
    [likelihood, crps(posterior, truth), (mean(posterior) - truth).abs()]
}

impl ExampleScore {
    /// Scores posteriors, each with the truth of its cell.
    pub(crate) fn of(cells: impl Iterator<Item = (impl AsRef<[f64]>, f64)>) -> Self {
        let mut score = Self::default();
        for (posterior, coverage) in cells {
            let [log_likelihood, crps, error] = measures(posterior.as_ref(), coverage);
            let class = score.of_class_mut(Class::of(coverage));
            class.cells += 1;
            class.log_likelihood += log_likelihood;
            class.crps += crps;
            class.error += error;
        }
        let classes = [score.free, score.partial, score.solid];
        score.all = classes.iter().fold(ClassScore::default(), |sum, class| ClassScore {
            cells: sum.cells + class.cells,
            log_likelihood: sum.log_likelihood + class.log_likelihood,
            crps: sum.crps + class.crps,
            error: sum.error + class.error,
        });
        for class in [&mut score.all, &mut score.free, &mut score.partial, &mut score.solid] {
            #[allow(clippy::cast_precision_loss, reason = "at most 2e7 cells")]
            let cells = class.cells.max(1) as f64;
            class.log_likelihood /= cells;
            class.crps /= cells;
            class.error /= cells;
        }
        score
    }

    /// The score of all examples together, cell by cell, from that of each.
    pub(crate) fn pooled(scores: &[Self]) -> Self {
        Self::from_fn(|class| {
            let each = || scores.iter().map(|score| score.get(class));
            let cells: usize = each().map(|s| s.cells).sum();
            #[allow(clippy::cast_precision_loss, reason = "at most 2e7 cells")]
            let weighted = |f: fn(&ClassScore) -> f64| {
                let sum: f64 = each().map(|s| f(s) * s.cells as f64).sum();
                sum / cells.max(1) as f64
            };
            ClassScore {
                cells,
                log_likelihood: weighted(|c| c.log_likelihood),
                crps: weighted(|c| c.crps),
                error: weighted(|c| c.error),
            }
        })
    }
}

/// The expected coverage of a posterior.
pub(crate) fn mean(posterior: &[f64]) -> f64 {
    let bins = posterior.len();
    posterior.iter().enumerate().map(|(k, p)| p * covmap::bin_coverage(k, bins)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_scored_apart() {
        let truth = [(Cell::new(0, 0), 0.0), (Cell::new(1, 0), 0.5), (Cell::new(2, 0), 1.0)];
        let sure_of = |bin: usize| (0..11).map(|k| f64::from(u8::from(k == bin))).collect();
        let score = |posterior: &dyn Fn(Cell) -> Vec<f64>| {
            ExampleScore::of(truth.iter().map(|(cell, coverage)| (posterior(*cell), *coverage)))
        };
        let right = score(&|cell| sure_of(usize::try_from(5 * cell.x).unwrap()));
        assert!(right.all.log_likelihood > -0.002 && right.all.error < 1e-12);
        let free = score(&|_| sure_of(0));
        assert_eq!((free.all.cells, free.partial.cells), (3, 1));
        assert!((free.partial.error - 0.5).abs() < 1e-12 && (free.solid.crps - 1.0).abs() < 1e-12);
        assert!(free.free.log_likelihood > -0.002 && free.all.log_likelihood < -6.0);
    }
}
