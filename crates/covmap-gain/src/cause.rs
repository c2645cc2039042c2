//! The fast evaluation of E\[I\] for the update by cause.
//!
//! What an imagined echo says of a cell depends on the cell's histogram and on two shares: g of
//! "passed" and s of "ended", which follow from the causes, [`covmap_model::Causes`]. So E\[I\] of a
//! beam is a sum of three kinds, over the outcomes k with their p(d_k | c), causes c_m(k), and L(k):
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
//! with k over the outcomes that end beyond i: going inwards from the farthest cell, an outcome is
//! added to the S_q once, and a cell costs as much as one reading. The cells at the end are
//! evaluated as they are ([`ends`]).

mod beam;
mod causes;
mod ceilings;
mod ends;
mod fronts;
mod polynomials;

use crate::belief::{Belief, NOT_KNOWN, lanes_at};
use crate::memory::Size;
use crate::numbers::to_f32;
use crate::outcomes::{AskedRow, RowGains};
use crate::sight::GroupLikelihood;
use crate::view_points::groups_per_row;
use crate::{InformationGain, Stencil, evidence::Evidence};
use beam::CauseBeam;
use causes::GroupCauses;
use ceilings::{Bands, Ceilings};
use covmap::Grid;
use covmap::lanes::{LANES, Lanes, add_product};
use covmap_model::{CauseParameters, ModelParameters, SensorModel, gaussian, opaque};
use ends::AtEnd;
use fronts::{Front, FrontSums};
use polynomials::Polynomials;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// So many rows of view-points are worked at by one thread at least.
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
        #[allow(clippy::cast_precision_loss, reason = "at most 16 bearings")]
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
        }
    }

    /// About how many bytes this takes.
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

    /// The shares of "passed" at which gains are interpolated.
    pub(crate) fn shares(&self) -> Vec<f64> {
        self.front.as_ref().map(Polynomials::shares).unwrap_or_default()
    }

    /// Whether there are bounds.
    pub(crate) fn has_bound(&self) -> bool {
        self.ceilings.is_some()
    }

    /// An upper bound of the gain of a beam from each view-point of a group; `here` is the index of
    /// the first one in the bordered rasters.
    #[inline(always)]
    pub(crate) fn bound(
        &self,
        belief: &Belief,
        beam: usize,
        here: usize,
        likelihood: &GroupLikelihood,
    ) -> Lanes {
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
        group.sum::<false>(beam, (&outcomes, &probabilities), &mut Vec::with_capacity(count))
    }

    /// The gains of all beams of some rows.
    pub(crate) fn gains(&self, arch: Arch, belief: &Belief, rows: &[AskedRow]) -> Vec<RowGains> {
        let rows = rows.par_iter().with_min_len(ROWS_PER_THREAD);
        rows.map(|row| arch.dispatch(GainsOfRow { cause: self, belief, row })).collect()
    }
}

/// What a kernel says with a share: (1 − share)·U + share·N(μ, σ).
fn evidence(bins: usize, (mu, sigma): (f64, f64), share: f64) -> Evidence {
    let mut t = vec![0.0; bins];
    gaussian(mu, sigma, &mut t);
    #[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
    let even = (1.0 - share) / bins as f64;
    t.iter_mut().for_each(|t| *t = even + share * *t);
    Evidence::of(t)
}

/// The gains of one row.
struct GainsOfRow<'a> {
    cause: &'a Cause,
    belief: &'a Belief,
    row: &'a AskedRow,
}

impl WithSimd for GainsOfRow<'_> {
    type Output = RowGains;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> RowGains {
        let Self { cause, belief, row } = self;
        let (mut fronts, mut gains) = (Vec::new(), Vec::with_capacity(row.beams.len()));
        // A closure would be compiled for narrower registers.
        for asked in &row.beams {
            let group = GroupSum { cause, belief, y: row.y, x: asked.group * LANES };
            let outcomes = &row.outcomes[asked.outcomes.clone()];
            let probabilities = &row.probabilities[asked.outcomes.clone()];
            let gain = group.sum::<true>(asked.beam, (outcomes, probabilities), &mut fronts);
            gains.push(gain.map(f64::from));
        }
        gains
    }
}

/// A beam's sums over its outcomes from a group of view-points, the first of which is in column `x`
/// of row `y`.
struct GroupSum<'a> {
    cause: &'a Cause,
    belief: &'a Belief,
    y: usize,
    x: usize,
}

