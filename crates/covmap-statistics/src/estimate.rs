//! A measured number with its standard error.

use crate::Spread;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// Fewer groups than this that are all alike say nothing of their spread.
const ALIKE: usize = 3;

/// A number with its standard error.
///
/// # Formula
/// ```text
/// interval: value ± t(1 − (1 − level)/2; ν) · standard_error
/// P(true ≤ bound): Student's t with ν degrees of freedom at (bound − value) / standard_error
/// ```
/// With few groups the quantiles of a bootstrap are too narrow; those of Student's t with ν one
/// less than the number of groups are not.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Value of the number.
    pub value: f64,
    /// Standard error of the value, in the same unit.
    pub standard_error: f64,
    /// Number of independent groups behind the value. With fewer than two groups its error is unknown.
    pub groups: usize,
}

impl Estimate {
    /// Returns the mean of independent values; `None` for no values.
    pub fn of_mean(values: &[f64]) -> Option<Self> {
        let Spread { n, mean, deviation, .. } = Spread::of(values)?;
        let standard_error = deviation.map_or(f64::INFINITY, |sd| sd / (n as f64).sqrt());
        Some(Self { value: mean, standard_error, groups: n })
    }

    /// Returns the central interval that holds the true value with a probability of `level` in
    /// \[0, 1); `None` for another level, and with fewer than two groups.
    pub fn interval(&self, level: f64) -> Option<(f64, f64)> {
        if !(0.0..1.0).contains(&level) {
            return None;
        }
        let quantile = self.student()?.inverse_cdf(0.5 + 0.5 * level);
        let half = quantile * self.standard_error;
        Some((self.value - half, self.value + half))
    }

    /// Returns the p-value of "the true value is not below `bound`": small if the true value is
    /// below. The p-value is 1 with fewer than two groups, and for a bound that is no number.
    pub fn p_below(&self, bound: f64) -> f64 {
        self.student().filter(|_| !bound.is_nan()).map_or(1.0, |student| {
            if self.standard_error > 0.0 {
                student.cdf((self.value - bound) / self.standard_error)
            } else {
                // All groups are alike: a few alike groups say nothing of the error.
                f64::from(u8::from(self.groups < ALIKE || self.value >= bound))
            }
        })
    }

    /// Returns the p-value of "the true value is not above `bound`": small if the true value is
    /// above. The p-value is 1 with fewer than two groups, and for a bound that is no number.
    pub fn p_above(&self, bound: f64) -> f64 {
        Self { value: -self.value, ..*self }.p_below(-bound)
    }

    /// Returns the p-value of two one-sided tests of "the true value is not between these bounds":
    /// small if the true value is between them (equivalence).
    pub fn p_between(&self, low: f64, high: f64) -> f64 {
        self.p_above(low).max(self.p_below(high))
    }

    /// Returns the p-value of "the true value lies between these bounds": small if the true value
    /// lies outside.
    pub fn p_outside(&self, low: f64, high: f64) -> f64 {
        (2.0 * self.p_below(low).min(self.p_above(high))).min(1.0)
    }

    /// The number of groups at which a test at a level to one side finds with a probability of `power` that the
    /// true value is not at a bound, if it is as it was estimated, and groups scatter as they do; `None` if
    /// nothing is known of their scatter, or the value lies at the bound.
    ///
    /// # Formula
    /// ```text
    /// n = groups · ((z(1 − level) + z(power)) · standard_error / (value − bound))²
    /// ```
    pub fn groups_needed(&self, bound: f64, level: f64, power: f64) -> Option<f64> {
        self.student()?;
        let normal = Normal::standard();
        let z = normal.inverse_cdf(1.0 - level) + normal.inverse_cdf(power);
        let ratio = z * self.standard_error / (self.value - bound);
        (ratio.is_finite() && self.groups >= 2).then_some(self.groups as f64 * ratio * ratio)
    }

    fn student(&self) -> Option<StudentsT> {
        let groups = u32::try_from(self.groups).ok().filter(|groups| *groups >= 2)?;
        if !(self.value.is_finite() && self.standard_error.is_finite()) {
            return None;
        }
        StudentsT::new(0.0, 1.0, f64::from(groups - 1)).ok()
    }
}

