//! What each beam of each view-point sees and gains, kept until a scan changes it.

use crate::cells::{Cells, Offsets};
use crate::gain::fast::{FastGain, Scratch};
use crate::{BeamStencil, PlannerParameters, RangeLikelihood, Stencil, range_likelihood};
use covmap::{Cell, Grid};
use covmap_model::SensorModel;
use rayon::prelude::*;

/// The beam must be ray-traced again.
const SIGHT: u8 = 1;
/// The beam's gain must be computed again.
const GAIN: u8 = 2;
/// A cell that is a reason to measure is in the beam's sight.
const REASON: u8 = 4;
/// The upper bound of the beam's gain must be computed again.
const BOUND: u8 = 8;
/// Whether a reason is in the beam's sight must be looked up again.
const LIMIT: u8 = 16;
/// The upper bound of the beam's gain holds, but a new one may be lower.
const LOOSE: u8 = 32;

/// View-points that one thread takes at a time.
const PART: usize = 64;

/// How far the values of view-points are brought up to date.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Upto {
    /// V(l) only.
    Sight,
    /// V(l), and an upper bound of E\[I\] at least.
    Bound,
    /// V(l) and E\[I\].
    Gain,
}

impl Upto {
    fn flags(self) -> u8 {
        match self {
            Upto::Sight => SIGHT | LIMIT,
            Upto::Bound => SIGHT | LIMIT | BOUND,
            Upto::Gain => SIGHT | LIMIT | GAIN,
        }
    }
}

/// A beam from which a cell can be seen: the view-point's place from the cell, and the
/// cell's rank in the beam's order of distance.
#[derive(Debug, Clone, Copy)]
struct Onlooker {
    dx: i32,
    dy: i32,
    beam: u32,
    rank: u16,
}

/// Cached values for every (view-point, beam).
///
/// A value depends on the first `horizon` cells of its beam only; when one of these changes
/// the value is marked, and computed again when it is next asked for.
#[derive(Debug, Clone)]
pub(crate) struct BeamCache {
    grid: Grid,
    stencil: Stencil,
    offsets: Vec<Offsets>,
    uniform_share: f64,
    fast: FastGain,
    onlookers: Vec<Onlooker>,
    /// How many cells of the beam are in sight: V(l) beam by beam.
    in_sight: Vec<u16>,
    horizon: Vec<u16>,
    flags: Vec<u8>,
    /// E\[I\] of the beam; an upper bound of it while that is marked.
    gain: Vec<f64>,
}

impl BeamCache {
    pub(crate) fn new(
        model: &SensorModel,
        stencil: &Stencil,
        cells: &Cells,
        grid: Grid,
        parameters: &PlannerParameters,
    ) -> Self {
        let slots = grid.len() * stencil.beams.len();
        Self {
            grid,
            stencil: stencil.clone(),
            offsets: cells.offsets(stencil),
            uniform_share: parameters.uniform_share,
            fast: FastGain::new(model, stencil),
            onlookers: onlookers(stencil),
            in_sight: vec![0; slots],
            horizon: vec![u16::MAX; slots],
            flags: vec![SIGHT | GAIN | BOUND; slots],
            gain: vec![0.0; slots],
        }
    }

    /// Marks the gains that depend on a cell whose entropy rose by `rise` \[nats\], or fell.
    ///
    /// An upper bound of a gain goes up by no more than that.
    pub(crate) fn mark_gains(&mut self, cell: Cell, rise: f64) {
        let Self { flags, gain, .. } = self;
        let mark = |slot: usize| {
            if flags[slot] & (GAIN | BOUND) == GAIN {
                gain[slot] += rise;
                flags[slot] |= LOOSE;
            } else {
                flags[slot] |= GAIN | BOUND;
            }
        };
        for_each_onlooker(&self.onlookers, &self.grid, &self.stencil, &self.horizon, cell, mark);
    }

    /// Marks all that depends on what a cell reflects and whether it can change.
    pub(crate) fn mark_sights(&mut self, cell: Cell) {
        self.mark_flags(cell, SIGHT | GAIN | BOUND);
    }

    /// Marks what depends on the distance up to which a cell is a reason to measure.
    pub(crate) fn mark_limit(&mut self, cell: Cell) {
        self.mark_flags(cell, LIMIT);
    }

    fn mark_flags(&mut self, cell: Cell, mask: u8) {
        let flags = &mut self.flags;
        let mark = |slot: usize| flags[slot] |= mask;
        for_each_onlooker(&self.onlookers, &self.grid, &self.stencil, &self.horizon, cell, mark);
    }

    /// Marks the gains of a view-point, whatever changed.
    pub(crate) fn forget_gain(&mut self, view_point: usize) {
        let slots = self.slots(view_point);
        self.flags[slots].iter_mut().for_each(|flags| *flags |= GAIN | BOUND);
    }

