//! p(c | d) of one imagined reading of cells at one distance, and what they gain by it, Eq. (13).
//!
//! With the histogram h, its entropy H, and the evidence t = t_min·(1 + e), so that e ≥ 0 is by how
//! much the evidence of a bin exceeds the least one, Eq. (13) is
//!
//! ```text
//! I = (Σ ĥ·e + Σ h·w)/(1 + E) + E/(1 + E) − log(1 + E),   E = Σ h·e
//! ĥ = h·(log h + H),   w = (1 + e)·log(1 + e) − e
//! ```
//!
//! so that no product is normalised, one logarithm is enough, and nothing large cancels: weak
//! evidence (small e) has small terms only.

use crate::belief::BlockPrior;
use crate::numbers::to_f32;
use covmap::lanes::{LANES, Lanes, ln};
use covmap_model::{Outcome, SensorModel};

/// p(c | d) of one cell, in f64: what tables are made from.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    /// t = p(c | d).
    t: Vec<f64>,
    /// v = t·log t.
    v: Vec<f64>,
}

/// The same as it is evaluated for many cells side by side: the bins for which e is above 0, from
/// `first` on. Far from its mean a Gaussian is nothing, so that these are few.
#[derive(Debug, Clone)]
pub(crate) struct ExcessEvidence {
    first: usize,
    /// e and w.
    terms: Vec<(f32, f32)>,
}

impl Evidence {
    pub(crate) fn new(model: &SensorModel, cell_distance: f64, outcome: Outcome) -> Self {
        let mut t = vec![0.0; model.parameters().bins];
        model.evidence(cell_distance, outcome, &mut t);
        Self::of(t)
    }

    /// The evidence whose weights at the bins these are.
    pub(crate) fn of(t: Vec<f64>) -> Self {
        let v = t.iter().map(|t| t * libm::log(*t)).collect();
        Self { t, v }
    }

    pub(crate) fn bins(&self) -> usize {
        self.t.len()
    }

    /// The entropy of a histogram after the reading \[nats\], by h and h·log h of every bin.
    pub(crate) fn entropy_after(&self, h: &[f64], u: &[f64]) -> f64 {
        let (mut z, mut s) = (0.0, 0.0);
        for ((h, u), (t, v)) in h.iter().zip(u).zip(self.t.iter().zip(&self.v)) {
            z += h * t;
            s += u * t + h * v;
        }
        libm::log(z) - s / z
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
    /// The information gain in every cell of a block, Eq. (13) \[nats\]: 0 where nothing can change.
    #[inline(always)]
    pub(crate) fn gain(&self, prior: &BlockPrior<'_>) -> Lanes {
        let (mut above, mut sum) = ([0.0f32; LANES], [0.0f32; LANES]);
        for (bin, (e, w)) in (self.first..).zip(&self.terms) {
            let (h, h_hat) = (prior.h(bin), prior.h_hat(bin));
            for lane in 0..LANES {
                above[lane] += h[lane] * e;
                sum[lane] += h_hat[lane] * e + h[lane] * w;
            }
        }
        let (mut z, mut gain) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            z[lane] = 1.0 + above[lane];
        }
        let log_z = ln(&z);
        for lane in 0..LANES {
            // E as it is in the logarithm, after rounding.
            let above = z[lane] - 1.0;
            gain[lane] = prior.changeable[lane] * ((sum[lane] + above) / z[lane] - log_z[lane]);
        }
        gain
    }
}
