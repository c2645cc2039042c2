//! The reliability of a map.

use crate::{ByClass, Class};
use covmap::{Histogram, bin_coverage};
use covmap_statistics::central;
use serde::Serialize;

/// The number of levels, from 1/20 to 1.
const LEVELS: u32 = 20;
/// The number of bands of entropy.
const BANDS: usize = 12;

/// Confidence of posteriors, compared with the truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reliability {
    /// For each class, pairs: a level, and the share of truths in the central interval of this
    /// level, in the mean over the randomised transform ([`central`]). The pairs lie on the
    /// diagonal for all cells together, if truths are drawn from the posteriors. (The truth chooses
    /// the class, so that even the true posterior need not be on it: free cells, at one end of the
    /// scale, lie below or above as their posteriors reach out.)
    pub central: ByClass<Vec<(f64, f64)>>,
    /// Cells by their entropy, from sure to unsure; bands without cells are left out.
    pub by_entropy: Vec<EntropyBand>,
}

/// The cells whose posteriors have an entropy in a band.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EntropyBand {
    /// Their mean entropy \[nats\].
    pub entropy: f64,
    /// Number of cells.
    pub cells: usize,
    /// The mean absolute error of their modes.
    pub error: f64,
    /// The error that their posteriors expect: the mean of Σ p_k·|c_k − mode|.
    pub expected_error: f64,
}

impl Reliability {
    /// Measures some posteriors, each with the true coverage of its cell.
    pub fn of<'a>(cells: impl IntoIterator<Item = &'a (Vec<f64>, f64)>) -> Self {
        let mut held: ByClass<(usize, Vec<f64>)> =
            ByClass::from_fn(|_| (0, vec![0.0; LEVELS as usize]));
        let mut bands = [(0usize, [0.0; 3]); BANDS];
        for (posterior, truth) in cells {
            let class = held.of_class_mut(Class::of(*truth));
            class.0 += 1;
            for (sum, level) in class.1.iter_mut().zip(levels()) {
                *sum += central(posterior, *truth, level);
            }
            let Some(histogram) = Histogram::from_weights(posterior) else { continue };
            let (entropy, mode) = (histogram.entropy(), histogram.mode());
            let off = |(k, p): (usize, &f64)| p * (bin_coverage(k, posterior.len()) - mode).abs();
            let expected: f64 = histogram.probabilities().iter().enumerate().map(off).sum();
            let band = &mut bands[band(entropy, posterior.len())];
            band.0 += 1;
            let values = [entropy, (mode - truth).abs(), expected];
            band.1.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        let of_class = |class: Option<Class>| {
            let classes = [Class::Free, Class::Partial, Class::Solid];
            let those = classes.iter().filter(|c| class.is_none_or(|class| class == **c));
            let sums: Vec<_> = those.map(|class| held.get(Some(*class))).collect();
            let cells: usize = sums.iter().map(|(cells, _)| cells).sum();
            let share = |i: usize| sums.iter().map(|(_, held)| held[i]).sum::<f64>() / count(cells);
            let points = levels().enumerate().map(|(i, level)| (level, share(i)));
            if cells > 0 { points.collect() } else { Vec::new() }
        };
        let mean = |(cells, [entropy, error, expected]): &(usize, [f64; 3])| EntropyBand {
            entropy: entropy / count(*cells),
            cells: *cells,
            error: error / count(*cells),
            expected_error: expected / count(*cells),
        };
        let there = bands.iter().filter(|(cells, _)| *cells > 0);
        Self { central: ByClass::from_fn(of_class), by_entropy: there.map(mean).collect() }
    }
}

fn levels() -> impl Iterator<Item = f64> {
    (1..=LEVELS).map(|level| f64::from(level) / f64::from(LEVELS))
}

/// Returns the band of an entropy: the bands divide 0 to ln n evenly.
fn band(entropy: f64, bins: usize) -> usize {
    let place = entropy / libm::log(count(bins)) * count(BANDS);
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    let band = place as usize;
    band.min(BANDS - 1)
}

fn count(cells: usize) -> f64 {
    cells as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn truths_that_are_drawn_from_the_posteriors_lie_on_the_diagonal() {
        let posterior = vec![0.1, 0.4, 0.2, 0.25, 0.05];
        let mut cells = Vec::new();
        for (bin, times) in [2, 8, 4, 5, 1].into_iter().enumerate() {
            let cell = (posterior.clone(), bin_coverage(bin, 5));
            cells.extend(std::iter::repeat_n(cell, times));
        }
        let Reliability { central, by_entropy } = Reliability::of(&cells);
        assert!(central.all.iter().all(|(level, share)| (level - share).abs() < 1e-9));
        // One band; the error of the mode, which is .25, by hand: .25·.1 + .25·.2 + .5·.25 + .75·.05.
        let [band] = by_entropy[..] else { panic!("{by_entropy:?}") };
        assert!((band.error - 0.2375).abs() < 1e-9 && (band.expected_error - 0.2375).abs() < 1e-9);
        assert!((band.entropy - 1.414_8).abs() < 1e-3, "{band:?}");
    }

    #[test]
    fn classes_and_bands_are_told_apart() {
        let sure = vec![1.0, 0.0, 0.0];
        let cells = [(sure.clone(), 0.0), (sure, 1.0), (vec![1.0 / 3.0; 3], 0.5)];
        let Reliability { central, by_entropy } = Reliability::of(&cells);
        // Where it is sure and right the transform is uniform, where it is wrong it is 1.
        let at = |curve: &[(f64, f64)], level: usize| curve[level].1;
        assert!((at(&central.free, 9) - 0.5).abs() < 1e-9 && at(&central.solid, 18) < 1e-9);
        // The middle third.
        assert!((at(&central.partial, 4) - 0.75).abs() < 1e-9);
        let found: Vec<_> =
            by_entropy.iter().map(|b| (b.cells, b.error, b.expected_error)).collect();
        assert_eq!(found.len(), 2);
        assert!((found[0].1 - 0.5).abs() < 1e-9 && found[0].2.abs() < 1e-9 && found[0].0 == 2);
        assert!((found[1].1 - 0.5).abs() < 1e-9 && (found[1].2 - 0.5).abs() < 1e-9);
        assert!(Reliability::of(&[]).central.all.is_empty());
    }
}
