//! From where a cell can be seen: whose values a change of the cell makes stale.

use crate::Stencil;
use crate::view_points::{groups, place};
use covmap::Grid;
use covmap::lanes::LANES;

/// Neighbouring view-points of a row that hold a cell in the same beam: their places from the
/// cell, and the least rank that it has in the beam's order of distance.
#[derive(Debug, Clone, Copy)]
struct Run {
    dy: i32,
    first: i32,
    last: i32,
    beam: usize,
    rank: u16,
}

/// The longest run: ranks differ little within it.
const LONGEST: i32 = 6;

/// What about a cell changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    /// What it reflects, or whether it can change.
    Sight,
    /// Its posterior.
    Gain,
    /// The distance up to which it is a reason to measure.
    Limit,
}

/// All marks, in the order of their kinds.
const MARKS: [Mark; 3] = [Mark::Sight, Mark::Gain, Mark::Limit];

/// The cells that changed, in blocks of neighbours, until their onlookers are told.
#[derive(Debug, Clone)]
pub(crate) struct Onlookers {
    grid: Grid,
    runs: Vec<Run>,
    marked: Vec<[u16; MARKS.len()]>,
    /// The blocks with a mark.
    touched: Vec<usize>,
}

impl Onlookers {
    pub(crate) fn new(stencil: &Stencil, grid: Grid) -> Self {
        let runs = stencil.beams.iter().enumerate().flat_map(|(beam, cone)| {
            let mut places: Vec<(i32, i32, u16)> =
                (0u16..).zip(&cone.cells).map(|(rank, cell)| (-cell.dy, -cell.dx, rank)).collect();
            places.sort_unstable();
            let mut runs: Vec<Run> = Vec::new();
            for (dy, dx, rank) in places {
                match runs.last_mut() {
                    Some(run) if run.dy == dy && run.last + 1 == dx && dx - run.first < LONGEST => {
                        (run.last, run.rank) = (dx, run.rank.min(rank));
                    }
                    _ => runs.push(Run { dy, first: dx, last: dx, beam, rank }),
                }
            }
            runs
        });
        Self {
            grid,
            runs: runs.collect(),
            marked: vec![[0; MARKS.len()]; grid.height() * groups(&grid)],
            touched: Vec::new(),
        }
    }

    /// Takes note of a change of a cell, by its row-major index.
    pub(crate) fn mark(&mut self, index: usize, mark: Mark) {
        let (block, lane) = place(self.grid.width(), index);
        if self.marked[block] == [0; MARKS.len()] {
            self.touched.push(block);
        }
        self.marked[block][mark as usize] |= 1 << lane;
    }

    /// Tells of every (group of view-points, beam) that can see what was marked, and forgets
    /// the marks. `tell` is told the group, the beam, and a rank that the cells have at least.
    pub(crate) fn tell(&mut self, mut tell: impl FnMut(Mark, usize, usize, u16)) {
        let per_row = groups(&self.grid);
        let lanes = i32::from(u8::try_from(LANES).unwrap_or(0));
        let signed = |n: usize| i32::try_from(n).unwrap_or(i32::MAX);
        for block in self.touched.drain(..) {
            let (x, y) = (signed(block % per_row) * lanes, signed(block / per_row));
            let marked = std::mem::take(&mut self.marked[block]);
            for (mark, bits) in MARKS.into_iter().zip(marked).filter(|(_, bits)| *bits != 0) {
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
                        #[allow(clippy::cast_sign_loss, reason = "inside of the grid")]
                        let group = y as usize * per_row + group as usize;
                        tell(mark, group, run.beam, run.rank);
                    }
                }
            }
        }
    }
}