    /// Brings the values of view-points up to date.
    ///
    /// `least` tells for each view-point the gain that it needs to matter: infinite where
    /// nothing is wanted. Where the beams evaluated so far show that a view-point stays below,
    /// the rest of its beams keep their bounds.
    pub(crate) fn refresh(&mut self, cells: &Cells, least: &[f64], upto: Upto) {
        let beams = self.stencil.beams.len();
        let (stencil, offsets, fast) = (&self.stencil, &self.offsets, &self.fast);
        let view_points = self
            .flags
            .par_chunks_mut(beams)
            .zip(self.in_sight.par_chunks_mut(beams))
            .zip(self.horizon.par_chunks_mut(beams))
            .zip(self.gain.par_chunks_mut(beams))
            .enumerate()
            // Wanted view-points lie close together: small parts share them out.
            .with_max_len(PART);
        let uniform_share = self.uniform_share;
        view_points.for_each_init(
            Scratch::default,
            |scratch, (view_point, (((flags, in_sight), horizon), gain))| {
                let least = least[view_point];
                let wanted = least < f64::INFINITY && flags.iter().any(|f| f & upto.flags() != 0);
                if !wanted {
                    return;
                }
                if upto == Upto::Gain {
                    for beam in 0..beams {
                        if flags[beam] & (LOOSE | SIGHT) != LOOSE {
                            continue;
                        }
                        let look = Look { cells, offsets: &offsets[beam], view_point };
                        look.ahead(&stencil.beams[beam], uniform_share, &mut scratch.likelihood);
                        gain[beam] = look.gain_bound(&stencil.beams[beam], &scratch.likelihood);
                        flags[beam] &= !LOOSE;
                    }
                }
                for (beam, cone) in stencil.beams.iter().enumerate() {
                    if flags[beam] & upto.flags() == 0 {
                        continue;
                    }
                    if upto == Upto::Gain && mean(gain) < least {
                        return;
                    }
                    let look = Look { cells, offsets: &offsets[beam], view_point };
                    let stale = flags[beam];
                    if stale & (SIGHT | LIMIT) == LIMIT {
                        let seen = usize::from(in_sight[beam]);
                        flags[beam] = stale & !(LIMIT | REASON) | look.reason(seen);
                    }
                    if stale & upto.flags() == LIMIT {
                        continue;
                    }
                    look.ahead(cone, uniform_share, &mut scratch.likelihood);
                    if flags[beam] & SIGHT != 0 {
                        let seen = scratch.likelihood.cells_in_sight(cone);
                        flags[beam] = stale & !(SIGHT | LIMIT | REASON) | look.reason(seen);
                        in_sight[beam] = rank(seen);
                        horizon[beam] = rank(dependency(cone, &scratch.likelihood));
                    }
                    if upto == Upto::Gain && flags[beam] & GAIN != 0 {
                        gain[beam] = fast.beam_gain(cells, look.offsets, beam, view_point, scratch);
                        flags[beam] &= !(GAIN | BOUND | LOOSE);
                    } else if upto == Upto::Bound && flags[beam] & BOUND != 0 {
                        gain[beam] = look.gain_bound(cone, &scratch.likelihood);
                        flags[beam] &= !(BOUND | LOOSE);
                    }
                }
            },
        );
    }

    /// Whether [`Self::gain`] of a view-point is exact, and not an upper bound.
    pub(crate) fn is_exact(&self, view_point: usize) -> bool {
        self.slots(view_point).all(|slot| self.flags[slot] & GAIN == 0)
    }

    /// Whether a view-point, if it is up to date, holds a reason to measure in sight.
    pub(crate) fn has_reason(&self, view_point: usize) -> bool {
        self.slots(view_point).any(|slot| self.flags[slot] & REASON != 0)
    }

    /// E\[I(l)\] of a view-point that is up to date, or an upper bound of it \[nats\].
    pub(crate) fn gain(&self, view_point: usize) -> f64 {
        mean(&self.gain[self.slots(view_point)])
    }

    /// V(l) of a view-point that is up to date: cells by their row-major index, with their
    /// distance from the sensor, in row-major order; a cell in two beams once, with the
    /// shorter distance.
    pub(crate) fn cells_in_sight(&self, view_point: usize) -> Vec<(usize, f32)> {
        let mut seen: Vec<(usize, f32)> = self.sights(view_point).collect();
        seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        seen.dedup_by_key(|(index, _)| *index);
        seen
    }

    /// Whether a view-point that is up to date holds a cell in sight that `is_wanted`, by its
    /// row-major index and its distance from the sensor.
    pub(crate) fn sees(
        &self,
        view_point: usize,
        is_wanted: impl Fn(&(usize, f32)) -> bool,
    ) -> bool {
        self.sights(view_point).any(|cell| is_wanted(&cell))
    }

    /// The cells in sight of a view-point, beam by beam.
    fn sights(&self, view_point: usize) -> impl Iterator<Item = (usize, f32)> {
        let from = self.grid.cell(view_point);
        let beams = self.stencil.beams.iter().zip(&self.offsets);
        self.slots(view_point).zip(beams).flat_map(move |(slot, (cone, offsets))| {
            let in_sight = usize::from(self.in_sight[slot]);
            let cells = cone.cells[..in_sight].iter().zip(&offsets.distance);
            cells.filter_map(move |(cell, distance)| {
                Some((self.grid.index(from.offset(cell.dx, cell.dy))?, *distance))
            })
        })
    }

