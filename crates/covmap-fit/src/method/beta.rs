//! A baseline: counts of hits and passes, with a Beta posterior.

use covmap::{Cell, Grid, Raster};
use covmap_model::{ModelError, Outcome, SensorModel};
use covmap_sonar::Scan;
use serde::{Deserialize, Serialize};

/// Weights of a beam in the Beta counting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BetaCounting {
    /// a of the prior Beta(a, b): hits before the first scan.
    pub prior_hits: f64,
    /// b of the prior: passes before the first scan.
    pub prior_passes: f64,
    /// Addition to a by a beam that ends in a cell.
    pub hit: f64,
    /// Addition to a by a beam that ends just before a cell; 0 ignores cells behind an end.
    pub behind: f64,
    /// Addition to b by an echo from behind a cell.
    pub pass: f64,
    /// Addition to b by a beam without an echo.
    pub no_echo: f64,
}

impl Default for BetaCounting {
    /// Every hit and every pass counts one, cells behind an end nothing; a = b = ½.
    fn default() -> Self {
        Self { prior_hits: 0.5, prior_passes: 0.5, hit: 1.0, behind: 0.0, pass: 1.0, no_echo: 1.0 }
    }
}

/// Largest prior and weight.
const LARGEST: f64 = 1e3;
/// Largest a and b: the posterior is a point long before.
const LARGEST_COUNT: f64 = 1e6;

impl BetaCounting {
    /// # Errors
    /// If a prior is not positive, or a weight is negative, or one of them too large.
    pub(crate) fn validate(&self) -> Result<(), ModelError> {
        let within = |name, value, min| ModelError::within(name, value, min, LARGEST);
        within("beta.prior_hits", self.prior_hits, 1e-3)?;
        within("beta.prior_passes", self.prior_passes, 1e-3)?;
        within("beta.hit", self.hit, 0.0)?;
        within("beta.behind", self.behind, 0.0)?;
        within("beta.pass", self.pass, 0.0)?;
        within("beta.no_echo", self.no_echo, 0.0)
    }

    /// Returns (a, b) of every cell after some scans; `None` where no beam counted.
    ///
    /// # Panics
    /// If a scan does not fit the model's ring.
    pub(crate) fn counts(
        &self,
        model: &SensorModel,
        grid: Grid,
        scans: &[Scan],
    ) -> Raster<Option<(f64, f64)>> {
        let mut counts: Raster<Option<(f64, f64)>> = Raster::filled(grid, None);
        let half = 0.5 * model.resolution();
        let mut add = |cell: Cell, hits: f64, passes: f64| {
            let Some(count) = counts.get_mut(cell).filter(|_| hits + passes > 0.0) else { return };
            let (a, b) = count.unwrap_or((self.prior_hits, self.prior_passes));
            *count = Some(((a + hits).min(LARGEST_COUNT), (b + passes).min(LARGEST_COUNT)));
        };
        for scan in scans {
            model.for_each_covered(&grid, scan, |cell, cell_distance, outcome| match outcome {
                Outcome::Echo(d) if cell_distance - d > half => add(cell, self.behind, 0.0),
                Outcome::Echo(d) if cell_distance - d >= -half => add(cell, self.hit, 0.0),
                Outcome::Echo(_) | Outcome::Beyond(_) => add(cell, 0.0, self.pass),
                Outcome::NoEcho => add(cell, 0.0, self.no_echo),
            });
        }
        counts
    }
}

/// Returns the distribution Beta(a, b) over n bins that stand **at** coverages.
///
/// A coverage between two bins belongs to both in parts, just as a truth between two bins is
/// scored, so that the mean stays a/(a + b) exactly. With F the cumulated distribution and
/// h = 1/(n − 1),
///
/// ```text
/// p_0 + … + p_k = 1/h · ∫ F(c) dc from k·h to (k+1)·h = (J((k+1)·h) − J(k·h)) / h
/// J(x) = (x − m)·F(x) + m·xᵃ(1 − x)ᵇ / (a·B(a, b)),   m = a/(a + b)
/// ```
///
/// J is ∫ F from 0 to x, by parts and with the recurrence of the incomplete beta function in
/// a \[DLMF 8.17.20\].
pub(crate) fn beta_posterior(a: f64, b: f64, bins: usize) -> Vec<f64> {
    let width = 1.0 / (bins - 1) as f64;
    let m = a / (a + b);
    let integral = |k: usize| {
        if k + 1 == bins {
            return 1.0 - m;
        }
        let x = covmap::bin_coverage(k, bins);
        let (f, power) = beta_cdf(a, b, x);
        (x - m) * f + m * power / a
    };
    let (mut below, mut last) = (0.0, 0.0);
    let mut bin = |k: usize| {
        let cumulated = if k + 1 == bins {
            1.0
        } else {
            let next = integral(k + 1);
            let mean = ((next - last) / width).clamp(0.0, 1.0);
            last = next;
            mean
        };
        let p = f64::max(cumulated - below, 0.0);
        below = f64::max(cumulated, below);
        p
    };
    (0..bins).map(&mut bin).collect()
}

