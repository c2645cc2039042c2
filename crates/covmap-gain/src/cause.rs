//! The fast evaluation of E\[I\] for the update by cause.
//!
//! The gain of a cell by an imagined echo depends on the cell's histogram and on two shares: g of
//! "passed" and s of "ended", which follow from the causes, [`covmap_model::Causes`]. E\[I\] of a
//! beam is therefore a sum of three kinds, over the outcomes k with their p(d_k | c), causes
//! c_m(k), and L(k):
//!
//! ```text
//! in front   Σ_k p_k · Σ_i G_i(f_i · L(k))             over the cells i before the end
//! at the end Σ_k p_k · Σ_i I(h_i | s = c_m(k), g)      over the few cells in which it may lie
//! behind     Σ_k p_k · Σ_i B_i(b · c_m(k))             over those just behind
//! ```
//!
//! G_i and B_i are functions of one number each, which are kept for every cell as polynomials
//! ([`polynomials`]). With G_i(x) = Σ_q C_iq · x^q the sum over the outcomes comes first,
//!
//! ```text
//! Σ_k p_k · G_i(f_i · L(k)) = Σ_q C_iq · f_i^q · S_q(i)     S_q(i) = Σ_k p_k · L(k)^q
//! ```
//!
//! with k over the outcomes that end beyond i. From the farthest cell inwards, each outcome is
//! added to the S_q once, and a cell costs as much as one reading. The cells at the end are
//! evaluated as they are ([`ends`]).

mod beam;
mod causes;
mod ceilings;
mod ends;
mod fronts;
mod polynomials;
mod sums;

use crate::belief::{Belief, NOT_KNOWN, lanes_at, padded};
use crate::largest::Largest;
use crate::memory::Size;
use crate::numbers::to_f32;
use crate::outcomes::{AskedRow, BeamAnswer, RowGains};
use crate::sight::GroupLikelihood;
use crate::view_points::groups_per_row;
use crate::{InformationGain, Stencil, evidence::BinEvidence};
use beam::CauseBeam;
use ceilings::{Bands, Ceilings};
use covmap::Grid;
use covmap::lanes::{LANES, Lanes};
use covmap_model::{CauseParameters, ModelParameters, SensorModel, gaussian, opaque};
use ends::AtEnd;
use polynomials::Polynomials;
use pulp::Arch;
use rayon::prelude::*;
use sums::{AllAndReasons, GainsOfRow, GroupSum, LargestOfRow};

/// The smallest number of rows of view-points for one thread.
const ROWS_PER_THREAD: usize = 1;

/// Evaluates E\[I\] of many beams.
#[derive(Debug, Clone)]
pub(crate) struct Cause {
    parameters: CauseParameters,
    grid: Grid,
    beams: Vec<CauseBeam>,
    at_end: AtEnd,
    /// G of every cell, over g; `None` where it is evaluated for every outcome.
    front: Option<Polynomials>,
    /// B of every cell, over s; `None` likewise.
    behind: Option<Polynomials>,
    /// `None` without bounds.
    ceilings: Option<Ceilings>,
    /// Bordered: E\[c\]^p.
    surface: Vec<f32>,
    /// Bordered: 1 − o.
    clear: Vec<f32>,
    /// Novelty of a reading, by row and column of the view-point, padded as histograms are.
    novelty: Vec<f32>,
}

impl Cause {
    pub(crate) fn new(
        model: &SensorModel,
        parameters: &CauseParameters,
        stencil: &Stencil,
        grid: Grid,
        belief: &Belief,
        (gain, with_bounds): (InformationGain, bool),
    ) -> Self {
        let ModelParameters { bins, .. } = *model.parameters();
        let (p, r) = (parameters, model.resolution());
        let (free, covered) = ((0.0, p.free.sigma), (1.0, p.sigma_behind));
        let all = p.bearings as f64;
        let most_any = all / (all + p.chance);
        let most_passed = p.free.share * p.no_echo.share.max(most_any);
        let most_ended = 1.0 / (1.0 + p.chance);
        let most_behind = p.behind_weight * most_ended;
        let polynomials = |kernel, most| {
            Polynomials::new(grid, gain, most, |share| evidence(bins, kernel, share))
        };
        let (front, behind) = (polynomials(free, most_passed), polynomials(covered, most_behind));
        let usable = model.parameters().usable_range;
        let bands = Bands::new(p.sigma_in.at(0.0, 0.0), p.sigma_in.at(usable, usable));
        let at_end = AtEnd::new(p, bins, (most_ended, most_any));
        let width = belief.raster_width();
        let beam = |beam| CauseBeam::new((p, r, &at_end), (&bands, beam, stencil), width);
        let beams = stencil.beams.iter().map(beam).collect();
        let ceilings = || {
            let [a, b, c] = std::array::from_fn(|band| (most_ended, bands.kernels(band)));
            let behind = (most_behind, vec![covered]);
            let pairs = [a, b, c, (most_passed, vec![free]), behind];
            Ceilings::new(grid, pairs, |kernel, share| evidence(bins, kernel, share))
        };
        let cells = belief.expected().len();
        Self {
            parameters: p.clone(),
            grid,
            beams,
            at_end,
            ceilings: with_bounds.then(ceilings),
            front,
            behind,
            surface: vec![0.0; cells],
            clear: vec![1.0; cells],
            novelty: vec![1.0; grid.height() * padded(grid.width())],
        }
    }

