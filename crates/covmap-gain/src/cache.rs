//! What each beam of each view-point sees and gains, kept until a scan changes it.

mod onlookers;
mod rows;

use crate::belief::Cells;
use crate::memory::{Size, whole};
use crate::product::bound::Potentials;
use crate::product::sweep::{Row, Sweep};
use crate::sight::{Ahead, Cone};
use crate::stencil::FARTHEST;
use crate::view_points::{groups, place};
use crate::{BeamError, RangePrediction, Stencil, ViewPoints};
use covmap::lanes::{LANES, Lanes};
use covmap::{Cell, CoverageMap, Grid};
use covmap_model::{Registers, SensorModel};
use onlookers::{Mark, Onlookers};
use pulp::Arch;
use rayon::prelude::*;
use rows::{Bounds, Likely, Sight, average, up_to_date};

/// The fast evaluation of E\[I\] is within this of the literal one, in units of the largest absolute
/// gain of the view-points that are compared.
pub const GAIN_TOLERANCE: f64 = 1e-5;

/// So many outcomes of beams of groups are looked at together, at most, if all are likely: bounds
/// the memory of their probabilities, 64 bytes each.
const PORTION: usize = 1 << 22;

/// So many rows of groups, or groups, are worked at by one thread at least: to wake another one
/// up takes longer than to look through them.
const ROWS: usize = 8;
const GROUPS: usize = 4096;

/// One beam of a group of view-points: which of them are up to date, bit by bit.
#[derive(Debug, Clone, Copy, Default)]
struct State {
    /// V(l) is.
    sight: u16,
    /// Whether there is a reason to measure in sight is.
    reason: u16,
    /// E\[I\] is.
    gain: u16,
    /// E\[I\] or an upper bound of it is.
    bound: u16,
    /// There is a reason to measure in sight.
    has_reason: u16,
    /// The values depend on the first so many cells of the beam.
    horizon: u16,
}

/// What is known of a group of view-points over all beams, bit by bit.
#[derive(Debug, Clone, Copy, Default)]
struct Group {
    /// Sight and reasons of all beams are up to date.
    sight: u16,
    /// The gains of all beams are up to date.
    gain: u16,
    /// The gains of all beams or upper bounds of them are.
    bound: u16,
    /// There is a reason to measure in sight of some beam.
    has_reason: u16,
}

/// Whether E\[I\] is kept up to date.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Upkeep {
    /// Gains and their bounds are kept from one question to the next.
    Kept,
    /// Gains are computed anew whenever they are asked for, and have no bounds: for who asks for
    /// few.
    OnDemand,
}

/// What every view-point sees, V(l), and is expected to gain, E\[I(l)\].
///
/// View-points are the centres of the cells of a grid, given by their row-major index; the ring of
/// sensors keeps its heading. The cache has a copy of the map, which [`update`](Self::update)
/// brings up to date cell by cell. A value depends on some of the nearest cells of its beams only:
/// when one of these changes it is stale, and computed again when it is next asked for, by one of
/// the `refresh` functions.
#[derive(Debug, Clone)]
pub struct GainCache {
    grid: Grid,
    stencil: Stencil,
    cells: Cells,
    upkeep: Upkeep,
    cones: Vec<Cone>,
    sweep: Sweep,
    /// Only of gains that are kept.
    potentials: Option<Potentials>,
    onlookers: Onlookers,
    groups: Vec<Group>,
    /// E\[I(l)\] or an upper bound of it, by group.
    mean: Vec<[f64; LANES]>,
    /// For each group for each beam.
    states: Vec<State>,
    /// How many cells of the beam are in sight: V(l) beam by beam.
    in_sight: Vec<[u16; LANES]>,
    /// E\[I\] of each, or an upper bound of it.
    gain: Vec<Lanes>,
    /// Which vector registers are used; all give the same bits.
    arch: Arch,
    /// A gain was met that is above its bound.
    exceeded: bool,
}

/// A gain may be above its bound by so much, by rounding.
const ROUNDING: f32 = 1e-5;

