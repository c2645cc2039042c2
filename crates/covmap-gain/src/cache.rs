//! Sight and gains of each beam of each view-point, kept until a change of the map makes them
//! stale.

mod answers;
mod rows;
mod staleness;

use crate::belief::Belief;
use crate::evaluator::Evaluator;
use crate::largest::Largest;
use crate::memory::{Size, whole};
use crate::outcomes::{AskedRow, BeamAnswer, RowGains};
use crate::sight::{GroupLikelihood, RasterBeam};
use crate::stencil::FARTHEST;
use crate::view_points::{group_and_lane, groups_per_row};
use crate::{BeamError, InformationGain, RangePrediction, Stencil, Upkeep, ViewPoints};
use covmap::lanes::LANES;
use covmap::{Cell, CoverageMap, Grid};
use covmap_model::{ModelParameters, Registers, SensorModel};
use pulp::Arch;
use rayon::prelude::*;
use rows::{AskOutcomes, RefreshBounds, RefreshSight, average, up_to_date};
use staleness::{BeamState, CellChange, GroupState, Onlookers};

/// Largest difference of the fast evaluation of E\[I\] from the literal one, in units of the
/// largest absolute gain of the view-points that are compared.
pub const GAIN_TOLERANCE: f64 = 1e-5;

/// The largest number of outcomes of beams of groups that are evaluated together, if all are
/// likely. It bounds the memory of their probabilities, 64 bytes each.
const OUTCOMES_TOGETHER: usize = 1 << 22;

/// The smallest numbers of rows of groups, and of groups, for one thread: waking another one takes
/// longer than working through them.
const ROWS_PER_THREAD: usize = 8;
const GROUPS_PER_THREAD: usize = 4096;

/// Largest excess of a gain over its bound by rounding.
const ROUNDING: f32 = 1e-5;

/// Sight V(l) and expected gain E\[I(l)\] of every view-point.
///
/// View-points are the centres of the cells of a grid, and are given by their row-major index; the
/// ring of sensors keeps its heading. The cache has a copy of the map, which
/// [`update`](Self::update) brings up to date cell by cell. A value depends only on some of the
/// nearest cells of its beams: a change of one of these makes the value stale, and one of the
/// `refresh` functions computes it again when it is next asked for. All other functions return the
/// values of the last refresh: the caller refreshes those that it needs after a change.
#[derive(Debug, Clone)]
pub struct GainCache {
    grid: Grid,
    stencil: Stencil,
    upkeep: Upkeep,
    belief: Belief,
    evaluator: Evaluator,
    onlookers: Onlookers,
    /// The stencil's beams.
    beams: Vec<RasterBeam>,
    /// By group, like `mean_gain`.
    groups: Vec<GroupState>,
    /// E\[I(l)\] or an upper bound of it: the average over the beams.
    mean_gain: Vec<[f64; LANES]>,
    /// By group and beam, like `in_sight` and `answers`.
    states: Vec<BeamState>,
    /// V(l): number of cells of the beam in sight.
    in_sight: Vec<[u16; LANES]>,
    /// Expected gain of the beam, or upper bounds of it.
    answers: Vec<BeamAnswer>,
    /// Vector registers; all kinds give the same bits.
    arch: Arch,
    /// Whether a gain was above its bound.
    exceeded: bool,
    /// Least expected gain of a cell that counts for a promise.
    least_change: f32,
}

impl GainCache {
    /// Creates a cache of an unknown map. `heading` is the one that the ring keeps \[rad\].
    ///
    /// # Errors
    /// If a beam reaches too far or covers too many cells, or if the update cannot predict the
    /// gain.
    pub fn new(
        model: &SensorModel,
        heading: f64,
        grid: Grid,
        prediction: RangePrediction,
        upkeep: Upkeep,
    ) -> Result<Self, BeamError> {
        let reach = model.max_reach() / model.resolution();
        if reach > FARTHEST {
            return Err(BeamError::TooLong(reach));
        }
        let stencil = Stencil::new(model, heading);
        let most = stencil.beams.iter().map(|b| b.cells.len()).max().unwrap_or(0);
        if most >= usize::from(u16::MAX) {
            return Err(BeamError::TooFine(most));
        }
        let ModelParameters { bins, update, .. } = model.parameters();
        let unknown = update.cause().map(|cause| cause.unknown_coverage);
        if prediction.gain == InformationGain::MutualInformation && unknown.is_none() {
            return Err(BeamError::NoPrediction);
        }
        let belief = Belief::new(grid, *bins, &stencil, prediction, unknown.unwrap_or(0.0));
        let groups = grid.height() * groups_per_row(&grid);
        let group_beams = groups * stencil.beams.len();
        let beam = |beam| RasterBeam::new(beam, &belief, prediction.uniform_share);
        let evaluator = Evaluator::new(model, &stencil, grid, &belief, (prediction.gain, upkeep));
        Ok(Self {
            grid,
            upkeep,
            beams: stencil.beams.iter().map(beam).collect(),
            evaluator,
            onlookers: Onlookers::new(&stencil, grid),
            stencil,
            belief,
            groups: vec![GroupState::default(); groups],
            mean_gain: vec![[0.0; LANES]; groups],
            states: vec![BeamState::default(); group_beams],
            in_sight: vec![[0; LANES]; group_beams],
            answers: vec![BeamAnswer::all(0.0, 0.0); group_beams],
            arch: Registers::Avx512.or_narrower(),
            exceeded: false,
            least_change: 0.0,
        })
    }