/// Returns the distance of a mean from a bound, in standard deviations of the values, that a one-sided
/// test at `level` finds with a probability of `power` on this number of groups; `None` for fewer than two.
///
/// # Formula
/// ```text
/// (t(1 − level; groups − 1) + z(power)) / √groups
/// ```
pub fn detectable(groups: usize, level: f64, power: f64) -> Option<f64> {
    let student = Estimate { value: 0.0, standard_error: 1.0, groups }.student()?;
    let quantiles = student.inverse_cdf(1.0 - level) + Normal::standard().inverse_cdf(power);
    Some(quantiles / (groups as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_mean_is_students() {
        // 1 … 5: mean 3, s = 1.5811, t(.975; 4) = 2.7764.
        let mean = Estimate::of_mean(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        let (low, high) = mean.interval(0.95).unwrap();
        assert!(
            (mean.value - 3.0).abs() < 1e-12
                && (mean.standard_error - std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-6
        );
        assert!((low - 1.036_756).abs() < 1e-5 && (high - 4.963_243).abs() < 1e-5);
    }

    #[test]
    fn p_values_are_those_of_students_t() {
        // t = −2.7764 with 4 degrees of freedom: .025 to one side.
        let estimate = Estimate { value: 3.0, standard_error: 1.0, groups: 5 };
        assert!((estimate.p_below(3.0 + 2.776_445) - 0.025).abs() < 1e-6);
        assert!((estimate.p_above(3.0 - 2.776_445) - 0.025).abs() < 1e-6);
        assert!((estimate.p_below(3.0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_probability_has_no_interval() {
        let estimate = Estimate { value: 3.0, standard_error: 1.0, groups: 5 };
        for level in [2.0, 1.0, -0.1, f64::NAN, f64::INFINITY] {
            assert_eq!(estimate.interval(level), None, "{level}");
        }
        assert!(estimate.interval(0.0).is_some());
        assert!(estimate.p_below(f64::NAN) >= 1.0 && estimate.p_above(f64::NAN) >= 1.0);
        assert!(estimate.p_below(f64::INFINITY) < 1e-9);
    }

    #[test]
    fn the_groups_that_are_needed_grow_with_the_square_of_the_error() {
        // z(.975) + z(.8) = 1.959964 + .841621 = 2.801585; (2.801585 · .5 / 1)² · 4 = 7.84888.
        let estimate = Estimate { value: 3.0, standard_error: 0.5, groups: 4 };
        let needed = estimate.groups_needed(2.0, 0.025, 0.8).unwrap();
        assert!((needed - 7.848_88).abs() < 1e-4, "{needed}");
        assert!(estimate.groups_needed(3.0, 0.025, 0.8).is_none());
        assert!(Estimate { groups: 1, ..estimate }.groups_needed(2.0, 0.025, 0.8).is_none());
    }

    #[test]
    fn more_groups_find_less() {
        // t(.975; 19) = 2.093024, z(.8) = .841621: 2.934645 / √20 = .656207.
        let found = detectable(20, 0.025, 0.8).unwrap();
        assert!((found - 0.656_207).abs() < 1e-5, "{found}");
        assert!(detectable(5, 0.025, 0.8).unwrap() > 1.5 && detectable(1, 0.025, 0.8).is_none());
    }

    #[test]
    fn equivalence_needs_both_sides() {
        let near = Estimate { value: 1.02, standard_error: 0.02, groups: 5 };
        assert!(near.p_between(0.8, 1.2) < 0.01 && near.p_outside(0.8, 1.2) > 0.99);
        let vague = Estimate { standard_error: 0.3, ..near };
        assert!(vague.p_between(0.8, 1.2) > 0.05 && vague.p_outside(0.8, 1.2) > 0.05);
        let far = Estimate { value: 1.5, ..near };
        assert!(far.p_between(0.8, 1.2) > 0.99 && far.p_outside(0.8, 1.2) < 0.01);
    }

    #[test]
    fn one_group_says_nothing() {
        let single = Estimate::of_mean(&[7.0]).unwrap();
        assert_eq!(single.interval(0.95), None);
        assert!(single.p_below(100.0) >= 1.0 && single.p_above(-100.0) >= 1.0);
        assert_eq!(Estimate::of_mean(&[]), None);
    }

    #[test]
    fn many_groups_that_are_all_alike_are_certain() {
        let few = Estimate::of_mean(&[0.0; 2]).unwrap();
        assert!(few.p_below(0.1) >= 1.0);
        let alike = Estimate::of_mean(&[0.0; 5]).unwrap();
        assert_eq!(alike.interval(0.95), Some((0.0, 0.0)));
        assert!(
            alike.p_below(0.1) < 1e-12 && alike.p_above(0.1) >= 1.0 && alike.p_below(0.0) >= 1.0
        );
    }
}
