//! Scores of posteriors against the truth, class by class.

use crate::{ByClass, Class};
use covmap::{bin_coverage, mode_bin};
use covmap_statistics::{LIKELIHOOD_FLOOR, central, crps, interval_holds, log_likelihood};
use serde::{Deserialize, Serialize};
use std::iter::Sum;
use std::ops::Add;

/// Bounds of the modes that are partly covered, strictly between them.
const BETWEEN: (f64, f64) = (0.05, 0.95);
/// Least mode of a cell that is found to be a wall.
const FOUND: f64 = 0.5;

/// Scores of a map on the cells of one class: means over the cells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ClassScore {
    /// Number of cells.
    pub cells: usize,
    /// Log-likelihood of the truth, with the floor of `covmap` \[nats\].
    pub log_likelihood: f64,
    /// Continuous ranked probability score.
    pub crps: f64,
    /// Absolute error of the expected coverage.
    pub error: f64,
    /// Absolute error of the most likely coverage; of two such, of the lower one.
    pub error_of_mode: f64,
    /// The share of modes in (.05, .95).
    pub between: f64,
    /// The share of modes of at least ½.
    pub found: f64,
    /// The share of truths in the central 90 %, in the mean over the randomised probability
    /// integral transform ([`central`]): .9, if truths are drawn from the posteriors.
    pub central_90: f64,
    /// The share of truths that the central 90 % interval holds, with half a bin to each side
    /// ([`interval_holds`]): .9 or more, if truths are drawn from the posteriors.
    pub held_90: f64,
}

/// Scores of a map against the truth: of all cells, and of those of each class.
pub type ExampleScore = ByClass<ClassScore>;

impl ClassScore {
    /// Scores the posterior of one cell.
    pub(crate) fn of_cell(posterior: &[f64], truth: f64) -> Self {
        let mode = bin_coverage(mode_bin(posterior), posterior.len());
        let share = |is: bool| f64::from(u8::from(is));
        Self {
            cells: 1,
            log_likelihood: log_likelihood(posterior, truth, LIKELIHOOD_FLOOR),
            crps: crps(posterior, truth),
            error: (mean(posterior) - truth).abs(),
            error_of_mode: (mode - truth).abs(),
            between: share(BETWEEN.0 < mode && mode < BETWEEN.1),
            found: share(mode >= FOUND),
            central_90: central(posterior, truth, 0.9),
            held_90: share(interval_holds(posterior, truth, 0.9)),
        }
    }

    /// Multiplies every mean by a number.
    fn times(self, factor: f64) -> Self {
        Self {
            cells: self.cells,
            log_likelihood: self.log_likelihood * factor,
            crps: self.crps * factor,
            error: self.error * factor,
            error_of_mode: self.error_of_mode * factor,
            between: self.between * factor,
            found: self.found * factor,
            central_90: self.central_90 * factor,
            held_90: self.held_90 * factor,
        }
    }

    /// Returns means in place of sums.
    fn mean(self) -> Self {
        self.times(1.0 / count(self.cells).max(1.0))
    }
}

impl Add for ClassScore {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            cells: self.cells + other.cells,
            log_likelihood: self.log_likelihood + other.log_likelihood,
            crps: self.crps + other.crps,
            error: self.error + other.error,
            error_of_mode: self.error_of_mode + other.error_of_mode,
            between: self.between + other.between,
            found: self.found + other.found,
            central_90: self.central_90 + other.central_90,
            held_90: self.held_90 + other.held_90,
        }
    }
}

impl Sum for ClassScore {
    fn sum<I: Iterator<Item = Self>>(scores: I) -> Self {
        scores.fold(Self::default(), Add::add)
    }
}

