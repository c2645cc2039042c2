//! One imagined reading of cells at one distance, and what it leaves of their entropies.
//!
//! With u = h·log h of the stored histogram and v = t·log t of the evidence, the entropy of
//! the normalised product h·t/Z is
//!
//! ```text
//! H' = log Z − (Σ u·t + Σ h·v)/Z,   Z = Σ h·t
//! ```
//!
//! so that no product is normalised, and one logarithm is enough.

use super::lanes::{LANES, Lanes, ln};
use crate::cells::Block;
use covmap::MAX_BINS;
use covmap_model::{Outcome, SensorModel};

/// p(c | d) of Eq. (9) for cells at one distance.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    /// t = p(c | d).
    t: Vec<f64>,
    /// v = t·log t.
    v: Vec<f64>,
}

/// The same for many cells side by side. Far from its mean a Gaussian is nothing: the
/// evidence of all bins from `head` on is the same.
#[derive(Debug, Clone)]
pub(crate) struct Reading {
    /// t and v of the first bins.
    head: Vec<(f32, f32)>,
    /// t and v of each of the others.
    tail: (f32, f32),
}

impl Evidence {
    pub(crate) fn new(model: &SensorModel, cell_distance: f64, outcome: Outcome) -> Self {
        let mut t = vec![0.0; model.parameters().bins];
        model.evidence(cell_distance, outcome, &mut t);
        let v = t.iter().map(|t| t * libm::log(*t)).collect();
        Self { t, v }
    }

    /// The entropy of a histogram after the reading \[nats\].
    pub(crate) fn entropy_after(&self, h: &[f64], u: &[f64]) -> f64 {
        let (mut z, mut s) = (0.0, 0.0);
        for ((h, u), (t, v)) in h.iter().zip(u).zip(self.t.iter().zip(&self.v)) {
            z += h * t;
            s += u * t + h * v;
        }
        libm::log(z) - s / z
    }

    #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for speed")]
    pub(crate) fn reading(&self) -> Reading {
        let rows: Vec<(f32, f32)> =
            self.t.iter().zip(&self.v).map(|(t, v)| (*t as f32, *v as f32)).collect();
        let tail = rows.last().copied().unwrap_or((1.0, 0.0));
        let same = rows.iter().rev().take_while(|row| **row == tail).count();
        Reading { head: rows[..rows.len() - same].to_vec(), tail }
    }
}

/// The histograms of a block of cells, with the sums over all bins from each one on.
pub(crate) struct Prior<'a> {
    block: &'a Block,
    h: &'a [Lanes],
    u: &'a [Lanes],
    sums: &'a PriorSums,
}

/// Σ h and Σ u from each bin on.
pub(crate) struct PriorSums {
    h: [Lanes; MAX_BINS + 1],
    u: [Lanes; MAX_BINS + 1],
}

impl Default for PriorSums {
    fn default() -> Self {
        Self { h: [[0.0; LANES]; MAX_BINS + 1], u: [[0.0; LANES]; MAX_BINS + 1] }
    }
}

impl<'a> Prior<'a> {
    #[inline(always)]
    pub(crate) fn new(
        (block, h, u): (&'a Block, &'a [Lanes], &'a [Lanes]),
        sums: &'a mut PriorSums,
    ) -> Self {
        sum_up(h, &mut sums.h);
        sum_up(u, &mut sums.u);
        Self { block, h, u, sums }
    }

    /// The information gain of a reading in every cell, Eq. (13) \[nats\]: 0 where nothing can
    /// change.
    #[inline(always)]
    pub(crate) fn gain(&self, reading: &Reading) -> Lanes {
        let (rest_h, rest_u) = (&self.sums.h[reading.head.len()], &self.sums.u[reading.head.len()]);
        let (t, v) = reading.tail;
        let (mut z, mut s) = ([0.0f32; LANES], [0.0f32; LANES]);
        for lane in 0..LANES {
            z[lane] = rest_h[lane] * t;
            s[lane] = rest_u[lane] * t + rest_h[lane] * v;
        }
        for ((h, u), (t, v)) in self.h.iter().zip(self.u).zip(&reading.head) {
            for lane in 0..LANES {
                z[lane] += h[lane] * t;
                s[lane] += u[lane] * t + h[lane] * v;
            }
        }
        let (log_z, mut gain) = (ln(&z), [0.0; LANES]);
        let Block { entropy, changeable } = self.block;
        for lane in 0..LANES {
            gain[lane] = changeable[lane] * (entropy[lane] - (log_z[lane] - s[lane] / z[lane]));
        }
        gain
    }
}

#[inline(always)]
fn sum_up(values: &[Lanes], sums: &mut [Lanes; MAX_BINS + 1]) {
    let mut sum = [0.0; LANES];
    sums[values.len()] = sum;
    for (values, to) in values.iter().zip(&mut sums[..values.len()]).rev() {
        for lane in 0..LANES {
            sum[lane] += values[lane];
        }
        *to = sum;
    }
}