    /// Sets the least expected fall of a cell's entropy \[nats\] that counts for a
    /// [promise](Self::promise).
    #[must_use]
    pub fn with_least_change(self, least: f64) -> Self {
        Self { least_change: crate::numbers::to_f32(least), ..self }
    }

    /// Estimates the bytes that a cache takes at most while it is made and asked, with its copy of
    /// the map.
    ///
    /// The estimate is mostly too high, and needs no cache.
    pub fn bytes(model: &SensorModel, grid: &Grid, upkeep: Upkeep) -> u64 {
        // A state, what is in sight, a gain and a promise.
        const GROUP_BEAM: f64 = 12.0 + 32.0 + 64.0 + 64.0;
        // A state, mean gains, and marks.
        const GROUP: f64 = 8.0 + 128.0 + 14.0;
        // A stencil's cell with its weight, and as a raster beam's: capacities grow by doubling.
        // Its onlookers, its offset in the planes of a sweep, and in rasters.
        const STENCIL_CELL: f64 = 100.0 + 24.0 + 12.0;
        let size = Size::new(model, grid, upkeep);
        let groups = size.blocks() * (GROUP + GROUP_BEAM * size.beams);
        let own = groups + STENCIL_CELL * size.stencil;
        whole(own + Belief::bytes(&size) + Evaluator::bytes(&size))
    }

    /// Takes over a cell's posterior. Returns whether the cell's reflection, or its ability to
    /// change, is different now.
    pub fn update(&mut self, map: &CoverageMap, cell: Cell) -> bool {
        let Some(index) = self.grid.index(cell) else { return false };
        let reflects_anew = self.belief.update(map, cell);
        if reflects_anew {
            self.onlookers.mark(index, CellChange::Reflection);
        } else if self.upkeep == Upkeep::Kept {
            self.onlookers.mark(index, CellChange::Posterior);
        }
        reflects_anew
    }

    /// Sets the distance up to which a cell is a reason to measure \[m\]. At first it is 0 for all
    /// cells: none is a reason.
    pub fn set_limit(&mut self, index: usize, limit: f32) {
        if self.belief.set_limit(index, limit) {
            self.onlookers.mark(index, CellChange::Limit);
        }
    }

    /// Sets the novelty of a reading from a view-point, in \[0, 1\]; at first it is 1.
    pub fn set_novelty(&mut self, view_point: usize, novelty: f64) {
        let (width, novelty) = (self.grid.width(), crate::numbers::to_f32(novelty));
        self.evaluator.set_novelty((view_point / width, view_point % width), novelty);
        let (group, lane) = group_and_lane(width, view_point);
        let (count, others) = (self.beams.len(), !(1 << lane));
        self.groups[group].keep_gains(others);
        let states = &mut self.states[group * count..(group + 1) * count];
        states.iter_mut().for_each(|state| state.keep_gains(others));
    }

    /// Brings V(l), and whether it holds a reason to measure, up to date for some view-points.
    pub fn refresh_sight(&mut self, wanted: &ViewPoints) {
        self.take_changes();
        let (per_row, beams) = (groups_per_row(&self.grid), self.beams.len());
        let rows = self
            .groups
            .par_chunks_mut(per_row)
            .zip(self.states.par_chunks_mut(per_row * beams))
            .zip(self.in_sight.par_chunks_mut(per_row * beams))
            .zip(wanted.groups().par_chunks(per_row))
            .enumerate()
            .with_min_len(ROWS_PER_THREAD);
        let (width, belief, beams, arch) =
            (self.grid.width(), &self.belief, &self.beams, self.arch);
        let new = GroupLikelihood::new;
        rows.for_each_init(new, |likelihood, (y, (((groups, states), in_sight), wanted))| {
            if groups.iter().zip(wanted).any(|(group, wanted)| wanted & !group.sight != 0) {
                let here = belief.bordered(y * width);
                arch.dispatch(RefreshSight {
                    beams,
                    belief,
                    here,
                    wanted,
                    groups,
                    states,
                    in_sight,
                    likelihood,
                });
            }
        });
    }