impl GroupSum<'_> {
    /// E\[I\] of a beam, or an upper bound of it.
    #[inline(always)]
    fn sum<const EXACT: bool>(
        &self,
        beam: usize,
        (outcomes, probabilities): (&[usize], &[Lanes]),
        fronts: &mut Vec<Front>,
    ) -> Lanes {
        let (cause, belief) = (self.cause, self.belief);
        let beam = &cause.beams[beam];
        let here = belief.bordered(self.y * cause.grid.width()) + self.x;
        let mut causes = GroupCauses::new(&cause.parameters);
        let mut gain = [0.0; LANES];
        fronts.clear();
        for (k, probability) in outcomes.iter().zip(probabilities) {
            let (cells, any) = if let Some(end) = beam.ends.get(*k) {
                causes.pass(&cause.clear, &beam.cells[..end.front], here);
                causes.explain(&cause.surface, beam, end, here);
                self.add_ends::<EXACT>(&mut gain, (beam, end), &causes, probability);
                (end.front, causes.any)
            } else {
                let mut silent = GroupCauses::new(&cause.parameters);
                silent.pass(&cause.clear, &beam.cells[..beam.no_echo], here);
                (beam.no_echo, silent.of_no_echo())
            };
            fronts.push(Front { cells, probability: *probability, any });
        }
        match (self.bounds::<EXACT>(), &cause.front) {
            (Some(ceilings), _) => self.add_fronts(&mut gain, beam, (fronts, ceilings.no_sums())),
            (_, Some(front)) => self.add_fronts(&mut gain, beam, (fronts, front.no_sums())),
            _ => fronts.iter().for_each(|front| self.add_each_front(&mut gain, beam, front)),
        }
        gain
    }

    /// Adds the gains, or their bounds, of the cells at the end and behind it.
    #[inline(always)]
    fn add_ends<const EXACT: bool>(
        &self,
        gain: &mut Lanes,
        (beam, end): (&CauseBeam, &beam::End),
        causes: &GroupCauses<'_>,
        probability: &Lanes,
    ) {
        let (at_end, bounds) = (&self.cause.at_end, self.bounds::<EXACT>());
        let mut sum = [0.0; LANES];
        for (cell, near) in beam.cells[end.front..end.ended].iter().zip(&beam.near[end.first..]) {
            let Some((y, x)) = self.place(cell) else { continue };
            let ended = causes.ended(cell);
            if let Some(ceilings) = bounds {
                let kernel = (near.band, near.free);
                ceilings.add_end(&mut sum, (y, x), (ended, &causes.any), kernel);
            } else {
                let prior = self.belief.prior_at(y, x);
                at_end.add(&mut sum, &prior, near.kernel(), ended, &causes.any);
            }
        }
        for cell in &beam.cells[end.ended..end.reach] {
            let Some((y, x)) = self.place(cell) else { continue };
            let ended = causes.ended(cell);
            if let Some(ceilings) = bounds {
                ceilings.add_behind(&mut sum, (y, x), ended, beam.behind_weight);
            } else if let Some(behind) = &self.cause.behind {
                behind.add(&mut sum, (y, x), ended, beam.behind_weight);
            } else {
                let (prior, kernel) =
                    (self.belief.prior_at(y, x), at_end.behind(beam.behind_weight));
                at_end.add(&mut sum, &prior, kernel, ended, &causes.any);
            }
        }
        add_product(gain, probability, &sum);
    }

    /// What bounds are made of, unless gains are asked for.
    #[inline(always)]
    fn bounds<const EXACT: bool>(&self) -> Option<&Ceilings> {
        self.cause.ceilings.as_ref().filter(|_| !EXACT)
    }

    /// Adds the gains, or their bounds, of the cells in front of the ends of all outcomes: from the
    /// farthest cell inwards, each for all outcomes at once.
    #[inline(always)]
    fn add_fronts(
        &self,
        gain: &mut Lanes,
        beam: &CauseBeam,
        (fronts, mut sums): (&mut [Front], impl FrontSums),
    ) {
        fronts.sort_by_key(|front| std::cmp::Reverse(front.cells));
        for i in 0..fronts.len() {
            let Front { cells, probability, any } = &fronts[i];
            sums.add(probability, any);
            let next = fronts.get(i + 1).map_or(0, |next| next.cells);
            for cell in beam.cells[next..*cells].iter().filter(|cell| cell.free > 0.0) {
                let Some(place) = self.place(cell) else { continue };
                sums.add_cell(gain, place, cell.free);
            }
        }
    }

    /// Cell by cell for one outcome.
    #[inline(always)]
    fn add_each_front(&self, gain: &mut Lanes, beam: &CauseBeam, front: &Front) {
        let (at_end, mut sum) = (&self.cause.at_end, [0.0; LANES]);
        for cell in beam.cells[..front.cells].iter().filter(|cell| cell.free > 0.0) {
            let Some((y, x)) = self.place(cell) else { continue };
            let prior = self.belief.prior_at(y, x);
            let kernel = at_end.passed(cell.free);
            at_end.add(&mut sum, &prior, kernel, &[0.0; LANES], &front.any);
        }
        add_product(gain, &front.probability, &sum);
    }

    /// Row and column of a cell as the first view-point sees it; `None` if it is outside of
    /// the grid for the whole group.
    #[inline(always)]
    fn place(&self, cell: &beam::CauseCell) -> Option<(usize, isize)> {
        let grid = &self.cause.grid;
        let y = self.y.wrapping_add_signed(cell.dy);
        let x = self.x.cast_signed() + cell.dx;
        let is_inside =
            y < grid.height() && x > -LANES.cast_signed() && x < grid.width().cast_signed();
        is_inside.then_some((y, x))
    }
}

/// Numbers of a bordered raster at a cell, from each view-point of a group.
#[inline(always)]
fn at<'a>(raster: &'a [f32], here: usize, cell: &beam::CauseCell) -> &'a Lanes {
    lanes_at(raster, here.wrapping_add_signed(cell.offset))
}
