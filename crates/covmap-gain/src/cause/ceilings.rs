//! Upper bounds of the gain of a cell, with which a decision need not evaluate all gains.
//!
//! For every cell the evaluation keeps pairs of numbers: by the share s of "ended" the largest gain
//! U, and the largest slope U', for each of [`BANDS`] of the width σ of the kernel of an echo; the
//! same by the share g of "passed", V and V'; and by that of "behind", W and W'. They satisfy
//!
//! ```text
//! G(g) ≤ min(V, V'·g)     I(s, g) ≤ min(U, U'·s) + min(V, V'·g)     B(s) ≤ min(W, W'·s)
//! ```
//!
//! They are the largest gains, and the largest ratios of gain and share, of some kernels at some
//! shares. That is probed and not proved: [`crate::GainCache::take_exceeded`] tells of gains above
//! their bounds, and a decision that meets one evaluates all of its candidates.

use super::fronts::FrontSums;
use crate::belief::{Belief, lanes_at, padded};
use crate::evidence::{BinEvidence, BlockGains, ExcessEvidence};
use crate::memory::Size;
use crate::numbers::PAD;
use crate::numbers::{as_f64, to_f32};
use crate::view_points::groups_per_row;
use covmap::Grid;
use covmap::lanes::{LANES, Lanes, add_product, add_scaled};
use pulp::Arch;
use rayon::prelude::*;

/// Factor by which gains at other shares and of other kernels may exceed those that are probed.
const MARGIN: f32 = 1.2;

/// The number of bands of the widths of kernels at the end.
pub(super) const BANDS: usize = 3;

/// The widths σ at which the bands begin and end.
#[derive(Debug, Clone)]
pub(super) struct Bands {
    least: f64,
    most: f64,
}

impl Bands {
    /// Creates the bands of the `least` to the `most` σ.
    pub(super) fn new(least: f64, most: f64) -> Self {
        Self { least, most }
    }

    /// Returns the beginning of a band; the last one ends where the next would begin.
    fn begin(&self, band: usize) -> f64 {
        self.least + (self.most - self.least) * as_f64(band) / as_f64(BANDS)
    }

    /// Returns the band of a width.
    pub(super) fn of(&self, sigma: f64) -> usize {
        (1..BANDS).filter(|band| self.begin(*band) <= sigma).count()
    }

    /// Returns μ and σ of kernels that stand for all of a band.
    pub(super) fn kernels(&self, band: usize) -> Vec<(f64, f64)> {
        let mu = |i: u32| 0.1 * f64::from(i);
        let sigmas = [self.begin(band), self.begin(band + 1)];
        sigmas.into_iter().flat_map(|sigma| (0..=10).map(move |i| (mu(i), sigma))).collect()
    }
}

/// The pairs: by band of "ended", and of "passed" and "behind".
const PASSED: usize = BANDS;
const BEHIND: usize = BANDS + 1;
const PAIRS: usize = BANDS + 2;

/// The parts of the largest share that are probed.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

/// The readings that are probed, and 1/share of each.
#[derive(Debug, Clone)]
struct Looked {
    by_share: Vec<f32>,
    readings: Vec<ExcessEvidence>,
}

/// The pairs of all cells.
#[derive(Debug, Clone)]
pub(super) struct Ceilings {
    grid: Grid,
    /// By pair.
    looked: [Looked; PAIRS],
    /// By row, pair, number of the pair, and column, padded as histograms are.
    largest: Vec<f32>,
}

impl Ceilings {
    /// Creates the ceilings by the largest share, and μ and σ of the kernels, of each pair.
    /// `evidence` makes the evidence of a kernel with a share.
    pub(super) fn new(
        grid: Grid,
        pairs: [(f64, Vec<(f64, f64)>); PAIRS],
        evidence: impl Fn((f64, f64), f64) -> BinEvidence,
    ) -> Self {
        let looked = pairs.map(|(most, kernels)| {
            let shares = PARTS.iter().map(|part| part * most.max(1e-9));
            let all = shares.flat_map(|share| kernels.iter().map(move |kernel| (share, *kernel)));
            let of_kernel =
                |(share, kernel)| (to_f32(1.0 / share), evidence(kernel, share).excess());
            let (by_share, readings) = all.map(of_kernel).unzip();
            Looked { by_share, readings }
        });
        let largest = vec![0.0; grid.height() * 2 * PAIRS * padded(grid.width())];
        Self { grid, looked, largest }
    }

