//! What each beam of each view-point sees and gains, kept until a scan changes it.

use crate::cells::{Cells, Offsets};
use crate::gain::fast::{FastGain, Scratch};
use crate::{PlannerParameters, RangeLikelihood, Stencil, range_likelihood};
use covmap::{Cell, Grid};
use covmap_model::SensorModel;
use rayon::prelude::*;

/// The beam must be ray-traced again.
const SIGHT: u8 = 1;
/// The beam's gain must be computed again.
const GAIN: u8 = 2;
/// A cell that is a reason to measure is in the beam's sight.
const REASON: u8 = 4;

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
            flags: vec![SIGHT | GAIN; slots],
            gain: vec![0.0; slots],
        }
    }

    /// Marks what depends on a cell whose posterior changed: gains, and, where what it
    /// reflects or whether it is a reason changed as well, sights.
    pub(crate) fn mark(&mut self, cell: Cell, gain: bool, sight: bool) {
        let mask = if gain { GAIN } else { 0 } | if sight { SIGHT } else { 0 };
        let beams = self.stencil.beams.len();
        for onlooker in &self.onlookers {
            let Some(index) = self.grid.index(cell.offset(onlooker.dx, onlooker.dy)) else {
                continue;
            };
            let slot = index * beams + onlooker.beam as usize;
            if onlooker.rank < self.horizon[slot] {
                self.flags[slot] |= mask;
            }
        }
    }

    /// Brings the sights, and if asked the gains, of the wanted view-points up to date.
    pub(crate) fn refresh(&mut self, cells: &Cells, wanted: &[bool], with_gain: bool) {
        let beams = self.stencil.beams.len();
        let Self { stencil, offsets, uniform_share, fast, in_sight, horizon, flags, gain, .. } =
            self;
        let dirty = if with_gain { SIGHT | GAIN } else { SIGHT };
        let slots = (
            flags.par_chunks_mut(beams),
            in_sight.par_chunks_mut(beams),
            horizon.par_chunks_mut(beams),
            gain.par_chunks_mut(beams),
        );
        slots.into_par_iter().enumerate().with_min_len(16).for_each_init(
            Scratch::default,
            |scratch, (view_point, (flags, in_sight, horizon, gain))| {
                if !wanted[view_point] || flags.iter().all(|f| f & dirty == 0) {
                    return;
                }
                let here = cells.bordered(view_point);
                for beam in (0..beams).filter(|b| flags[*b] & dirty != 0).collect::<Vec<_>>() {
                    let (cone, offsets) = (&stencil.beams[beam], &offsets[beam]);
                    let at = |i: usize| here.wrapping_add_signed(offsets.bordered[i]);
                    let rho = |i: usize| cells.reflection(at(i));
                    range_likelihood(cone, *uniform_share, rho, &mut scratch.likelihood);
                    let seen = scratch.likelihood.cells_in_sight(cone);
                    let is_reason = |i: usize| offsets.distance[i] <= cells.limit(at(i));
                    let reason = if (0..seen).any(is_reason) { REASON } else { 0 };
                    flags[beam] = flags[beam] & GAIN | reason;
                    in_sight[beam] = rank(seen);
                    horizon[beam] = rank(dependency(cone, &scratch.likelihood));
                    if with_gain && flags[beam] & GAIN != 0 {
                        gain[beam] = fast.beam_gain(cells, offsets, beam, view_point, scratch);
                        flags[beam] &= !GAIN;
                    }
                }
            },
        );
    }

    /// Whether a view-point, if it is up to date, holds a reason to measure in sight.
    pub(crate) fn has_reason(&self, view_point: usize) -> bool {
        self.slots(view_point).any(|slot| self.flags[slot] & REASON != 0)
    }

    /// E[I(l)] of a view-point that is up to date \[nats\].
    pub(crate) fn gain(&self, view_point: usize) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "few beams")]
        let beams = self.stencil.beams.len() as f64;
        self.slots(view_point).map(|slot| self.gain[slot]).sum::<f64>() / beams
    }

    /// V(l) of a view-point that is up to date: cells by their row-major index, with their
    /// distance from the sensor, in row-major order; a cell in two beams once, with the
    /// shorter distance.
    pub(crate) fn cells_in_sight(&self, view_point: usize) -> Vec<(usize, f32)> {
        let from = self.grid.cell(view_point);
        let mut seen = Vec::new();
        for (slot, (cone, offsets)) in
            self.slots(view_point).zip(self.stencil.beams.iter().zip(&self.offsets))
        {
            let in_sight = usize::from(self.in_sight[slot]);
            for (cell, distance) in cone.cells[..in_sight].iter().zip(&offsets.distance) {
                let index = self.grid.index(from.offset(cell.dx, cell.dy));
                seen.extend(index.map(|index| (index, *distance)));
            }
        }
        seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        seen.dedup_by_key(|(index, _)| *index);
        seen
    }

    fn slots(&self, view_point: usize) -> std::ops::Range<usize> {
        let beams = self.stencil.beams.len();
        view_point * beams..(view_point + 1) * beams
    }
}

#[allow(clippy::cast_possible_truncation, reason = "a planner refuses beams of more cells")]
fn rank(count: usize) -> u16 {
    count as u16
}

/// How many of a beam's cells decide its sight and its gain: those that may reflect, and
/// those that a possible outcome covers.
fn dependency(beam: &crate::BeamStencil, likelihood: &RangeLikelihood) -> usize {
    let traced = beam.rings[..likelihood.traced].iter().map(|ring| ring.end);
    let outcomes = (0..=likelihood.echo.len()).filter(|k| likelihood.probability(*k) > 0.0);
    traced.chain(outcomes.map(|k| beam.reach(k))).max().unwrap_or(0)
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
