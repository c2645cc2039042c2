//! The exact gain of one cell by one outcome: for the cells in which an echo may have ended, and
//! for all cells where polynomials do not suffice.

use crate::belief::Prior;
use crate::evidence::{FEW, few, gains, w};
use crate::numbers::{as_f64, to_f32};
use covmap::lanes::{LANES, Lanes, add_product, fused, map};
use covmap_model::{CauseParameters, gaussian};

/// Possible evidence of an outcome about a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kernel<'a> {
    /// N(μ, σ) of every bin.
    pub(super) ended: &'a [f32],
    /// Weight of c_m for it.
    pub(super) weight: f32,
    /// f(d^l, θ), or 0 where the cell was not passed.
    pub(super) free: f32,
    /// A bit for every bin in which e may be above [`FEW`].
    pub(super) large: u64,
}

/// The gain of a cell by the shares s of its kernel and g of "passed".
#[derive(Debug, Clone)]
pub(super) struct AtEnd {
    bins: usize,
    /// The largest c_m and L.
    most: (f64, f64),
    /// N(0, σ_free) of every bin.
    free: Vec<f32>,
    /// N(1, σ_behind) of every bin.
    behind: Vec<f32>,
}

impl AtEnd {
    /// Creates the evaluation for the largest c_m and L.
    pub(super) fn new(parameters: &CauseParameters, bins: usize, most: (f64, f64)) -> Self {
        let mut at_end = Self { bins, most, free: Vec::new(), behind: Vec::new() };
        at_end.free = at_end.kernel(0.0, parameters.free.sigma);
        at_end.behind = at_end.kernel(1.0, parameters.sigma_behind);
        at_end
    }

    /// Returns N(μ, σ) of every bin.
    pub(super) fn kernel(&self, mu: f64, sigma: f64) -> Vec<f32> {
        let mut kernel = vec![0.0; self.bins];
        gaussian(mu, sigma, &mut kernel);
        kernel.into_iter().map(to_f32).collect()
    }

    /// Returns the evidence of an echo about a cell behind its end, with b.
    pub(super) fn behind(&self, weight: f32) -> Kernel<'_> {
        Kernel { ended: &self.behind, weight, free: 0.0, large: u64::MAX }
    }

    /// Returns the evidence of an outcome about a cell that was passed, with f.
    pub(super) fn passed(&self, free: f32) -> Kernel<'_> {
        Kernel { ended: &self.behind, weight: 0.0, free, large: u64::MAX }
    }

    /// Returns the bins in which e may be above [`FEW`], with shares as large as they may be.
    pub(super) fn large(&self, ended: &[f32], free: f32) -> u64 {
        let (s, g) = (self.most.0, f64::from(free) * self.most.1);
        let rest = 1.0 - s - g;
        let e = |ended: f32, free: f32| {
            as_f64(self.bins) * (s * f64::from(ended) + g * f64::from(free)) / rest
        };
        let is_large =
            |(ended, free): (&f32, &f32)| rest <= 0.0 || e(*ended, *free) > 0.99 * f64::from(FEW);
        let bins = ended.iter().zip(&self.free).map(is_large).enumerate();
        bins.fold(0, |bits, (bin, large)| bits | u64::from(large) << bin)
    }

    /// Returns the gain of a cell from each view-point of a group, by c_m of its bearing and L:
    /// s = weight·c_m and g = f·(L − c_m). In the terms of [`crate::evidence`], with
    /// t_min = (1 − s − g)/n,
    ///
    /// ```text
    /// e = n·(s·N(μ, σ) + g·N(0, σ_free)) / (1 − s − g)
    /// ```
    #[inline(always)]
    pub(super) fn gain(
        &self,
        prior: &Prior<'_>,
        kernel: Kernel<'_>,
        ended: &Lanes,
        any: &Lanes,
    ) -> Lanes {
        let bins = to_f32(as_f64(self.bins));
        let (mut by_end, mut by_free) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let passed = kernel.free * (any[lane] - ended[lane]);
            let ended = kernel.weight * ended[lane];
            let each = bins / (1.0 - ended - passed);
            (by_end[lane], by_free[lane]) = (ended * each, passed * each);
        }
        let (mut above, mut terms) = ([0.0; LANES], [0.0; LANES]);
        for (bin, (ended, free)) in kernel.ended.iter().zip(&self.free).enumerate() {
            let (h, h_hat) = (prior.h(bin), prior.h_hat(bin));
            // Loops of one result each become vector instructions.
            let mut here = [0.0; LANES];
            for lane in 0..LANES {
                here[lane] = fused(by_end[lane], *ended, by_free[lane] * free);
            }
            add_product(&mut above, h, &here);
            add_product(&mut terms, h_hat, &here);
            let of_bin = if kernel.large >> bin & 1 == 1 { w(&here) } else { map(&here, few) };
            add_product(&mut terms, h, &of_bin);
        }
        gains(&terms, &above)
    }
}
