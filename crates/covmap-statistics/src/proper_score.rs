//! Proper scores of a posterior against the true coverage of a cell.
//!
//! A truth between the bins k and k + 1, at the fraction t of the way, counts as bin k with
//! the weight 1 − t and as bin k + 1 with the weight t.

use covmap::{bin_coverage, lower_bin};

/// η: the share of every posterior that is spread evenly over its bins before a likelihood is
/// taken. No truth is then impossible. The share is the same for every method that is compared.
pub const LIKELIHOOD_FLOOR: f64 = 0.001;

/// Returns the log-likelihood of the true coverage \[nats\]. The floor η is [`LIKELIHOOD_FLOOR`]
/// unless the choice of the floor is under study:
///
/// ```text
/// (1 − t)·log p'_k + t·log p'_{k+1},   p' = (1 − η)·p + η/n
/// ```
///
/// # Panics
/// Unless there are at least two bins.
pub fn log_likelihood(probabilities: &[f64], coverage: f64, floor: f64) -> f64 {
    let (k, t) = lower_bin(coverage, probabilities.len());
    let even = floor / probabilities.len() as f64;
    let log = |p: f64| libm::log((1.0 - floor) * p + even);
    (1.0 - t) * log(probabilities[k]) + t * log(probabilities[k + 1])
}

/// Returns the continuous ranked probability score against the true coverage x. The score is 0 for
/// a posterior with all its mass at x. With F the cumulated posterior,
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

/// Returns the randomised probability integral transform, which is uniform over \[0, 1\] if truths
/// are drawn from the posteriors. `u` and `v` are independent uniform numbers in \[0, 1): u places
/// the value within the mass of the truth's bin, v chooses the bin below or above the truth.
///
/// # Panics
/// Unless there are at least two bins.
pub fn randomised_pit(probabilities: &[f64], coverage: f64, u: f64, v: f64) -> f64 {
    let (k, t) = lower_bin(coverage, probabilities.len());
    let bin = if v < t { k + 1 } else { k };
    probabilities[..bin].iter().sum::<f64>() + u * probabilities[bin]
}

/// Returns the probability, over u and v, that [`randomised_pit`] lies in the central `level` of \[0, 1\].
/// Its mean is `level` if truths are drawn from the posteriors. The function itself draws nothing.
///
/// # Panics
/// Unless there are at least two bins.
pub fn central(probabilities: &[f64], coverage: f64, level: f64) -> f64 {
    let (k, t) = lower_bin(coverage, probabilities.len());
    let (low, high) = (0.5 * (1.0 - level), 0.5 * (1.0 + level));
    let inside = |bin: usize| {
        let from: f64 = probabilities[..bin].iter().sum();
        let (p, to) = (probabilities[bin], from + probabilities[bin]);
        if p > 0.0 {
            ((to.min(high) - from.max(low)) / p).clamp(0.0, 1.0)
        } else {
            f64::from(u8::from((low..=high).contains(&from)))
        }
    };
    (1.0 - t) * inside(k) + t * inside(k + 1)
}

/// Returns whether the central interval of a posterior holds the true coverage. The interval reaches from
/// half a bin below the first bin at which the cumulated posterior reaches (1 − level)/2 to half a bin above
/// the first bin at which it reaches (1 + level)/2. Bins are wide, so the intervals of a posterior that is
/// right hold more truths than `level`; [`central`] has no such excess.
///
/// # Panics
/// Unless there are at least two bins.
pub fn interval_holds(probabilities: &[f64], coverage: f64, level: f64) -> bool {
    let bins = probabilities.len();
    let first = |level: f64| {
        let mut sum = 0.0;
        let reaches = |p: &f64| {
            sum += p;
            sum >= level
        };
        bin_coverage(probabilities.iter().position(reaches).unwrap_or(bins - 1), bins)
    };
    let half_bin = 0.5 * bin_coverage(1, bins) + 1e-9;
    let (low, high) = (first(0.5 * (1.0 - level)), first(0.5 * (1.0 + level)));
    (low - half_bin..=high + half_bin).contains(&coverage)
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

    #[test]
    fn what_the_central_interval_holds_by_hand() {
        // Three bins; the masses lie in [0, .2], [.2, .9] and [.9, 1].
        let p = [0.2, 0.7, 0.1];
        // Of [0, .2] the part above .05 is .15; of [.9, 1] that below .95 is .05.
        assert!((central(&p, 0.0, 0.9) - 0.75).abs() < 1e-12);
        assert!((central(&p, 0.5, 0.9) - 1.0).abs() < 1e-12);
        assert!((central(&p, 1.0, 0.9) - 0.5).abs() < 1e-12);
        // A quarter of the way from the first bin to the second.
        assert!((central(&p, 0.125, 0.9) - (0.75 * 0.75 + 0.25)).abs() < 1e-12);
        // Bins without mass stand at an end of the interval, or outside of it.
        assert!(central(&[1.0, 0.0], 1.0, 0.9) < 1e-12);
        assert!((central(&[0.5, 0.0, 0.5], 0.5, 0.9) - 1.0).abs() < 1e-12);
        // The interval reaches from the first bin to the last: .2 ≥ .05, and .9 < .95.
        assert!(interval_holds(&p, 0.0, 0.9) && interval_holds(&p, 1.0, 0.9));
        // At one half it is the second bin alone, with half a bin to each side.
        assert!(interval_holds(&p, 0.25, 0.5) && interval_holds(&p, 0.75, 0.5));
        assert!(!interval_holds(&p, 0.24, 0.5) && !interval_holds(&p, 0.76, 0.5));
    }

    proptest! {
        #[test]
        fn the_central_share_is_that_of_the_randomised_transform(
            p in posterior(), x in 0.0..1.0f64, level in 0.1..0.95f64
        ) {
            let steps = || (0..200).map(|i| (f64::from(i) + 0.5) / 200.0);
            let (k, t) = lower_bin(x, 11);
            // v falls below t with probability t: one v of either kind, with its weight.
            let share = |v: f64| {
                let is_in = |u: f64| (randomised_pit(&p, x, u, v) - 0.5).abs() <= 0.5 * level;
                steps().filter(|u| is_in(*u)).count() as f64 / 200.0
            };
            let drawn = (1.0 - t) * share(0.999_999) + t * share(0.0);
            prop_assert!((central(&p, x, level) - drawn).abs() < 0.011, "{k} {t} {drawn}");
        }

        #[test]
        fn truths_that_are_drawn_from_posteriors_are_central_as_often_as_they_should(
            p in posterior(), level in 0.1..0.95f64
        ) {
            let drawn: f64 = (0..11).map(|k| p[k] * central(&p, bin_coverage(k, 11), level)).sum();
            prop_assert!((drawn - level).abs() < 1e-9);
        }

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