    fn slots(&self, view_point: usize) -> std::ops::Range<usize> {
        let beams = self.stencil.beams.len();
        view_point * beams..(view_point + 1) * beams
    }
}

/// A beam as it looks from a view-point.
struct Look<'a> {
    cells: &'a Cells,
    offsets: &'a Offsets,
    view_point: usize,
}

impl Look<'_> {
    fn ahead(&self, cone: &BeamStencil, uniform_share: f64, out: &mut RangeLikelihood) {
        let here = self.cells.bordered(self.view_point);
        let at = |i: usize| here.wrapping_add_signed(self.offsets.bordered[i]);
        range_likelihood(cone, uniform_share, |i| self.cells.reflection(at(i)), out);
    }

    /// [`REASON`] if one of the first `count` cells is a reason to measure from here.
    fn reason(&self, count: usize) -> u8 {
        let here = self.cells.bordered(self.view_point);
        let cells = self.offsets.distance[..count].iter().zip(&self.offsets.bordered);
        let is_reason = |(distance, offset): (&f32, &isize)| {
            self.cells.is_reason(here.wrapping_add_signed(*offset), *distance)
        };
        if cells.into_iter().any(is_reason) { REASON } else { 0 }
    }

    /// An upper bound of the beam's E\[I\]: no outcome can take more from a cell than its
    /// entropy, so E\[I\] ≤ Σ_i H(h(c_i)) · P(c_i is covered). One part in 10⁵ is added for
    /// rounding.
    fn gain_bound(&self, cone: &BeamStencil, likelihood: &RangeLikelihood) -> f64 {
        let here = self.cells.bordered(self.view_point);
        let entropy = |i: usize| {
            let changeable =
                self.cells.is_changeable(here.wrapping_add_signed(self.offsets.bordered[i]));
            let index = || self.view_point.wrapping_add_signed(self.offsets.plain[i]);
            if changeable { f64::from(self.cells.entropy(index())) } else { 0.0 }
        };
        // Sums over prefixes of the cells, outcome by outcome: their reaches grow with k.
        let (mut bound, mut sum, mut next) = (0.0, 0.0, 0);
        for (p, reach) in likelihood.echo.iter().zip(&cone.echo_reach) {
            if *p > 0.0 {
                sum += (next..*reach).map(entropy).sum::<f64>();
                next = *reach;
                bound += p * sum;
            }
        }
        if likelihood.no_echo > 0.0 {
            bound += likelihood.no_echo * (0..cone.no_echo_reach).map(entropy).sum::<f64>();
        }
        bound * (1.0 + 1e-5) + 1e-9
    }
}

#[allow(clippy::cast_possible_truncation, reason = "a planner refuses beams of more cells")]
fn rank(count: usize) -> u16 {
    count as u16
}

/// The average over the beams.
fn mean(gains: &[f64]) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "few beams")]
    let beams = gains.len() as f64;
    gains.iter().sum::<f64>() / beams
}

/// How many of a beam's cells decide its sight and its gain: those that may reflect, and
/// those that a possible outcome covers.
fn dependency(beam: &BeamStencil, likelihood: &RangeLikelihood) -> usize {
    let traced = beam.rings[..likelihood.traced].iter().map(|ring| ring.end);
    let outcomes = (0..=likelihood.echo.len()).filter(|k| likelihood.probability(*k) > 0.0);
    traced.chain(outcomes.map(|k| beam.reach(k))).max().unwrap_or(0)
}

/// Calls `mark` with the slot of every (view-point, beam) whose values depend on a cell.
#[inline(always)]
fn for_each_onlooker(
    onlookers: &[Onlooker],
    grid: &Grid,
    stencil: &Stencil,
    horizon: &[u16],
    cell: Cell,
    mut mark: impl FnMut(usize),
) {
    let beams = stencil.beams.len();
    for onlooker in onlookers {
        let Some(index) = grid.index(cell.offset(onlooker.dx, onlooker.dy)) else { continue };
        let slot = index * beams + onlooker.beam as usize;
        if onlooker.rank < horizon[slot] {
            mark(slot);
        }
    }
}

/// All (view-point, beam) that can see a cell, in the order of the view-points.
fn onlookers(stencil: &Stencil) -> Vec<Onlooker> {
    let mut onlookers = Vec::new();
    for (beam, cone) in stencil.beams.iter().enumerate() {
        for (i, cell) in cone.cells.iter().enumerate() {
            let beam = u32::try_from(beam).unwrap_or(u32::MAX);
            onlookers.push(Onlooker { dx: -cell.dx, dy: -cell.dy, beam, rank: rank(i) });
        }
    }
    onlookers.sort_by_key(|o| (o.dy, o.dx, o.beam));
    onlookers
}
