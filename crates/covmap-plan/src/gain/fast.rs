//! Eq. (14) as it runs: one logarithm for each (cell, d), and many cells side by side.
//!
//! With u = h·log h of the stored histogram and v = t·log t of the evidence, the entropy of
//! the normalised product h·t/Z is
//!
//! ```text
//! H' = log Z − (Σ u·t + Σ h·v)/Z,   Z = Σ h·t
//! ```
//!
//! so that no product is normalised and nothing is copied but the histograms of one beam.

use super::logarithm::{LANES, Lanes, ln};
use super::tables::{GainTables, OutcomeRows};
use crate::cells::{Cells, Offsets};
use crate::{RangeLikelihood, Stencil};
use covmap_model::SensorModel;
use pulp::{Simd, WithSimd};

/// Outcomes less likely than this are left out. One outcome gains or loses less than ln n in
/// each of the beam's cells, so all of them together change a beam's E\[I\] by less than
/// (K + 2) · cells · ln n times this: some 1e-8 nats for a sonar.
const NEGLIGIBLE: f64 = 1e-10;

/// 1 for the first so many lanes, 0 for the others.
const COVERED: [Lanes; LANES + 1] = {
    let mut masks = [[0.0; LANES]; LANES + 1];
    let mut count = 0;
    while count <= LANES {
        let mut lane = 0;
        while lane < count {
            masks[count][lane] = 1.0;
            lane += 1;
        }
        count += 1;
    }
    masks
};

/// The histograms of one beam's cells, block by block.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) likelihood: RangeLikelihood,
    h: Vec<Lanes>,
    u: Vec<Lanes>,
    entropy: Vec<Lanes>,
    /// 1 for a cell that a measurement can change, else 0.
    changeable: Vec<Lanes>,
}

/// Evaluates E\[I\] of single beams.
#[derive(Debug, Clone)]
pub(crate) struct FastGain {
    tables: GainTables,
    outcomes: usize,
    arch: pulp::Arch,
}

impl FastGain {
    pub(crate) fn new(model: &SensorModel, stencil: &Stencil) -> Self {
        let tables = GainTables::new(model, stencil);
        Self { tables, outcomes: stencil.outcomes(), arch: pulp::Arch::new() }
    }

    /// E\[I\] of a beam from the view-point with a row-major index, given its range likelihood
    /// in `scratch`.
    pub(crate) fn beam_gain(
        &self,
        cells: &Cells,
        offsets: &Offsets,
        beam: usize,
        view_point: usize,
        scratch: &mut Scratch,
    ) -> f64 {
        self.arch.dispatch(BeamGain { fast: self, cells, offsets, beam, view_point, scratch })
    }
}

/// One beam's E\[I\], compiled for each kind of vector registers; all give the same bits.
struct BeamGain<'a> {
    fast: &'a FastGain,
    cells: &'a Cells,
    offsets: &'a Offsets,
    beam: usize,
    view_point: usize,
    scratch: &'a mut Scratch,
}

impl WithSimd for BeamGain<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let Self { fast, cells, offsets, beam, view_point, scratch } = self;
        let probability = |scratch: &Scratch, k| scratch.likelihood.probability(k);
        let rows = |k| fast.tables.rows(beam, k);
        let mut farthest = 0;
        for k in 0..fast.outcomes {
            if probability(scratch, k) > NEGLIGIBLE {
                farthest = farthest.max(rows(k).covered);
            }
        }
        scratch.gather(cells, offsets, view_point, farthest);
        let mut expected = 0.0;
        for k in 0..fast.outcomes {
            let p = probability(scratch, k);
            if p > NEGLIGIBLE {
                expected += p * scratch.outcome_gain(rows(k), cells.bins());
            }
        }
        expected
    }
}

impl Scratch {
    /// Copies the histograms of the first `count` cells of a beam, transposed. Not inlined:
    /// with wide registers the compiler would scatter, at twice the time.
    #[inline(never)]
    fn gather(&mut self, cells: &Cells, offsets: &Offsets, view_point: usize, count: usize) {
        let (bins, blocks) = (cells.bins(), count.div_ceil(LANES));
        self.reserve(blocks, bins);
        let bordered = cells.bordered(view_point);
        for block in 0..blocks {
            let h = &mut self.h[block * bins..(block + 1) * bins];
            let u = &mut self.u[block * bins..(block + 1) * bins];
            let (entropy, changeable) = (&mut self.entropy[block], &mut self.changeable[block]);
            for lane in 0..LANES {
                let i = block * LANES + lane;
                let at = |i: usize| bordered.wrapping_add_signed(offsets.bordered[i]);
                if i < count && cells.is_changeable(at(i)) {
                    let index = view_point.wrapping_add_signed(offsets.plain[i]);
                    let (from_h, from_u) = cells.row(index);
                    (entropy[lane], changeable[lane]) = (cells.entropy(index), 1.0);
                    h.iter_mut().zip(from_h).for_each(|(to, from)| to[lane] = *from);
                    u.iter_mut().zip(from_u).for_each(|(to, from)| to[lane] = *from);
                } else {
                    // Any histogram will do, as long as its numbers are tame.
                    (entropy[lane], changeable[lane]) = (0.0, 0.0);
                    h.iter_mut().for_each(|to| to[lane] = 1.0);
                    u.iter_mut().for_each(|to| to[lane] = 0.0);
                }
            }
        }
    }

    fn reserve(&mut self, blocks: usize, bins: usize) {
        let nothing = [0.0; LANES];
        if self.changeable.len() < blocks {
            self.h.resize(blocks * bins, nothing);
            self.u.resize(blocks * bins, nothing);
            self.entropy.resize(blocks, nothing);
            self.changeable.resize(blocks, nothing);
        }
    }

    /// Σ I(h(c_i) | d) over the cells of one outcome.
    #[inline(always)]
    fn outcome_gain(&self, rows: &OutcomeRows, bins: usize) -> f64 {
        let mut sum = [0.0f32; LANES];
        let posterior = self.h.chunks_exact(bins).zip(self.u.chunks_exact(bins));
        let evidence = rows.t.chunks_exact(bins).zip(rows.v.chunks_exact(bins));
        let before = self.entropy.iter().zip(&self.changeable);
        let mut left = rows.covered;
        for (((h, u), (t, v)), (entropy, changeable)) in posterior.zip(evidence).zip(before) {
            let (mut z, mut s) = ([0.0f32; LANES], [0.0f32; LANES]);
            for ((h, u), (t, v)) in h.iter().zip(u).zip(t.iter().zip(v)) {
                for lane in 0..LANES {
                    z[lane] += h[lane] * t[lane];
                    s[lane] += u[lane] * t[lane] + h[lane] * v[lane];
                }
            }
            let (log_z, covered) = (ln(&z), &COVERED[left.min(LANES)]);
            for lane in 0..LANES {
                let after = log_z[lane] - s[lane] / z[lane];
                sum[lane] += covered[lane] * changeable[lane] * (entropy[lane] - after);
            }
            left = left.saturating_sub(LANES);
        }
        sum.iter().map(|g| f64::from(*g)).sum()
    }
}