    /// Estimates the bytes of the ceilings.
    pub(super) fn bytes(size: &Size) -> f64 {
        4.0 * as_f64(2 * PAIRS) * size.padded()
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(super) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        let (per_row, stride) = (groups_per_row(&self.grid), padded(self.grid.width()));
        let width = self.grid.width();
        let Self { looked, largest, .. } = self;
        let place = |block: usize| changed.partition_point(|changed| *changed < block);
        let rows = largest.par_chunks_mut(2 * PAIRS * stride).enumerate().with_min_len(8);
        let most = looked.iter().map(|looked| looked.readings.len()).max().unwrap_or(0);
        rows.for_each(|(y, row)| {
            let mut gains = vec![[0.0; LANES]; most];
            for block in &changed[place(y * per_row)..place((y + 1) * per_row)] {
                let x = block % per_row * LANES;
                for (i, Looked { by_share, readings }) in looked.iter().enumerate() {
                    let (prior, gains) = (belief.prior(*block), &mut gains[..readings.len()]);
                    arch.dispatch(BlockGains { readings, prior, gains });
                    let mut largest = [[0.0f32; LANES]; 2];
                    for (gain, by_share) in gains.iter().zip(by_share) {
                        for lane in 0..LANES {
                            largest[0][lane] = largest[0][lane].max(gain[lane]);
                            largest[1][lane] = largest[1][lane].max(by_share * gain[lane]);
                        }
                    }
                    let cells = LANES.min(width - x);
                    for (number, largest) in (2 * i..).zip(&largest) {
                        let out = &mut row[number * stride + PAD + x..][..cells];
                        out.copy_from_slice(&largest[..cells]);
                        out.iter_mut().for_each(|out| *out *= MARGIN);
                    }
                }
            }
        });
    }

    /// Returns the bound of a cell in which an echo may have ended, by c_m, L, and f where the cell
    /// was passed.
    #[inline(always)]
    pub(super) fn of_end(
        &self,
        place: (usize, isize),
        (ended, any): (&Lanes, &Lanes),
        (band, free): (usize, f32),
    ) -> Lanes {
        let mut bound = self.bound(place, band, (&ONCE, ended));
        if free > 0.0 {
            let mut passed = [0.0; LANES];
            for lane in 0..LANES {
                passed[lane] = (any[lane] - ended[lane]) * free;
            }
            add_scaled(&mut bound, &self.bound(place, PASSED, (&ONCE, &passed)), 1.0);
        }
        bound
    }

    /// Returns the bound of a cell behind the end, by its share.
    #[inline(always)]
    pub(super) fn of_behind(&self, place: (usize, isize), ended: &Lanes, weight: f32) -> Lanes {
        let mut shares = [0.0; LANES];
        add_scaled(&mut shares, ended, weight);
        self.bound(place, BEHIND, (&ONCE, &shares))
    }

    /// Creates sums to which nothing is added yet.
    #[inline(always)]
    pub(super) fn no_sums(&self) -> CeilingSums<'_> {
        CeilingSums { ceilings: self, all: [0.0; LANES], passed: [0.0; LANES] }
    }

    /// Returns the smaller of the largest gain and of slope times share, of a pair of numbers. The
    /// outcomes' sums of p and of p·share are `all` and `shares`.
    #[inline(always)]
    fn bound(&self, (y, x): (usize, isize), pair: usize, (all, shares): (&Lanes, &Lanes)) -> Lanes {
        let stride = padded(self.grid.width());
        let first = (y * PAIRS + pair) * 2 * stride + PAD.wrapping_add_signed(x);
        let most = lanes_at(&self.largest, first);
        let slope = lanes_at(&self.largest, first + stride);
        let mut bound = [0.0; LANES];
        for lane in 0..LANES {
            let (most, by_share) = (most[lane] * all[lane], slope[lane] * shares[lane]);
            bound[lane] = if by_share < most { by_share } else { most };
        }
        bound
    }
}

/// Probability of one outcome that is sure.
const ONCE: Lanes = [1.0; LANES];

/// The sums of p_k and of p_k·L(k).
pub(super) struct CeilingSums<'a> {
    ceilings: &'a Ceilings,
    all: Lanes,
    passed: Lanes,
}

impl FrontSums for CeilingSums<'_> {
    #[inline(always)]
    fn add(&mut self, probability: &Lanes, any: &Lanes) {
        add_scaled(&mut self.all, probability, 1.0);
        add_product(&mut self.passed, probability, any);
    }

    #[inline(always)]
    fn of_cell(&self, place: (usize, isize), free: f32) -> Lanes {
        let mut passed = [0.0; LANES];
        add_scaled(&mut passed, &self.passed, free);
        self.ceilings.bound(place, PASSED, (&self.all, &passed))
    }
}
