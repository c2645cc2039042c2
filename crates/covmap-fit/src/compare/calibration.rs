//! The calibration of a method's output: its levels, and the truths of training data at each.

use crate::class_score::mean;
use covmap::lower_bin;
use serde::Serialize;

/// The number of different levels of a method's output.
pub const CALIBRATION_LEVELS: usize = 20;

/// For every level of a method's expected coverage the distribution of the true coverage in
/// training data.
///
/// ```text
/// level = ⌊20·mean⌋      p(bin | level) = (N(level, bin) + 1) / (N(level) + n)
/// ```
///
/// (Laplace's rule of succession.) A truth between two bins counts in both in parts. All cells
/// count alike. The table forgets all of a posterior but its mean, and gives every method a fair
/// reading of that one number.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CalibrationTable {
    levels: Vec<Vec<f64>>,
}

impl CalibrationTable {
    /// Fits the table to some posteriors over `bins` bins, each with the true coverage of its cell.
    /// Levels that never occur are uniform.
    ///
    /// # Panics
    /// Unless there are at least two bins.
    pub fn fit<'a>(cells: impl IntoIterator<Item = (&'a [f64], f64)>, bins: usize) -> Self {
        let mut levels = vec![vec![1.0; bins]; CALIBRATION_LEVELS];
        for (posterior, truth) in cells {
            let (bin, t) = lower_bin(truth, bins);
            let level = &mut levels[level(posterior)];
            level[bin] += 1.0 - t;
            level[bin + 1] += t;
        }
        for level in &mut levels {
            let sum: f64 = level.iter().sum();
            level.iter_mut().for_each(|p| *p /= sum);
        }
        Self { levels }
    }

    /// Returns the calibrated posterior in place of a method's own.
    pub fn apply(&self, posterior: &[f64]) -> &[f64] {
        &self.levels[level(posterior)]
    }
}

fn level(posterior: &[f64]) -> usize {
    let place = mean(posterior) * CALIBRATION_LEVELS as f64;
    #[allow(clippy::cast_possible_truncation, reason = "at most 20")]
    let level = place as usize;
    level.min(CALIBRATION_LEVELS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_statistics::{log_likelihood, randomised_pit};
    use proptest::prelude::*;

    /// Returns truths from a ramp, with posteriors that are far too certain of half knowledge.
    fn overconfident() -> Vec<(Vec<f64>, f64)> {
        let cell = |i: usize| {
            let truth = (i % 101) as f64 / 100.0;
            let mut p = vec![0.0; 11];
            p[if (i * 7) % 10 < 7 { usize::from(truth > 0.5) * 10 } else { (i / 101) % 11 }] = 1.0;
            (p, truth)
        };
        (0..4040).map(cell).collect()
    }

    /// Returns the distance of the transform's distribution from a uniform one.
    fn distance(cells: &[(Vec<f64>, f64)], of: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
        let fraction = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        let n = cells.len();
        let pit = cells.iter().enumerate().map(|(i, (p, truth))| {
            randomised_pit(&of(p), *truth, fraction(i * 61 % 97, 97), fraction(i * 37 % 89, 89))
        });
        let mut pit: Vec<f64> = pit.collect();
        pit.sort_by(f64::total_cmp);
        let gap = |(i, p): (usize, &f64)| (p - fraction(i, n)).abs();
        pit.iter().enumerate().map(gap).fold(0.0, f64::max)
    }

    #[test]
    fn a_table_makes_training_data_calibrated_and_likelier() {
        let cells = overconfident();
        let table = CalibrationTable::fit(cells.iter().map(|(p, t)| (&p[..], *t)), 11);
        let raw = distance(&cells, <[f64]>::to_vec);
        let calibrated = distance(&cells, |p| table.apply(p).to_vec());
        assert!(raw > 0.2 && calibrated < 0.05, "{raw} {calibrated}");
        let total = |of: &dyn Fn(&[f64]) -> Vec<f64>| -> f64 {
            cells.iter().map(|(p, t)| log_likelihood(&of(p), *t, 1e-3)).sum()
        };
        assert!(total(&|p| table.apply(p).to_vec()) > total(&|p| p.to_vec()));
    }

    proptest! {
        #[test]
        fn every_level_is_a_distribution(truths in prop::collection::vec(0.0..=1.0f64, 0..30)) {
            let sure = |t: f64| vec![1.0 - t, 0.0, t];
            let cells: Vec<_> = truths.iter().map(|t| (sure(*t), *t)).collect();
            let table = CalibrationTable::fit(cells.iter().map(|(p, t)| (&p[..], *t)), 3);
            for level in &table.levels {
                prop_assert!((level.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                prop_assert!(level.iter().all(|p| *p > 0.0));
            }
        }
    }
}
