//! What the model is fitted to: scans, and the truth of a fixed set of cells.

use crate::Class;
use covmap::{Cell, CoverageMap, Grid, LIKELIHOOD_FLOOR, crps, log_likelihood};
use covmap_model::{ModelError, ModelParameters, SensorModel, integrate};
use covmap_sonar::{Scan, SonarRing};
use serde::{Deserialize, Serialize};

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
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExampleScore {
    /// All cells.
    pub all: ClassScore,
    /// Cells of coverage 0.
    pub free: ClassScore,
    /// Cells of a coverage between 0 and 1.
    pub partial: ClassScore,
    /// Cells of coverage 1.
    pub solid: ClassScore,
}

impl Example {
    /// The map that a model builds from the scans.
    ///
    /// # Errors
    /// If the parameters make no model for the ring and the grid.
    pub fn map(&self, parameters: &ModelParameters) -> Result<CoverageMap, ModelError> {
        let model = SensorModel::new(parameters, &self.ring, self.grid.resolution())?;
        let mut map = CoverageMap::new(self.grid, parameters.bins)
            .map_err(|_| ModelError::Bins(parameters.bins))?;
        self.scans.iter().for_each(|scan| drop(integrate(&model, &mut map, scan)));
        Ok(map)
    }

    /// How well the map that a model builds explains the truth.
    ///
    /// # Errors
    /// As [`Example::map`].
    pub fn score(&self, parameters: &ModelParameters) -> Result<ExampleScore, ModelError> {
        let map = self.map(parameters)?;
        Ok(ExampleScore::of(&self.truth, |cell| map.histogram(cell).probabilities().to_vec()))
    }
}

impl ExampleScore {
    /// Scores the posterior of every cell against its truth.
    pub fn of(truth: &[(Cell, f64)], posterior: impl Fn(Cell) -> Vec<f64>) -> Self {
        Self::of_all(truth.iter().map(|(cell, coverage)| (posterior(*cell), *coverage)))
    }

    /// Scores posteriors, one for each cell of the truth, in its order.
    pub(crate) fn of_posteriors(
        truth: &[(Cell, f64)],
        posteriors: impl Iterator<Item = impl AsRef<[f64]>>,
    ) -> Self {
        Self::of_all(posteriors.zip(truth.iter().map(|(_, coverage)| *coverage)))
    }

    fn of_all(cells: impl Iterator<Item = (impl AsRef<[f64]>, f64)>) -> Self {
        let mut score = Self::default();
        for (p, coverage) in cells {
            let p = p.as_ref();
            let class = match Class::of(coverage) {
                Class::Free => &mut score.free,
                Class::Partial => &mut score.partial,
                Class::Solid => &mut score.solid,
            };
            class.cells += 1;
            class.log_likelihood += log_likelihood(p, coverage, LIKELIHOOD_FLOOR);
            class.crps += crps(p, coverage);
            class.error += (mean(p) - coverage).abs();
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
        let pool = |class: fn(&Self) -> ClassScore| {
            let cells: usize = scores.iter().map(|s| class(s).cells).sum();
            #[allow(clippy::cast_precision_loss, reason = "at most 2e7 cells")]
            let weighted = |f: fn(&ClassScore) -> f64| {
                let sum: f64 = scores.iter().map(|s| f(&class(s)) * class(s).cells as f64).sum();
                sum / cells.max(1) as f64
            };
            ClassScore {
                cells,
                log_likelihood: weighted(|c| c.log_likelihood),
                crps: weighted(|c| c.crps),
                error: weighted(|c| c.error),
            }
        };
        Self {
            all: pool(|s| s.all),
            free: pool(|s| s.free),
            partial: pool(|s| s.partial),
            solid: pool(|s| s.solid),
        }
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
        let right = ExampleScore::of(&truth, |cell| sure_of(usize::try_from(5 * cell.x).unwrap()));
        assert!(right.all.log_likelihood > -0.002 && right.all.error < 1e-12);
        let free = ExampleScore::of(&truth, |_| sure_of(0));
        assert_eq!((free.all.cells, free.partial.cells), (3, 1));
        assert!((free.partial.error - 0.5).abs() < 1e-12 && (free.solid.crps - 1.0).abs() < 1e-12);
        assert!(free.free.log_likelihood > -0.002 && free.all.log_likelihood < -6.0);
    }
}
