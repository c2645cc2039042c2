//! The posterior over the coverage of one cell.

/// The smallest number of bins.
pub const MIN_BINS: usize = 2;
/// The largest number of bins.
pub const MAX_BINS: usize = 64;

/// The floor under every bin's probability before the last normalisation. Every stored probability
/// is therefore at least 1e-9, but for one part in a million by normalising and by rounding.
///
/// Choice: the paper has no floor. With the floor every logarithm is finite, and evidence can
/// reverse a posterior however sure it was.
pub const PROBABILITY_FLOOR: f64 = 1e-9;

/// Returns the coverage at which bin `bin` of `bins` stands: `bin / (bins − 1)`.
///
/// Choice: bins stand **at** coverages and not between them, so that 0, 1 and, with 11 bins, the
/// 0.2 of the paper's Fig. 1 are exact. Fewer than two bins count as two.
pub fn bin_coverage(bin: usize, bins: usize) -> f64 {
    bin as f64 / (bins.max(2) - 1) as f64
}

/// Writes the product of a prior and the evidence of one measurement to `out`, and returns its sum
/// Z. The product is taken bin by bin, as in Eq. (8), and is not normalised.
///
/// Every use of a measurement in this project is this product, whether the measurement is integrated or only
/// imagined for its information gain. The literal evaluations of both uses share it. The fast evaluations
/// compute the same for many cells side by side, and are tested against the literal ones.
///
/// # Panics
/// If the three slices differ in length.
pub fn product(prior: &[f64], evidence: &[f64], out: &mut [f64]) -> f64 {
    assert!(prior.len() == evidence.len() && prior.len() == out.len(), "as many bins in all");
    let mut sum = 0.0;
    for ((o, p), e) in out.iter_mut().zip(prior).zip(evidence) {
        *o = p * e;
        sum += *o;
    }
    sum
}

/// Returns the entropy of a normalised distribution, Eq. (11), in nats:
///
/// ```text
/// H(h) = −Σ p(h_i) · log p(h_i)
/// ```
fn entropy(probabilities: &[f64]) -> f64 {
    let sum: f64 = probabilities.iter().filter(|p| **p > 0.0).map(|p| p * libm::log(*p)).sum();
    (-sum).max(0.0)
}

/// Probabilities that differ by less, relatively, are equal: it is more than single precision loses in
/// thousands of updates.
pub(crate) const TIE: f32 = 1e-4;

/// Returns the bin with the largest probability. Bins within a relative 1e-4 of it tie; a tie goes to the lowest
/// coverage.
pub fn mode_bin<T: Copy + Into<f64>>(probabilities: &[T]) -> usize {
    let probabilities = || probabilities.iter().map(|p| -> f64 { (*p).into() });
    let least = probabilities().fold(0.0, f64::max) * (1.0 - f64::from(TIE));
    probabilities().position(|p| p >= least).unwrap_or(0)
}

/// A normalised histogram over n coverages `0, 1/(n−1), …, 1`.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    probabilities: Vec<f64>,
}

impl Histogram {
    /// Returns the uniform histogram of `bins` bins, in which nothing is known.
    ///
    /// # Panics
    /// Unless `bins` is in [`MIN_BINS`]`..=`[`MAX_BINS`].
    pub fn uniform(bins: usize) -> Self {
        assert!((MIN_BINS..=MAX_BINS).contains(&bins), "{bins} bins");
        let p = 1.0 / bins as f64;
        Self { probabilities: vec![p; bins] }
    }

    /// Returns the histogram with bins in proportion to `weights`; `None` if the number of weights
    /// is out of range, a weight is negative or not finite, or all weights are 0.
    pub fn from_weights(weights: &[f64]) -> Option<Self> {
        let sum: f64 = weights.iter().sum();
        let valid = (MIN_BINS..=MAX_BINS).contains(&weights.len())
            && weights.iter().all(|w| w.is_finite() && *w >= 0.0)
            && sum.is_finite()
            && sum > 0.0;
        valid.then(|| Self { probabilities: weights.iter().map(|w| w / sum).collect() })
    }

    /// Returns the probability of each bin; the probabilities sum to 1.
    pub fn probabilities(&self) -> &[f64] {
        &self.probabilities
    }

