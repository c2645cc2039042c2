//! p(c | d) of one imagined reading of cells at one distance, and their gain by it, Eq. (13).
//!
//! With the histogram h, its entropy H, and the evidence t = t_min·(1 + e), where e ≥ 0 is the
//! relative excess of the evidence of a bin over the least one, Eq. (13) is
//!
//! ```text
//! I = (Σ ĥ·e + Σ h·w(e) − w(E)) / (1 + E),   E = Σ h·e
//! ĥ = h·(log h + H),   w(e) = (1 + e)·log(1 + e) − e
//! ```
//!
//! This form normalises no product and needs one logarithm, and nothing large cancels: weak
//! evidence (small e) has small terms only. Without ĥ it is the relative entropy of the histogram
//! after the reading to that before it.

use crate::belief::BlockPrior;
use crate::numbers::to_f32;
use covmap::lanes::{LANES, Lanes, add_scaled, fused, ln, map};
use covmap_model::{Outcome, SensorModel};
use pulp::{Simd, WithSimd};

/// p(c | d) of one cell, in f64, from which tables are made.
#[derive(Debug, Clone)]
pub(crate) struct BinEvidence {
    /// t = p(c | d).
    t: Vec<f64>,
    /// v = t·log t.
    v: Vec<f64>,
}

/// The evidence in the form for many cells side by side: the bins with e above 0, from `first` on.
/// They are few, because a Gaussian is nothing far from its mean.
#[derive(Debug, Clone)]
pub(crate) struct ExcessEvidence {
    first: usize,
    /// e and w.
    terms: Vec<(f32, f32)>,
}

impl BinEvidence {
    pub(crate) fn new(model: &SensorModel, cell_distance: f64, outcome: Outcome) -> Self {
        let mut t = vec![0.0; model.parameters().bins];
        model.evidence(cell_distance, outcome, &mut t);
        Self::of(t)
    }

    /// Creates the evidence of these weights at the bins.
    pub(crate) fn of(t: Vec<f64>) -> Self {
        let v = t.iter().map(|t| t * libm::log(*t)).collect();
        Self { t, v }
    }

    pub(crate) fn bins(&self) -> usize {
        self.t.len()
    }

    /// Returns the entropy of a histogram after the reading \[nats\], by h and h·log h of every
    /// bin.
    pub(crate) fn entropy_after(&self, h: &[f64], u: &[f64]) -> f64 {
        let (mut z, mut s) = (0.0, 0.0);
        for ((h, u), (t, v)) in h.iter().zip(u).zip(self.t.iter().zip(&self.v)) {
            z += h * t;
            s += u * t + h * v;
        }
        libm::log(z) - s / z
    }

    /// Returns the relative entropy of a histogram after the reading to that before it \[nats\].
    pub(crate) fn relative_entropy(&self, h: &[f64]) -> f64 {
        let z: f64 = h.iter().zip(&self.t).map(|(h, t)| h * t).sum();
        h.iter().zip(&self.v).map(|(h, v)| h * v).sum::<f64>() / z - libm::log(z)
    }

    pub(crate) fn excess(&self) -> ExcessEvidence {
        let least = self.t.iter().copied().fold(f64::INFINITY, f64::min);
        let above: Vec<f64> = self.t.iter().map(|t| t / least - 1.0).collect();
        let first = above.iter().position(|e| *e > 0.0).unwrap_or(0);
        let end = above.iter().rposition(|e| *e > 0.0).map_or(first, |last| last + 1);
        let term = |e: &f64| (to_f32(*e), to_f32((1.0 + e) * libm::log1p(*e) - e));
        ExcessEvidence { first, terms: above[first..end].iter().map(term).collect() }
    }
}

impl ExcessEvidence {
    /// Returns the information gain in every cell of a block, Eq. (13) \[nats\]: 0 where nothing
    /// can change.
    #[inline(always)]
    pub(crate) fn gain(&self, prior: &BlockPrior<'_>) -> Lanes {
        let (mut above, mut sum) = ([0.0f32; LANES], [0.0f32; LANES]);
        for (bin, (e, w)) in (self.first..).zip(&self.terms) {
            let (h, h_hat) = (prior.h(bin), prior.h_hat(bin));
            add_scaled(&mut above, h, *e);
            add_scaled(&mut sum, h_hat, *e);
            add_scaled(&mut sum, h, *w);
        }
        let mut gain = gains(&sum, &above);
        for (gain, changeable) in gain.iter_mut().zip(prior.changeable) {
            *gain *= changeable;
        }
        gain
    }
}

/// The gains of a block of cells by each of some readings, compiled for each kind of vector
/// registers.
pub(crate) struct BlockGains<'a> {
    pub(crate) readings: &'a [ExcessEvidence],
    pub(crate) prior: BlockPrior<'a>,
    pub(crate) gains: &'a mut [Lanes],
}

impl WithSimd for BlockGains<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (gain, reading) in self.gains.iter_mut().zip(self.readings) {
            *gain = reading.gain(&self.prior);
        }
    }
}

/// Returns I of cells, by Σ ĥ·e + Σ h·w(e) and E of each.
#[inline(always)]
pub(crate) fn gains(sum: &Lanes, above: &Lanes) -> Lanes {
    let of_all = w(above);
    let mut gain = [0.0; LANES];
    for lane in 0..LANES {
        gain[lane] = (sum[lane] - of_all[lane]) / (1.0 + above[lane]);
    }
    gain
}

/// Returns w(e) of numbers that are not negative, each to within 1e-6 of itself: by its series
/// where the logarithm would cancel.
#[inline(always)]
pub(crate) fn w<const N: usize>(e: &[f32; N]) -> [f32; N] {
    let z = map(e, |e| 1.0 + e);
    let log = ln(&z);
    let mut out = [0.0; N];
    for i in 0..N {
        let e = e[i];
        let far = fused(z[i], log[i], 1.0 - z[i]);
        out[i] = if e < FEW { few(e) } else { far };
    }
    out
}

/// Largest e for which the series of w is exact enough.
pub(crate) const FEW: f32 = 0.2;

/// Returns w(e) by its series, for e up to [`FEW`].
#[inline(always)]
pub(crate) fn few(e: f32) -> f32 {
    let terms = [1.0 / 42.0, -1.0 / 30.0, 1.0 / 20.0, -1.0 / 12.0, 1.0 / 6.0, -0.5];
    let sum = terms.into_iter().fold(-1.0 / 56.0, |sum, term| fused(sum, e, term));
    -e * e * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn w_keeps_its_bound(e in prop_oneof![0.0..1.0f64, 0.0..1e-3f64, 0.19..0.21f64, 0.0..1e3f64]) {
            let e = f64::from(to_f32(e));
            let exact = (1.0 + e) * libm::log1p(e) - e;
            let found = f64::from(w(&[to_f32(e)])[0]);
            // In f64 the exact one cancels as well.
            let tolerance = 3e-6 * exact + 1e-15;
            prop_assert!((found - exact).abs() <= tolerance, "{e}: {found} {exact}");
        }
    }
}
