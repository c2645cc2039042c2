//! Upper bounds of what is gained in a cell in which an echo may have ended: what a decision need not
//! evaluate.
//!
//! For every cell four numbers are kept: by the share s of "ended" the largest gain U, and the
//! largest slope U', and the same, V and V', by the share g of "passed", such that
//!
//! ```text
//! I(s, g) ≤ MARGIN · (min(U, U'·s) + min(V, V'·g))
//! ```
//!
//! They are the largest gains, and parts of gain by share, of some kernels at some shares. That is
//! probed and not proved: [`crate::GainCache::take_exceeded`] tells of gains that were met above
//! their bounds, and a decision that meets one evaluates all of its candidates.

use crate::belief::{Belief, PAD, lanes_at, padded};
use crate::evidence::{Evidence, ExcessEvidence};
use crate::memory::Size;
use crate::numbers::{as_f64, to_f32};
use crate::view_points::groups_per_row;
use covmap::Grid;
use covmap::lanes::{LANES, Lanes};
use pulp::Arch;
use rayon::prelude::*;

/// Gains at other shares and of other kernels may exceed those that are looked at by this.
const MARGIN: f32 = 1.2;

/// U, U', V and V'.
const NUMBERS: usize = 4;

/// The parts of the largest share that are looked at.
const PARTS: [f64; 4] = [1.0, 0.5, 0.2, 0.05];

/// U, U', V and V' of all cells.
#[derive(Debug, Clone)]
pub(super) struct Ceilings {
    grid: Grid,
    /// 1/s and 1/g, with the readings.
    ended: Vec<(f32, ExcessEvidence)>,
    passed: Vec<(f32, ExcessEvidence)>,
    /// By row, which of the four, and column, padded as histograms are.
    largest: Vec<f32>,
}

impl Ceilings {
    /// `ended` says what a kernel of some number below `kernels` says with a share, `passed` what
    /// "passed" says with a share.
    pub(super) fn new(
        grid: Grid,
        (most_ended, most_passed): (f64, f64),
        kernels: usize,
        ended: impl Fn(usize, f64) -> Evidence,
        passed: impl Fn(f64) -> Evidence,
    ) -> Self {
        let mut of_ended = Vec::new();
        let mut of_passed = Vec::new();
        for part in PARTS {
            for kernel in 0..kernels {
                let share = part * most_ended;
                of_ended.push((to_f32(1.0 / share), ended(kernel, share).excess()));
            }
            let share = part * most_passed;
            of_passed.push((to_f32(1.0 / share), passed(share).excess()));
        }
        Self {
            grid,
            ended: of_ended,
            passed: of_passed,
            largest: vec![0.0; grid.height() * NUMBERS * padded(grid.width())],
        }
    }

    /// About how many bytes this takes.
    pub(super) fn bytes(size: &Size) -> f64 {
        4.0 * as_f64(NUMBERS) * size.padded()
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(super) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        let (per_row, stride) = (groups_per_row(&self.grid), padded(self.grid.width()));
        let width = self.grid.width();
        let Self { ended, passed, largest, .. } = self;
        let place = |block: usize| changed.partition_point(|changed| *changed < block);
        let rows = largest.par_chunks_mut(NUMBERS * stride).enumerate().with_min_len(8);
        rows.for_each(|(y, row)| {
            for block in &changed[place(y * per_row)..place((y + 1) * per_row)] {
                let x = block % per_row * LANES;
                for (i, readings) in [&*ended, &*passed].into_iter().enumerate() {
                    let largest = arch.dispatch(
                        #[inline(always)]
                        || {
                            let prior = belief.prior(*block);
                            let mut largest = [[0.0f32; LANES]; 2];
                            for (by_share, reading) in readings {
                                let gain = reading.gain(&prior);
                                let slope = gain.map(|gain| by_share * gain);
                                for (largest, value) in largest.iter_mut().zip([gain, slope]) {
                                    for lane in 0..LANES {
                                        let (so_far, value) = (largest[lane], value[lane]);
                                        largest[lane] = if value > so_far { value } else { so_far };
                                    }
                                }
                            }
                            largest
                        },
                    );
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

    /// Adds the bound of a cell, by c_m, L, and f where the cell was passed.
    #[inline(always)]
    pub(super) fn add(
        &self,
        sum: &mut Lanes,
        (y, x): (usize, isize),
        (ended, any): (&Lanes, &Lanes),
        free: f32,
    ) {
        let stride = padded(self.grid.width());
        let first = y * NUMBERS * stride + PAD.wrapping_add_signed(x);
        let number = |i: usize| lanes_at(&self.largest, first + i * stride);
        let (most_ended, slope_ended) = (number(0), number(1));
        let (most_passed, slope_passed) = (number(2), number(3));
        for lane in 0..LANES {
            let by_end = slope_ended[lane] * ended[lane];
            let by_free = slope_passed[lane] * ((any[lane] - ended[lane]) * free);
            let by_end = if by_end < most_ended[lane] { by_end } else { most_ended[lane] };
            let by_free = if by_free < most_passed[lane] { by_free } else { most_passed[lane] };
            sum[lane] += by_end + by_free;
        }
    }
}