    /// Returns the entropy, Eq. (11) \[nats\]: 0 ≤ H ≤ ln n.
    pub fn entropy(&self) -> f64 {
        entropy(&self.probabilities)
    }

    /// Returns the most likely coverage; a tie goes to the lower coverage.
    pub fn mode(&self) -> f64 {
        bin_coverage(mode_bin(&self.probabilities), self.probabilities.len())
    }

    /// Returns the expected coverage.
    pub fn mean(&self) -> f64 {
        let n = self.probabilities.len();
        self.probabilities.iter().enumerate().map(|(k, p)| p * bin_coverage(k, n)).sum()
    }

    /// Returns the central interval of coverages that holds at least `level` of the probability:
    /// each tail outside the interval holds at most `(1 − level)/2`.
    pub fn credible_interval(&self, level: f64) -> (f64, f64) {
        let n = self.probabilities.len();
        let tail = (1.0 - level.clamp(0.0, 1.0)) / 2.0 + 1e-12;
        // The first bin, counted inwards, at which the cumulated probability exceeds a tail.
        let first_inside = |bins: &[f64]| {
            let mut sum = 0.0;
            let over = |p: &f64| {
                sum += p;
                sum > tail
            };
            bins.iter().position(over).unwrap_or(0)
        };
        let lower = first_inside(&self.probabilities);
        let reversed: Vec<f64> = self.probabilities.iter().rev().copied().collect();
        let upper = n - 1 - first_inside(&reversed);
        (bin_coverage(lower, n), bin_coverage(upper, n))
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn entropy_is_maximal_for_uniform() {
        assert!((Histogram::uniform(11).entropy() - libm::log(11.0)).abs() < 1e-12);
    }

    #[test]
    fn bins_stand_at_coverages() {
        let coverages = |bins| (0..bins).map(|bin| bin_coverage(bin, bins)).collect::<Vec<_>>();
        assert_eq!(coverages(3), [0.0, 0.5, 1.0]);
        assert_eq!((bin_coverage(0, 0), bin_coverage(0, 1)), (0.0, 0.0));
    }

    #[test]
    fn entropy_is_zero_for_certainty() {
        let certain = Histogram::from_weights(&[0.0, 3.0, 0.0]).unwrap();
        assert_eq!(certain.entropy(), 0.0);
        assert_eq!(certain.mode(), 0.5);
    }

    #[test]
    fn a_tie_is_the_lower_coverage() {
        assert_eq!(Histogram::from_weights(&[0.1, 0.4, 0.4, 0.1]).unwrap().mode(), 1.0 / 3.0);
        // What rounding makes of it is a tie, too.
        let rounded = |more: f64| Histogram::from_weights(&[0.1, 0.4, 0.4 * (1.0 + more), 0.1]);
        assert_eq!(rounded(9e-5).unwrap().mode(), 1.0 / 3.0);
        assert_eq!(rounded(2e-4).unwrap().mode(), 2.0 / 3.0);
    }

    #[test]
    fn a_credible_interval_leaves_out_thin_tails() {
        let h = Histogram::from_weights(&[0.04, 0.4, 0.5, 0.03, 0.03]).unwrap();
        assert_eq!(h.credible_interval(0.9), (0.25, 0.75));
        assert_eq!(h.credible_interval(0.5), (0.25, 0.5));
        assert_eq!(h.credible_interval(1.0), (0.0, 1.0));
    }

    #[test]
    fn weights_that_are_no_histogram_are_refused() {
        for weights in [&[1.0][..], &[0.0, 0.0], &[1.0, -1.0], &[f64::NAN, 1.0], &[1.0; 65]] {
            assert_eq!(Histogram::from_weights(weights), None);
        }
    }

    proptest! {
        #[test]
        fn entropy_lies_between_zero_and_ln_n(
            weights in prop::collection::vec(0.0..1.0f64, 2..=64).prop_filter("some", |w| w.iter().sum::<f64>() > 1e-9)
        ) {
            let h = Histogram::from_weights(&weights).unwrap();
            prop_assert!((0.0..=libm::log(weights.len() as f64) + 1e-12).contains(&h.entropy()));
            prop_assert!((h.probabilities().iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let (lower, upper) = h.credible_interval(0.9);
            prop_assert!(lower <= upper && h.mean() >= 0.0 && h.mean() <= 1.0);
        }
    }
}