impl GainCache {
    /// A cache that knows nothing of the map yet. `heading` is the one that the ring keeps \[rad\].
    ///
    /// # Errors
    /// If a beam covers too many cells.
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
        let cells = Cells::new(grid, model.parameters().bins, &stencil, prediction);
        let count = grid.height() * groups(&grid);
        let units = count * stencil.beams.len();
        let cone = |beam| Cone::new(beam, &cells, prediction.uniform_share);
        Ok(Self {
            grid,
            upkeep,
            cones: stencil.beams.iter().map(cone).collect(),
            sweep: Sweep::new(model, &stencil, grid),
            potentials: (upkeep == Upkeep::Kept)
                .then(|| Potentials::new(model, &stencil, grid, &cells)),
            onlookers: Onlookers::new(&stencil, grid),
            stencil,
            cells,
            groups: vec![Group::default(); count],
            mean: vec![[0.0; LANES]; count],
            states: vec![State::default(); units],
            in_sight: vec![[0; LANES]; units],
            gain: vec![[0.0; LANES]; units],
            arch: Registers::Avx512.or_narrower(),
            exceeded: false,
        })
    }

    /// The cells around a view-point.
    pub fn stencil(&self) -> &Stencil {
        &self.stencil
    }

    /// About how many bytes a cache takes at most while it is made and asked, with its copy of the
    /// map: an estimate, mostly too large, to be asked for before there is one.
    pub fn bytes(model: &SensorModel, grid: &Grid, upkeep: Upkeep) -> u64 {
        // A stencil's cell with its weight, and as a cone's: capacities grow by doubling.
        const BY_STENCIL_CELL: f64 = 100.0;
        let size = Size::new(model, grid, upkeep);
        let stencil = BY_STENCIL_CELL * size.stencil;
        whole(stencil + Cells::bytes(&size) + Self::bytes_of_beams(&size))
    }

    fn bytes_of_beams(size: &Size) -> f64 {
        // A state, what is in sight, and a gain.
        const UNIT: f64 = 12.0 + 32.0 + 64.0;
        // Bits of a group, its means, and marks.
        const GROUP: f64 = 8.0 + 128.0 + 14.0;
        // Of a cell of a stencil who looks on, and its place and distance.
        const STENCIL: f64 = 24.0 + 12.0;
        let potentials = if size.upkeep == Upkeep::Kept { Potentials::bytes(size) } else { 0.0 };
        let own = size.blocks() * (GROUP + UNIT * size.beams) + STENCIL * size.stencil;
        own + potentials + Sweep::bytes(size)
    }

    /// Takes over a cell's posterior. Returns whether what it reflects, or whether it can change
    /// at all, is different now.
    pub fn update(&mut self, map: &CoverageMap, cell: Cell) -> bool {
        let Some(index) = self.grid.index(cell) else { return false };
        let reflects_anew = self.cells.update(map, cell);
        if reflects_anew {
            self.onlookers.mark(index, Mark::Sight);
        } else if self.upkeep == Upkeep::Kept {
            self.onlookers.mark(index, Mark::Gain);
        }
        reflects_anew
    }

    /// Sets up to which distance a cell is a reason to measure \[m\]: 0 if it is none, as all are
    /// to begin with.
    pub fn set_limit(&mut self, index: usize, limit: f32) {
        if self.cells.set_limit(index, limit) {
            self.onlookers.mark(index, Mark::Limit);
        }
    }

    /// Whether a cell is a reason to measure from so far away \[m\].
    pub fn is_reason(&self, index: usize, distance: f32) -> bool {
        self.cells.is_reason(self.cells.bordered(index), distance)
    }

    /// A cell's entropy \[nats\].
    pub fn entropy(&self, index: usize) -> f32 {
        self.cells.entropy(index)
    }

    /// Marks the gains of some groups of view-points, whatever changed.
    fn forget_gains(&mut self, wanted: &ViewPoints) {
        let beams = self.cones.len();
        let groups = self.groups.iter_mut().zip(self.states.chunks_mut(beams));
        let forgotten = groups.zip(wanted.groups()).filter(|(_, wanted)| **wanted != 0);
        for ((group, states), _) in forgotten {
            (group.gain, group.bound) = (0, 0);
            states.iter_mut().for_each(|s| (s.gain, s.bound) = (0, 0));
        }
    }

    /// Takes over what changed since the last time: forgets what depends on it, and brings up to
    /// date what is kept of the gains in the cells themselves.
    fn take_changes(&mut self) {
        let changed = self.cells.take_changed();
        let beams = self.cones.len();
        let Self { cells, onlookers, groups, states, sweep, potentials, arch, .. } = self;
        let forget_stale = || {
            onlookers.tell(|mark, group, beam, rank| {
                let state = &mut states[group * beams + beam];
                if rank < state.horizon {
                    forget(mark, &mut groups[group], state);
                }
            });
        };
        let evaluate_changed = || {
            sweep.basis.update(*arch, cells, &changed);
            if let Some(potentials) = potentials {
                potentials.update(*arch, cells, &changed);
            }
        };
        rayon::join(forget_stale, evaluate_changed);
    }

    /// Brings V(l), and whether it holds a reason to measure, up to date.
    pub fn refresh_sight(&mut self, wanted: &ViewPoints) {
        self.take_changes();
        let (per_row, beams) = (groups(&self.grid), self.cones.len());
        let rows = self
            .groups
            .par_chunks_mut(per_row)
            .zip(self.states.par_chunks_mut(per_row * beams))
            .zip(self.in_sight.par_chunks_mut(per_row * beams))
            .zip(wanted.groups().par_chunks(per_row))
            .enumerate()
            .with_min_len(ROWS);
        let (grid, cells, cones, arch) = (&self.grid, &self.cells, &self.cones, self.arch);
        rows.for_each_init(Ahead::new, |ahead, (y, (((groups, states), in_sight), wanted))| {
            if groups.iter().zip(wanted).any(|(group, wanted)| wanted & !group.sight != 0) {
                let here = cells.bordered(y * grid.width());
                arch.dispatch(Sight {
                    cones,
                    cells,
                    here,
                    wanted,
                    groups,
                    states,
                    in_sight,
                    ahead,
                });
            }
        });
    }

    /// Brings upper bounds of E\[I(l)\] up to date where the gains are not, and V(l). Where there
    /// are no bounds the gains themselves.
    pub fn refresh_bounds(&mut self, wanted: &ViewPoints) {
        if self.potentials.is_none() {
            return self.refresh_gains(wanted);
        }
        self.refresh_sight(wanted);
        let Some(potentials) = &self.potentials else { return };
        let (per_row, beams) = (groups(&self.grid), self.cones.len());
        let rows = self
            .groups
            .par_chunks_mut(per_row)
            .zip(self.states.par_chunks_mut(per_row * beams))
            .zip(self.gain.par_chunks_mut(per_row * beams))
            .zip(self.mean.par_chunks_mut(per_row))
            .zip(wanted.groups().par_chunks(per_row))
            .enumerate()
            .with_min_len(ROWS);
        let (grid, cells, cones, arch) = (&self.grid, &self.cells, &self.cones, self.arch);
        rows.for_each_init(Ahead::new, |ahead, (y, ((((groups, states), gain), mean), wanted))| {
            if groups.iter().zip(wanted).any(|(group, wanted)| wanted & !group.bound != 0) {
                let here = cells.bordered(y * grid.width());
                arch.dispatch(Bounds {
                    cones,
                    cells,
                    potentials,
                    here,
                    wanted,
                    groups,
                    states,
                    gain,
                    mean,
                    ahead,
                });
            }
        });
    }

    /// Whether a gain was met since this was last asked that is above its bound.
    pub fn take_exceeded(&mut self) -> bool {
        std::mem::take(&mut self.exceeded)
    }

    /// Whether E\[I(l)\] of a view-point is up to date, not only a bound of it.
    pub fn is_exact(&self, view_point: usize) -> bool {
        let (group, lane) = place(self.grid.width(), view_point);
        self.groups[group].gain >> lane & 1 == 1
    }

    /// Brings E\[I(l)\] up to date, and V(l).
    pub fn refresh_gains(&mut self, wanted: &ViewPoints) {
        if self.upkeep == Upkeep::OnDemand {
            self.forget_gains(wanted);
        }
        self.refresh_sight(wanted);
        let cells = &self.cells;
        let (per_row, beams) = (groups(&self.grid), self.cones.len());
        let stale = |(row, wanted): (usize, &[u16])| {
            let groups = &self.groups[row * per_row..(row + 1) * per_row];
            groups.iter().zip(wanted).any(|(group, wanted)| wanted & !group.gain != 0)
        };
        let rows: Vec<(usize, &[u16])> =
            wanted.groups().chunks(per_row).enumerate().filter(|row| stale(*row)).collect();
        let outcomes = self.cones.first().map_or(1, Cone::outcomes);
        let at_once = (PORTION / (per_row * beams * outcomes)).max(1);
        for rows in portions(&rows, at_once, at_once.max(self.sweep.border())) {
            let look = |ahead: &mut Ahead, (y, wanted): &(usize, &[u16])| {
                let here = cells.bordered(y * self.grid.width());
                let states = &self.states[y * per_row * beams..(y + 1) * per_row * beams];
                self.arch.dispatch(Likely {
                    cones: &self.cones,
                    cells,
                    here,
                    wanted,
                    states,
                    y: *y,
                    ahead,
                })
            };
            let rows: Vec<Row> = rows.par_iter().map_init(Ahead::new, look).collect();
            let gains = self.sweep.run(self.arch, cells, &rows);
            for (row, gains) in rows.iter().zip(gains) {
                for (unit, gains) in row.units.iter().zip(gains) {
                    let group = row.y * per_row + unit.group;
                    let at = group * beams + unit.beam;
                    let wanted = wanted.groups()[group];
                    let state = &mut self.states[at];
                    let bounded = state.bound & !state.gain;
                    for lane in (0..LANES).filter(|lane| wanted >> lane & 1 == 1) {
                        #[allow(clippy::cast_possible_truncation, reason = "kept as f32 for size")]
                        let (gain, kept) = (gains[lane] as f32, &mut self.gain[at][lane]);
                        let is_bounded = bounded >> lane & 1 == 1;
                        self.exceeded |= is_bounded && gain > *kept + ROUNDING * (1.0 + kept.abs());
                        *kept = gain;
                    }
                    (state.gain, state.bound) = (state.gain | wanted, state.bound | wanted);
                }
            }
        }
        let averages = self
            .mean
            .par_iter_mut()
            .zip(&mut self.groups)
            .zip(self.gain.par_chunks(beams))
            .zip(self.states.par_chunks(beams))
            .zip(wanted.groups())
            .with_min_len(GROUPS);
        averages.for_each(|((((mean, group), gains), states), wanted)| {
            if wanted & !group.gain != 0 {
                *mean = average(gains);
                (group.gain, group.bound) = up_to_date(states);
            }
        });
    }

    /// Those of some view-points that are up to date which hold a reason to measure in sight, in
    /// order.
    pub fn with_reason(&self, view_points: &ViewPoints) -> Vec<usize> {
        view_points.indices(|group| self.groups[group].has_reason)
    }

    /// Whether a view-point that is up to date holds a reason to measure in sight.
    pub fn has_reason(&self, view_point: usize) -> bool {
        let (group, lane) = place(self.grid.width(), view_point);
        self.groups[group].has_reason >> lane & 1 == 1
    }

    /// E\[I(l)\] of a view-point that is up to date, or an upper bound \[nats\].
    pub fn gain(&self, view_point: usize) -> f64 {
        let (group, lane) = place(self.grid.width(), view_point);
        self.mean[group][lane]
    }

    /// V(l) of a view-point that is up to date: cells by their row-major index, with their
    /// distance from the sensor, in row-major order; a cell in two beams once, with the
    /// shorter distance.
    pub fn cells_in_sight(&self, view_point: usize) -> Vec<(usize, f32)> {
        let mut seen: Vec<(usize, f32)> = self.sights(view_point).collect();
        seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        seen.dedup_by_key(|(index, _)| *index);
        seen
    }

    /// Whether a view-point that is up to date holds a cell in sight that `is_wanted`, by its
    /// row-major index and its distance from the sensor.
    pub fn sees(&self, view_point: usize, is_wanted: impl Fn(&(usize, f32)) -> bool) -> bool {
        self.sights(view_point).any(|cell| is_wanted(&cell))
    }

    /// The cells in sight of a view-point, beam by beam.
    fn sights(&self, view_point: usize) -> impl Iterator<Item = (usize, f32)> {
        let from = self.grid.cell(view_point);
        let (group, lane) = place(self.grid.width(), view_point);
        let in_sight = &self.in_sight[group * self.cones.len()..];
        self.cones.iter().zip(in_sight).flat_map(move |(cone, in_sight)| {
            cone.cells(in_sight[lane]).filter_map(move |(cell, distance)| {
                Some((self.grid.index(from.offset(cell.dx, cell.dy))?, distance))
            })
        })
    }
}

/// Forgets what a change makes stale of a beam and its group.
fn forget(mark: Mark, group: &mut Group, state: &mut State) {
    match mark {
        Mark::Sight => {
            (state.sight, state.reason, state.gain, state.bound) = (0, 0, 0, 0);
            *group = Group { has_reason: group.has_reason, ..Group::default() };
        }
        Mark::Gain => (state.gain, state.bound, group.gain, group.bound) = (0, 0, 0, 0),
        Mark::Limit => (state.reason, group.sight) = (0, 0),
    }
}

/// Cuts rows of view-points, by their y, in portions of at most so many that span at most so many
/// rows of the grid: what is computed for the cells around a portion needs memory for all of them.
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
