//! How well a posterior explains the true coverage of a cell: proper scores.
//!
//! A truth between the bins k and k + 1, at the fraction t of the way, counts as bin k with
//! the weight 1 − t and as bin k + 1 with the weight t.

use crate::bin_coverage;

/// A coverage this near to 0 or to 1 is one of them: exact coverages are good to this.
const EXACT: f64 = 1e-9;

/// The class of a cell by its true coverage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Coverage 0.
    Free,
    /// A coverage between 0 and 1.
    Partial,
    /// Coverage 1.
    Solid,
}

impl Class {
    /// The class of a true coverage.
    pub fn of(coverage: f64) -> Self {
        match coverage {
            c if c < EXACT => Self::Free,
            c if c > 1.0 - EXACT => Self::Solid,
            _ => Self::Partial,
        }
    }
}

/// The share of every posterior that is spread evenly over its bins before a likelihood is
/// taken, so that no truth is impossible: η, the same for every method that is compared.
pub const LIKELIHOOD_FLOOR: f64 = 0.001;

/// The bin below a coverage, below the last one, and the fraction of the way to the next: how
/// a coverage between two bins is divided among them.
///
/// # Panics
/// Unless there are at least two bins.
pub fn lower_bin(coverage: f64, bins: usize) -> (usize, f64) {
    #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
    let place = coverage.clamp(0.0, 1.0) * (bins - 1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 64")]
    let k = (place.floor() as usize).min(bins - 2);
    #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
    let t = place - k as f64;
    (k, t)
}

/// The log-likelihood of the true coverage \[nats\], with the floor η ([`LIKELIHOOD_FLOOR`]
/// unless the choice of the floor is what is studied):
///
/// ```text
/// (1 − t)·log p'_k + t·log p'_{k+1},   p' = (1 − η)·p + η/n
/// ```
///
/// # Panics
/// Unless there are at least two bins.
pub fn log_likelihood(probabilities: &[f64], coverage: f64, floor: f64) -> f64 {
    let (k, t) = lower_bin(coverage, probabilities.len());
    #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
    let even = floor / probabilities.len() as f64;
    let log = |p: f64| libm::log((1.0 - floor) * p + even);
    (1.0 - t) * log(probabilities[k]) + t * log(probabilities[k + 1])
}

/// The continuous ranked probability score against the true coverage x, 0 for a posterior
/// that has all its mass there; with F the cumulated posterior,
///
/// ```text
/// CRPS = ∫₀¹ (F(c) − [c ≥ x])² dc
/// ```
///
/// # Panics
/// Unless there are at least two bins.
pub fn crps(probabilities: &[f64], coverage: f64) -> f64 {
    let bins = probabilities.len();
    let truth = coverage.clamp(0.0, 1.0);
    let (mut score, mut cumulated) = (0.0, 0.0);
    for (k, p) in probabilities[..bins - 1].iter().enumerate() {
        cumulated += p;
        let (from, to) = (bin_coverage(k, bins), bin_coverage(k + 1, bins));
        let below = truth.clamp(from, to) - from;
        let above = (to - from) - below;
        score += below * cumulated * cumulated + above * (1.0 - cumulated) * (1.0 - cumulated);
    }
    score
}

/// The randomised probability integral transform: uniform over \[0, 1\] if truths are drawn
/// from the posteriors. `u` and `v` are independent uniform numbers in \[0, 1): u places the
/// value within the mass of the truth's bin, v chooses the bin below or above the truth.
///
/// # Panics
/// Unless there are at least two bins.
pub fn randomised_pit(probabilities: &[f64], coverage: f64, u: f64, v: f64) -> f64 {
    let (k, t) = lower_bin(coverage, probabilities.len());
    let bin = if v < t { k + 1 } else { k };
    probabilities[..bin].iter().sum::<f64>() + u * probabilities[bin]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn posterior() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(0.001..1.0f64, 11).prop_map(|weights| {
            let sum: f64 = weights.iter().sum();
            weights.iter().map(|w| w / sum).collect()
        })
    }

    #[test]
    fn a_sure_posterior_is_right_or_very_wrong() {
        let mut sure = [0.0; 11];
        sure[2] = 1.0;
        assert!(log_likelihood(&sure, 0.2, LIKELIHOOD_FLOOR).abs() < 2e-3);
        assert!(log_likelihood(&sure, 0.7, LIKELIHOOD_FLOOR) < -9.0);
        assert!(crps(&sure, 0.2).abs() < 1e-12 && (crps(&sure, 0.7) - 0.5).abs() < 1e-12);
        // Half way between two bins: half of each.
        assert!(log_likelihood(&sure, 0.25, LIKELIHOOD_FLOOR) < -4.0);
        assert!((randomised_pit(&sure, 0.2, 0.3, 0.9) - 0.3).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_log_likelihood_is_proper(truth in posterior(), other in posterior()) {
            // Truths drawn from the posterior score best under it.
            let expected = |p: &[f64]| -> f64 {
                (0..11).map(|k| truth[k] * log_likelihood(p, bin_coverage(k, 11), 0.0)).sum()
            };
            prop_assert!(expected(&truth) >= expected(&other) - 1e-12);
        }

        #[test]
        fn the_crps_is_proper(truth in posterior(), other in posterior()) {
            let expected = |p: &[f64]| -> f64 {
                (0..11).map(|k| truth[k] * crps(p, bin_coverage(k, 11))).sum()
            };
            prop_assert!(expected(&truth) <= expected(&other) + 1e-12);
        }

        #[test]
        fn the_transform_lies_within_the_truths_bin(p in posterior(), x in 0.0..1.0f64, u in 0.0..1.0f64, v in 0.0..1.0f64) {
            let pit = randomised_pit(&p, x, u, v);
            prop_assert!((0.0..=1.0 + 1e-9).contains(&pit));
        }
    }
}