/// Returns the regularised incomplete beta function `I_x(a, b)`, and `xᵃ(1 − x)ᵇ / B(a, b)`.
///
/// The code evaluates the continued fraction \[DLMF 8.17.22\], which converges fast below the mean;
/// above it the code uses `I_x(a, b) = 1 − I_{1−x}(b, a)`. (It is our own, from the portable
/// `libm`, so that results have the same bits everywhere.)
fn beta_cdf(a: f64, b: f64, x: f64) -> (f64, f64) {
    if x <= 0.0 || x >= 1.0 {
        return (if x <= 0.0 { 0.0 } else { 1.0 }, 0.0);
    }
    let log_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let power = libm::exp(a * libm::log(x) + b * libm::log1p(-x) - log_beta);
    let cdf = if x < (a + 1.0) / (a + b + 2.0) {
        power * continued_fraction(a, b, x) / a
    } else {
        1.0 - power * continued_fraction(b, a, 1.0 - x) / b
    };
    (cdf.clamp(0.0, 1.0), power)
}

/// Evaluates `1/(1 + d₁/(1 + d₂/(1 + …)))` of DLMF 8.17.22 forwards, as products of ratios of
/// successive convergents (the modified algorithm of Lentz).
fn continued_fraction(a: f64, b: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    const TERMS: u32 = 5000;
    let away_from_zero = |v: f64| if v.abs() < TINY { TINY } else { v };
    let (mut value, mut numerator, mut denominator) = (1.0, f64::INFINITY, 1.0);
    for term in 1..TERMS {
        let m = f64::from(term / 2);
        let d = if term % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        denominator = 1.0 / away_from_zero(1.0 + d * denominator);
        numerator = away_from_zero(1.0 + d / numerator);
        let ratio = numerator * denominator;
        value *= ratio;
        if (ratio - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class_score::mean;
    use proptest::prelude::*;

    #[test]
    fn closed_forms_of_the_incomplete_beta_function_are_met() {
        for x in [0.01, 0.2, 0.5, 0.77, 0.99] {
            assert!((beta_cdf(1.0, 1.0, x).0 - x).abs() < 1e-14);
            assert!((beta_cdf(2.0, 1.0, x).0 - x * x).abs() < 1e-14);
            assert!(
                (beta_cdf(1.0, 3.0, x).0 - (1.0 - (1.0 - x) * (1.0 - x) * (1.0 - x))).abs() < 1e-14
            );
            let arcsine = 2.0 / std::f64::consts::PI * libm::asin(x.sqrt());
            assert!((beta_cdf(0.5, 0.5, x).0 - arcsine).abs() < 1e-13, "{x}");
        }
    }

    #[test]
    fn a_flat_beta_is_even_but_for_half_bins_at_the_ends() {
        let p = beta_posterior(1.0, 1.0, 11);
        assert!((p[0] - 0.05).abs() < 1e-12 && (p[10] - 0.05).abs() < 1e-12);
        assert!(p[1..10].iter().all(|p| (p - 0.1).abs() < 1e-12));
    }

    proptest! {
        #[test]
        fn bins_keep_the_sum_and_the_mean(
            a in prop_oneof![1e-3..2.0f64, 1.0..1e3f64, 1e3..1e6f64],
            b in prop_oneof![1e-3..2.0f64, 1.0..1e3f64, 1e3..1e6f64],
            bins in 2..=64usize,
        ) {
            let p = beta_posterior(a, b, bins);
            prop_assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            prop_assert!(p.iter().all(|p| *p >= 0.0));
            prop_assert!((mean(&p) - a / (a + b)).abs() < 1e-6, "{} {}", mean(&p), a / (a + b));
        }
    }
}