impl ExampleScore {
    /// Scores posteriors, each with the truth of its cell.
    pub fn of(cells: impl Iterator<Item = (impl AsRef<[f64]>, f64)>) -> Self {
        let mut sums = Self::default();
        for (posterior, truth) in cells {
            let class = sums.of_class_mut(Class::of(truth));
            *class = *class + ClassScore::of_cell(posterior.as_ref(), truth);
        }
        sums.all = sums.free + sums.partial + sums.solid;
        Self::from_fn(|class| sums.get(class).mean())
    }

    /// Returns the score of all examples together, cell by cell, from that of each.
    pub(crate) fn pooled(scores: &[Self]) -> Self {
        let sum = |score: &ClassScore| score.times(count(score.cells));
        Self::from_fn(|class| scores.iter().map(|s| sum(s.get(class))).sum::<ClassScore>().mean())
    }
}

fn count(cells: usize) -> f64 {
    cells as f64
}

/// Returns the expected coverage of a posterior.
pub(crate) fn mean(posterior: &[f64]) -> f64 {
    let bins = posterior.len();
    posterior.iter().enumerate().map(|(k, p)| p * bin_coverage(k, bins)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sure_of(bin: usize) -> Vec<f64> {
        (0..11).map(|k| f64::from(u8::from(k == bin))).collect()
    }

    /// Returns the score of one free, one half covered and one solid cell.
    fn score(bins: [usize; 3]) -> ExampleScore {
        ExampleScore::of(bins.map(sure_of).into_iter().zip([0.0, 0.5, 1.0]))
    }

    #[test]
    fn classes_are_scored_apart() {
        let right = score([0, 5, 10]);
        assert!(right.all.log_likelihood > -0.002 && right.all.error < 1e-12);
        let free = score([0, 0, 0]);
        assert_eq!((free.all.cells, free.partial.cells), (3, 1));
        assert!((free.partial.error - 0.5).abs() < 1e-12 && (free.solid.crps - 1.0).abs() < 1e-12);
        assert!(free.free.log_likelihood > -0.002 && free.all.log_likelihood < -6.0);
    }

    #[test]
    fn what_is_reported_of_a_class_by_hand() {
        // Two partial cells of .3 and .6, by one posterior: its mode is .4, its mean .46.
        let mut p = vec![0.0; 11];
        (p[4], p[5], p[10]) = (0.6, 0.32, 0.06);
        p[0] = 0.02;
        let all = ExampleScore::of([(&p, 0.3), (&p, 0.6)].into_iter());
        let of = all.partial;
        assert!((of.error_of_mode - 0.15).abs() < 1e-12, "{of:?}");
        assert!((of.error - 0.5 * (0.16 + 0.14)).abs() < 1e-12, "{of:?}");
        assert!((of.between - 1.0).abs() < 1e-12 && of.found.abs() < 1e-12);
        // The cumulated posterior is .02 at .3, and .94 at .6: below .05, so outside, and inside.
        assert!((of.central_90 - 0.5).abs() < 1e-12);
        // From .4, the first bin at which it reaches .05, to 1, with .05 to each side.
        assert!((of.held_90 - 0.5).abs() < 1e-12);
        let wall = ExampleScore::of([(sure_of(5), 1.0), (sure_of(4), 1.0)].into_iter()).solid;
        assert!((wall.found - 0.5).abs() < 1e-12 && (wall.between - 1.0).abs() < 1e-12);
        assert!((wall.error_of_mode - 0.55).abs() < 1e-12);
    }

    #[test]
    fn pooled_scores_are_those_of_all_cells() {
        let (a, b) = (score([0, 3, 10]), score([1, 5, 9]));
        let cells = [0, 3, 10, 1, 5, 9].map(sure_of).into_iter();
        let all = ExampleScore::of(cells.zip([0.0, 0.5, 1.0, 0.0, 0.5, 1.0]));
        let pooled = ExampleScore::pooled(&[a, b]);
        assert!((pooled.all.log_likelihood - all.all.log_likelihood).abs() < 1e-12);
        assert!((pooled.partial.error_of_mode - 0.1).abs() < 1e-12);
        assert_eq!(pooled.all.cells, 6);
    }
}