    /// Brings V(l) of some view-points up to date, and upper bounds of E\[I(l)\] where gains are
    /// stale.
    ///
    /// Without bounds it refreshes the gains themselves.
    pub fn refresh_bounds(&mut self, wanted: &ViewPoints) {
        if !self.evaluator.has_bound() {
            return self.refresh_gains(wanted);
        }
        self.refresh_sight(wanted);
        let (per_row, beams) = (groups_per_row(&self.grid), self.beams.len());
        let rows = self
            .groups
            .par_chunks_mut(per_row)
            .zip(self.states.par_chunks_mut(per_row * beams))
            .zip(self.answers.par_chunks_mut(per_row * beams))
            .zip(self.mean_gain.par_chunks_mut(per_row))
            .zip(wanted.groups().par_chunks(per_row))
            .enumerate()
            .with_min_len(ROWS_PER_THREAD);
        let (width, arch) = (self.grid.width(), self.arch);
        let (beams, belief, evaluator) = (&self.beams, &self.belief, &self.evaluator);
        let new = GroupLikelihood::new;
        rows.for_each_init(
            new,
            |likelihood, (y, ((((groups, states), answers), mean), wanted))| {
                if groups.iter().zip(wanted).any(|(group, wanted)| wanted & !group.bound != 0) {
                    let here = belief.bordered(y * width);
                    arch.dispatch(RefreshBounds {
                        beams,
                        belief,
                        evaluator,
                        here,
                        wanted,
                        groups,
                        states,
                        answers,
                        mean,
                        likelihood,
                    });
                }
            },
        );
    }

    /// Brings E\[I(l)\] and V(l) of some view-points up to date.
    pub fn refresh_gains(&mut self, wanted: &ViewPoints) {
        if self.upkeep == Upkeep::OnDemand {
            self.forget_gains(wanted);
        }
        self.refresh_sight(wanted);
        let (per_row, beams) = (groups_per_row(&self.grid), self.beams.len());
        let is_stale = |(row, wanted): (usize, &[u16])| {
            let groups = &self.groups[row * per_row..(row + 1) * per_row];
            groups.iter().zip(wanted).any(|(group, wanted)| wanted & !group.gain != 0)
        };
        let rows: Vec<(usize, &[u16])> =
            wanted.groups().chunks(per_row).enumerate().filter(|row| is_stale(*row)).collect();
        let most = self.rows_together();
        for rows in portions(&rows, most, most.max(self.evaluator.border())) {
            let ask = |likelihood: &mut GroupLikelihood, (y, wanted): &(usize, &[u16])| {
                self.arch.dispatch(AskOutcomes {
                    beams: &self.beams,
                    belief: &self.belief,
                    here: self.belief.bordered(y * self.grid.width()),
                    wanted,
                    states: &self.states[y * per_row * beams..(y + 1) * per_row * beams],
                    y: *y,
                    likelihood,
                })
            };
            let asked: Vec<AskedRow> =
                rows.par_iter().map_init(GroupLikelihood::new, ask).collect();
            let gains = self.evaluator.gains(self.arch, &self.belief, &asked, self.least_change);
            for ((row, gains), (_, wanted)) in asked.iter().zip(gains).zip(rows) {
                self.keep_gains(row, gains, wanted);
            }
        }
        let averages = self
            .mean_gain
            .par_iter_mut()
            .zip(&mut self.groups)
            .zip(self.answers.par_chunks(beams))
            .zip(self.states.par_chunks(beams))
            .zip(wanted.groups())
            .with_min_len(GROUPS_PER_THREAD);
        averages.for_each(|((((mean, group), answers), states), wanted)| {
            if wanted & !group.gain != 0 {
                *mean = average(answers);
                up_to_date(group, states);
            }
        });
    }

