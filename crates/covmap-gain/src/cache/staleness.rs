//! The state of cached values, and the values that a change of a cell makes stale.
//!
//! The values of a (group of view-points, beam) depend on the first cells of the beam, in the
//! beam's order of distance, up to its [`horizon`](BeamState::horizon). A change of a cell is
//! *marked*, and told to its onlookers when values are next asked for: to every (group, beam) that
//! has the cell in its stencil. An onlooker forgets the values that depend on the cell if the cell
//! lies within its horizon.

use crate::Stencil;
use crate::view_points::{group_and_lane, groups_per_row};
use covmap::Grid;
use covmap::lanes::LANES;

/// Kind of a change of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CellChange {
    /// Its reflection, or its ability to change.
    Reflection,
    /// Only its posterior.
    Posterior,
    /// The distance up to which it is a reason to measure.
    Limit,
}

impl CellChange {
    /// All kinds, in the order of their numbers.
    const ALL: [Self; 3] = [Self::Reflection, Self::Posterior, Self::Limit];
}

/// State of one beam of a group of view-points, a bit for each.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BeamState {
    /// V(l) is up to date.
    pub(super) sight: u16,
    /// `has_reason` is up to date.
    pub(super) reason: u16,
    /// E\[I\] is up to date.
    pub(super) gain: u16,
    /// E\[I\] or an upper bound of it is up to date.
    pub(super) bound: u16,
    /// There is a reason to measure in sight.
    pub(super) has_reason: u16,
    /// The number of nearest cells of the beam on which the values depend.
    pub(super) horizon: u16,
}

/// State of a group of view-points over all beams, a bit for each.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct GroupState {
    /// Sight and reasons of all beams are up to date.
    pub(super) sight: u16,
    /// The gains of all beams are up to date.
    pub(super) gain: u16,
    /// The gains of all beams or upper bounds of them are up to date.
    pub(super) bound: u16,
    /// There is a reason to measure in sight of some beam.
    pub(super) has_reason: u16,
}

impl BeamState {
    /// Forgets the values that a change within the horizon makes stale.
    fn forget(&mut self, change: CellChange) {
        match change {
            CellChange::Reflection => {
                (self.sight, self.reason, self.gain, self.bound) = (0, 0, 0, 0);
            }
            CellChange::Posterior => self.keep_gains(0),
            CellChange::Limit => (self.reason, self.gain, self.bound) = (0, 0, 0),
        }
    }

    /// Forgets gain and bound of all but some view-points.
    pub(super) fn keep_gains(&mut self, some: u16) {
        (self.gain, self.bound) = (self.gain & some, self.bound & some);
    }
}

impl GroupState {
    fn forget(&mut self, change: CellChange) {
        match change {
            CellChange::Reflection => (self.sight, self.gain, self.bound) = (0, 0, 0),
            CellChange::Posterior => self.keep_gains(0),
            CellChange::Limit => (self.sight, self.gain, self.bound) = (0, 0, 0),
        }
    }

    /// Forgets gain and bound of all but some view-points.
    pub(super) fn keep_gains(&mut self, some: u16) {
        (self.gain, self.bound) = (self.gain & some, self.bound & some);
    }
}

/// Neighbouring view-points of a row that have a cell in the same beam: their places from the cell,
/// and the cell's least rank in the beam's order of distance.
#[derive(Debug, Clone, Copy)]
struct OnlookerRun {
    dy: i32,
    first: i32,
    last: i32,
    beam: usize,
    rank: u16,
}

/// Length of the longest run: ranks differ little within it.
const LONGEST: i32 = 6;

/// The onlookers of a cell, and the changes that they were not told yet.
#[derive(Debug, Clone)]
pub(super) struct Onlookers {
    grid: Grid,
    /// Onlookers of any cell: a stencil, seen the other way round.
    runs: Vec<OnlookerRun>,
    /// For each block of cells, for each kind of change, a bit for each lane.
    marked: Vec<[u16; CellChange::ALL.len()]>,
    /// The blocks with a mark.
    touched: Vec<usize>,
}

impl Onlookers {
    pub(super) fn new(stencil: &Stencil, grid: Grid) -> Self {
        let runs = stencil.beams.iter().enumerate().flat_map(|(beam, cone)| {
            let mut places: Vec<(i32, i32, u16)> =
                (0u16..).zip(&cone.cells).map(|(rank, cell)| (-cell.dy, -cell.dx, rank)).collect();
            places.sort_unstable();
            let mut runs: Vec<OnlookerRun> = Vec::new();
            for (dy, dx, rank) in places {
                match runs.last_mut() {
                    Some(run) if run.dy == dy && run.last + 1 == dx && dx - run.first < LONGEST => {
                        (run.last, run.rank) = (dx, run.rank.min(rank));
                    }
                    _ => runs.push(OnlookerRun { dy, first: dx, last: dx, beam, rank }),
                }
            }
            runs
        });
        Self {
            grid,
            runs: runs.collect(),
            marked: vec![[0; CellChange::ALL.len()]; grid.height() * groups_per_row(&grid)],
            touched: Vec::new(),
        }
    }

    /// Marks a change of a cell, by its row-major index.
    pub(super) fn mark(&mut self, index: usize, change: CellChange) {
        let (block, lane) = group_and_lane(self.grid.width(), index);
        if self.marked[block] == [0; CellChange::ALL.len()] {
            self.touched.push(block);
        }
        self.marked[block][change as usize] |= 1 << lane;
    }

    /// Makes the values that depend on marked cells stale, and clears the marks. `groups` has a
    /// state for each group, and `states` has one for each beam of each group.
    pub(super) fn tell(
        &mut self,
        beams: usize,
        groups: &mut [GroupState],
        states: &mut [BeamState],
    ) {
        self.for_each_onlooker(|change, group, beam, rank| {
            let state = &mut states[group * beams + beam];
            if rank < state.horizon {
                state.forget(change);
                groups[group].forget(change);
            }
        });
    }

    /// Visits every change, with the group and the beam of an onlooker, and the least rank that the
    /// changed cells of a block can have. Clears the marks.
    fn for_each_onlooker(&mut self, mut tell: impl FnMut(CellChange, usize, usize, u16)) {
        let per_row = groups_per_row(&self.grid);
        let lanes = i32::from(u8::try_from(LANES).unwrap_or(0));
        let signed = |n: usize| i32::try_from(n).unwrap_or(i32::MAX);
        for block in self.touched.drain(..) {
            let (x, y) = (signed(block % per_row) * lanes, signed(block / per_row));
            let marked = std::mem::take(&mut self.marked[block]);
            let marked = CellChange::ALL.into_iter().zip(marked);
            for (change, bits) in marked.filter(|(_, bits)| *bits != 0) {
                let low = x + bits.trailing_zeros().cast_signed();
                let high = x + 15 - bits.leading_zeros().cast_signed();
                for run in &self.runs {
                    let y = y + run.dy;
                    if y < 0 || y >= signed(self.grid.height()) {
                        continue;
                    }
                    let first = (low + run.first).div_euclid(lanes).max(0);
                    let last = (high + run.last).div_euclid(lanes).min(signed(per_row) - 1);
                    for group in first..=last {
                        let group = y as usize * per_row + group as usize;
                        tell(change, group, run.beam, run.rank);
                    }
                }
            }
        }
    }
}
