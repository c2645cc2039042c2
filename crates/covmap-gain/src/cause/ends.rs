//! What is gained in a cell in which an echo may have ended.

use super::beam::Kernel;
use crate::belief::Prior;
use crate::numbers::{as_f64, to_f32};
use covmap::lanes::{LANES, Lanes, TOGETHER, flat, ln, map};
use covmap_model::{CauseParameters, gaussian};

/// The gain of a cell by the shares s of its kernel and g of "passed".
#[derive(Debug, Clone)]
pub(super) struct AtEnd {
    bins: usize,
    /// N(0, σ_free) of every bin.
    free: Vec<f32>,
}

impl AtEnd {
    pub(super) fn new(parameters: &CauseParameters, bins: usize) -> Self {
        let mut free = vec![0.0; bins];
        gaussian(0.0, parameters.free.sigma, &mut free);
        Self { bins, free: free.into_iter().map(to_f32).collect() }
    }

    /// Adds the gain of a cell from each view-point of a group, by c_m and L: s = c_m and
    /// g = f·(L − c_m). In the terms of [`crate::evidence`], with t_min = (1 − s − g)/n,
    ///
    /// ```text
    /// e = n·(s·N(μ, σ) + g·N(0, σ_free)) / (1 − s − g)
    /// ```
    #[inline(always)]
    pub(super) fn add(
        &self,
        sum: &mut Lanes,
        prior: &Prior<'_>,
        kernel: &Kernel,
        ended: &Lanes,
        any: &Lanes,
    ) {
        let bins = to_f32(as_f64(self.bins));
        let (mut by_end, mut by_free) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let passed = kernel.free * (any[lane] - ended[lane]);
            let each = bins / (1.0 - ended[lane] - passed);
            (by_end[lane], by_free[lane]) = (ended[lane] * each, passed * each);
        }
        let (mut above, mut terms) = ([0.0; LANES], [0.0; LANES]);
        for first in (0..self.bins).step_by(TOGETHER) {
            let mut t = [[1.0; LANES]; TOGETHER];
            let weights = kernel.ended[first..].iter().zip(&self.free[first..]);
            for ((bin, t), (ended, free)) in (first..).zip(&mut t).zip(weights) {
                let (h, h_hat) = (prior.h(bin), prior.h_hat(bin));
                for lane in 0..LANES {
                    let e = by_end[lane] * ended + by_free[lane] * free;
                    above[lane] += h[lane] * e;
                    terms[lane] += h_hat[lane] * e;
                    t[lane] = 1.0 + e;
                }
            }
            let logs = ln(&flat(&t));
            let logs = logs.as_chunks::<LANES>().0;
            for ((bin, t), log) in (first..self.bins).zip(&t).zip(logs) {
                let h = prior.h(bin);
                for lane in 0..LANES {
                    terms[lane] += h[lane] * (t[lane] * log[lane] - (t[lane] - 1.0));
                }
            }
        }
        let z = map(&above, |above| 1.0 + above);
        let log_z = ln(&z);
        for lane in 0..LANES {
            sum[lane] += (terms[lane] + (z[lane] - 1.0)) / z[lane] - log_z[lane];
        }
    }
}
