//! What is gained in one cell by one outcome, as it is: in the cells in which an echo may have ended,
//! and in all where polynomials would not do.

use crate::belief::Prior;
use crate::evidence::{gains, w};
use crate::numbers::{as_f64, to_f32};
use covmap::lanes::{LANES, Lanes, TOGETHER, flat};
use covmap_model::{CauseParameters, gaussian};

/// What an outcome may say of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kernel<'a> {
    /// N(μ, σ) of every bin.
    pub(super) ended: &'a [f32],
    /// How much of c_m counts for it.
    pub(super) weight: f32,
    /// f(d^l, θ), or 0 where the cell was not passed.
    pub(super) free: f32,
}

/// The gain of a cell by the shares s of its kernel and g of "passed".
#[derive(Debug, Clone)]
pub(super) struct AtEnd {
    bins: usize,
    /// N(0, σ_free) of every bin.
    free: Vec<f32>,
    /// N(1, σ_behind) of every bin.
    pub(super) behind: Vec<f32>,
}

impl AtEnd {
    pub(super) fn new(parameters: &CauseParameters, bins: usize) -> Self {
        let kernel = |mu, sigma| {
            let mut kernel = vec![0.0; bins];
            gaussian(mu, sigma, &mut kernel);
            kernel.into_iter().map(to_f32).collect()
        };
        let free = kernel(0.0, parameters.free.sigma);
        Self { bins, free, behind: kernel(1.0, parameters.sigma_behind) }
    }

    /// Adds the gain of a cell from each view-point of a group, by what c_m of its bearing counts
    /// and L: s = weight·c_m and g = f·(L − c_m). In the terms of [`crate::evidence`], with t_min = (1 − s − g)/n,
    ///
    /// ```text
    /// e = n·(s·N(μ, σ) + g·N(0, σ_free)) / (1 − s − g)
    /// ```
    #[inline(always)]
    pub(super) fn add(
        &self,
        sum: &mut Lanes,
        prior: &Prior<'_>,
        kernel: Kernel<'_>,
        ended: &Lanes,
        any: &Lanes,
    ) {
        let bins = to_f32(as_f64(self.bins));
        let (mut by_end, mut by_free) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let passed = kernel.free * (any[lane] - ended[lane]);
            let ended = kernel.weight * ended[lane];
            let each = bins / (1.0 - ended - passed);
            (by_end[lane], by_free[lane]) = (ended * each, passed * each);
        }
        let (mut above, mut terms) = ([0.0; LANES], [0.0; LANES]);
        for first in (0..self.bins).step_by(TOGETHER) {
            let mut excess = [[0.0; LANES]; TOGETHER];
            let weights = kernel.ended[first..].iter().zip(&self.free[first..]);
            for ((bin, e), (ended, free)) in (first..).zip(&mut excess).zip(weights) {
                let (h, h_hat) = (prior.h(bin), prior.h_hat(bin));
                // Loops of one result each become vector instructions.
                let mut here = [0.0; LANES];
                for lane in 0..LANES {
                    here[lane] = by_end[lane] * ended + by_free[lane] * free;
                }
                add_product(&mut above, h, &here);
                add_product(&mut terms, h_hat, &here);
                *e = here;
            }
            let all = w(&flat(&excess));
            for (bin, w) in (first..self.bins).zip(all.as_chunks::<LANES>().0) {
                let h = prior.h(bin);
                add_product(&mut terms, h, w);
            }
        }
        let gain = gains(&terms, &above);
        for lane in 0..LANES {
            sum[lane] += gain[lane];
        }
    }
}

/// Adds products, lane by lane.
#[inline(always)]
fn add_product(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * b[lane];
    }
}