    /// Returns the largest expected fall of every cell's entropy from some view-points \[nats\].
    ///
    /// For each cell, by its row-major index, the result has the largest fall by one of the beams
    /// and its view-point, the first of several. It is `None` for cells that no beam covers, and
    /// for all cells with the product of Eq. (9), whose evaluation does not tell the cells apart.
    pub fn largest_changes(&mut self, view_points: &ViewPoints) -> Vec<Option<(f64, usize)>> {
        if !self.tells_cells_apart() {
            return vec![None; self.grid.len()];
        }
        self.refresh_sight(view_points);
        let (per_row, beams) = (groups_per_row(&self.grid), self.beams.len());
        let stale = vec![BeamState::default(); per_row * beams];
        let ask = |likelihood: &mut GroupLikelihood, (y, wanted)| {
            let row = self.arch.dispatch(AskOutcomes {
                beams: &self.beams,
                belief: &self.belief,
                here: self.belief.bordered(y * self.grid.width()),
                wanted,
                states: &stale,
                y,
                likelihood,
            });
            (row, wanted)
        };
        let is_wanted = |(_, wanted): &(usize, &[u16])| wanted.iter().any(|wanted| *wanted != 0);
        let rows: Vec<(usize, &[u16])> =
            view_points.groups().chunks(per_row).enumerate().filter(is_wanted).collect();
        let mut largest = Largest::new(self.grid.len());
        for rows in rows.chunks(self.rows_together()) {
            let rows = rows.par_iter().copied();
            let asked: Vec<_> = rows.map_init(GroupLikelihood::new, ask).collect();
            let found = self.evaluator.largest_changes(self.arch, &self.belief, &asked);
            largest = found.into_iter().fold(largest, Largest::merged);
        }
        largest.into_cells()
    }

    /// Returns the number of rows of view-points that are evaluated together.
    fn rows_together(&self) -> usize {
        let outcomes = self.beams.first().map_or(1, RasterBeam::outcomes);
        let of_row = groups_per_row(&self.grid) * self.beams.len() * outcomes;
        (OUTCOMES_TOGETHER / of_row).max(1)
    }

    /// Takes over the changes since the last call: makes the values that depend on them stale, and
    /// brings the values that the evaluator keeps of every cell up to date.
    fn take_changes(&mut self) {
        let changed = self.belief.take_changed();
        let (arch, beams) = (self.arch, self.beams.len());
        let Self { belief, onlookers, groups, states, evaluator, .. } = self;
        rayon::join(
            || onlookers.tell(beams, groups, states),
            || evaluator.update(arch, belief, &changed),
        );
    }

    /// Makes the gains of some groups of view-points stale, whatever changed.
    fn forget_gains(&mut self, wanted: &ViewPoints) {
        let groups = self.groups.iter_mut().zip(self.states.chunks_mut(self.beams.len()));
        let forgotten = groups.zip(wanted.groups()).filter(|(_, wanted)| **wanted != 0);
        for ((group, states), _) in forgotten {
            group.keep_gains(0);
            states.iter_mut().for_each(|state| state.keep_gains(0));
        }
    }

    /// Keeps the evaluated gains of a row for the wanted view-points, and notes if one of them is
    /// above its bound.
    fn keep_gains(&mut self, row: &AskedRow, gains: RowGains, wanted: &[u16]) {
        let (per_row, beams) = (groups_per_row(&self.grid), self.beams.len());
        for (asked, answer) in row.beams.iter().zip(gains) {
            let wanted = wanted[asked.group];
            let at = (row.y * per_row + asked.group) * beams + asked.beam;
            let state = &mut self.states[at];
            let bounded = state.bound & !state.gain;
            let kept = &mut self.answers[at];
            for lane in (0..LANES).filter(|lane| wanted >> lane & 1 == 1) {
                let is_above =
                    |value: f32, bound: f32| value > bound + ROUNDING * (1.0 + bound.abs());
                self.exceeded |= bounded >> lane & 1 == 1
                    && (is_above(answer.gain[lane], kept.gain[lane])
                        || is_above(answer.promise[lane], kept.promise[lane]));
                kept.gain[lane] = answer.gain[lane];
                kept.promise[lane] = answer.promise[lane];
            }
            (state.gain, state.bound) = (state.gain | wanted, state.bound | wanted);
        }
    }
}

/// Cuts rows of view-points, by their y, into portions of at most `most` that span at most `span`
/// rows of the grid, because the values of the cells around a portion take memory for all of these
/// rows.
fn portions<T>(rows: &[(usize, T)], most: usize, span: usize) -> Vec<&[(usize, T)]> {
    let mut portions = Vec::new();
    let mut rest = rows;
    while let Some((first, _)) = rest.first() {
        let near = rest.partition_point(|(y, _)| y - first < span);
        let (portion, later) = rest.split_at(near.min(most));
        portions.push(portion);
        rest = later;
    }
    portions
}

#[cfg(test)]
mod tests;