    /// Estimates the bytes of the evaluation.
    pub(crate) fn bytes(size: &Size) -> f64 {
        // A cell of the stencil, and its kernels and surfaces for the outcomes that end nearby.
        let stencil = size.stencil * (40.0 + 4.0 * (4.0 * size.bins + 48.0 + 24.0));
        let ends = size.beams * size.ranges * 40.0;
        2.0 * Polynomials::bytes(size)
            + Ceilings::bytes(size)
            + 8.0 * size.bordered()
            + stencil
            + ends
    }

    /// Takes over blocks of cells that changed, given in ascending order.
    pub(crate) fn update(&mut self, arch: Arch, belief: &Belief, changed: &[usize]) {
        for polynomials in [&mut self.front, &mut self.behind].into_iter().flatten() {
            polynomials.update(arch, belief, changed);
        }
        if let Some(ceilings) = &mut self.ceilings {
            ceilings.update(arch, belief, changed);
        }
        let p = &self.parameters;
        let (width, per_row) = (self.grid.width(), groups_per_row(&self.grid));
        let unknown = to_f32(libm::pow(p.unknown_coverage, p.sharpness));
        for block in changed {
            let (y, x) = (block / per_row, block % per_row * LANES);
            let first = belief.bordered(y * width + x);
            for at in first..first + LANES.min(width - x) {
                let expected = belief.expected()[at];
                (self.surface[at], self.clear[at]) = if expected.to_bits() == NOT_KNOWN.to_bits() {
                    (unknown, 1.0)
                } else {
                    let expected = f64::from(expected);
                    let surface = libm::pow(expected, p.sharpness);
                    (to_f32(surface), to_f32(1.0 - opaque(expected)))
                };
            }
        }
    }

    /// Sets the novelty of a reading from a view-point.
    pub(crate) fn set_novelty(&mut self, (y, x): (usize, usize), novelty: f32) {
        self.novelty[y * padded(self.grid.width()) + x] = novelty;
    }

    /// Returns the shares of "passed" at which gains are interpolated.
    pub(crate) fn shares(&self) -> Vec<f64> {
        self.front.as_ref().map(Polynomials::shares).unwrap_or_default()
    }

    /// Returns whether there are bounds.
    pub(crate) fn has_bound(&self) -> bool {
        self.ceilings.is_some()
    }

    /// Returns upper bounds of the expected gain of a beam from each view-point of a group; `here`
    /// is the index of the first one in the bordered rasters.
    #[inline(always)]
    pub(crate) fn bound(
        &self,
        belief: &Belief,
        beam: usize,
        here: usize,
        likelihood: &GroupLikelihood,
    ) -> BeamAnswer {
        let (y, x) = belief.place(here);
        let count = likelihood.echoes().len() + 1;
        let (mut outcomes, mut probabilities) =
            (Vec::with_capacity(count), Vec::with_capacity(count));
        for (k, p) in likelihood.echoes() {
            outcomes.push(*k);
            probabilities.push(p.map(to_f32));
        }
        outcomes.push(usize::MAX);
        probabilities.push(likelihood.no_echo().map(to_f32));
        let group = GroupSum { cause: self, belief, y, x };
        let mut sum = AllAndReasons::of(&self.beams[beam].cells, (belief.limits(), here));
        let fronts = &mut Vec::with_capacity(count);
        group.sum::<false>(beam, (&outcomes, &probabilities), fronts, &mut sum);
        sum.answer
    }

    /// Returns the largest expected change of every cell from those view-points of some rows that
    /// have a bit.
    pub(crate) fn largest_changes(
        &self,
        arch: Arch,
        belief: &Belief,
        rows: &[(AskedRow, &[u16])],
    ) -> Largest {
        let none = || Largest::new(self.grid.len());
        let found = rows.par_iter().fold(none, |mut largest, (row, wanted)| {
            let of_row = LargestOfRow { cause: self, belief, row, wanted, largest: &mut largest };
            arch.dispatch(of_row);
            largest
        });
        found.reduce(none, Largest::merged)
    }

    /// Returns the gains of all beams of some rows, and the promises of their cells that gain at
    /// least `least`.
    pub(crate) fn gains(
        &self,
        arch: Arch,
        belief: &Belief,
        rows: &[AskedRow],
        least: f32,
    ) -> Vec<RowGains> {
        let rows = rows.par_iter().with_min_len(ROWS_PER_THREAD);
        rows.map(|row| arch.dispatch(GainsOfRow { cause: self, belief, row, least })).collect()
    }
}

/// Returns the evidence of a kernel with a share: (1 − share)·U + share·N(μ, σ).
fn evidence(bins: usize, (mu, sigma): (f64, f64), share: f64) -> BinEvidence {
    let mut t = vec![0.0; bins];
    gaussian(mu, sigma, &mut t);
    let even = (1.0 - share) / bins as f64;
    t.iter_mut().for_each(|t| *t = even + share * *t);
    BinEvidence::of(t)
}

/// Returns the numbers of a bordered raster at a cell, from each view-point of a group.
#[inline(always)]
fn at<'a>(raster: &'a [f32], here: usize, cell: &beam::CauseCell) -> &'a Lanes {
    lanes_at(raster, here.wrapping_add_signed(cell.offset))
}
