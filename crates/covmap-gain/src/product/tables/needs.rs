//! The readings of a ring that the outcomes of a beam need in each cell.

use super::rings::{CellReadings, DistanceRing, OutcomeReadings, OwnReading};
use crate::{Stencil, StencilCell};
use covmap::lanes::LANES;
use std::ops::{Range, RangeInclusive};

/// A run of cells of a row that are no farther apart than a block: row, first and last column from
/// a view-point, and the ring's readings that any of them needs, bit by bit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NeededRun {
    pub(crate) dy: isize,
    first: isize,
    last: isize,
    pub(crate) readings: u64,
}

/// Returns the bit of a reading: with more than 64 several share one.
#[inline(always)]
fn bit(reading: usize) -> u64 {
    1 << (reading % 64)
}

/// Needs of a ring's outcomes: some readings of all cells of a beam, or its own of each cell.
#[derive(Debug, Clone)]
pub(crate) struct RingNeeds {
    /// For each beam all its cells.
    pub(crate) cells: Vec<Vec<NeededRun>>,
    /// The readings of all outcomes beyond the ring together.
    pub(crate) beyond: u64,
    /// For each outcome near the ring, in its order.
    pub(crate) near: Vec<OutcomeNeeds>,
    /// The readings of no echo.
    pub(crate) no_echo: u64,
}

/// Needs of one outcome.
#[derive(Debug, Clone)]
pub(crate) struct OutcomeNeeds {
    /// The readings of all cells of a beam, bit by bit.
    pub(crate) of_all: u64,
    /// For each beam the cells with readings of their own; empty if there are none.
    pub(crate) own: Vec<Vec<NeededRun>>,
}

impl RingNeeds {
    /// Finds the needs of each outcome of a ring.
    pub(crate) fn new(ring: &DistanceRing, stencil: &Stencil) -> Self {
        let cells = |beam: usize| &stencil.beams[beam].cells[ring.cells[beam].clone()];
        let bits = |readings: Range<usize>| readings.fold(0, |bits, reading| bits | bit(reading));
        let of_outcome = |of: &OutcomeReadings| match &of.cells {
            CellReadings::Weighted(_) => {
                OutcomeNeeds { of_all: bits(of.first..of.first + of.count), own: Vec::new() }
            }
            CellReadings::Own(own) => {
                let needed = |(beam, own): (usize, &Vec<OwnReading>)| {
                    let of_cell =
                        |own: &OwnReading| (&cells(beam)[own.cell], bit(of.first + own.reading));
                    runs(own.iter().map(of_cell))
                };
                OutcomeNeeds { of_all: 0, own: own.iter().enumerate().map(needed).collect() }
            }
        };
        let all = |beam| runs(cells(beam).iter().map(|cell| (cell, 0)));
        Self {
            cells: (0..stencil.beams.len()).map(all).collect(),
            beyond: ring.beyond.as_ref().map_or(0, |b| bits(b.first..b.first + b.count)),
            near: ring.near.iter().map(|(_, of)| of_outcome(of)).collect(),
            no_echo: ring.no_echo.as_ref().map_or(0, |of| of_outcome(of).of_all),
        }
    }
}

impl NeededRun {
    /// Returns the blocks of cells that hold the run, seen from all view-points of a group;
    /// `blocks` is their number in a row.
    #[inline(always)]
    pub(crate) fn blocks(&self, group: usize, blocks: usize) -> RangeInclusive<isize> {
        let (lanes, x) = (LANES.cast_signed(), (group * LANES).cast_signed());
        let from = ((x + self.first) >> LANES.ilog2()).max(0);
        from..=((x + self.last + lanes - 1) >> LANES.ilog2()).min(blocks.cast_signed() - 1)
    }
}

/// Returns runs of cells, with the readings that any of them needs.
fn runs<'a>(cells: impl Iterator<Item = (&'a StencilCell, u64)>) -> Vec<NeededRun> {
    let mut places: Vec<(isize, isize, u64)> =
        cells.map(|(cell, readings)| (cell.dy as isize, cell.dx as isize, readings)).collect();
    places.sort_unstable();
    let mut runs: Vec<NeededRun> = Vec::new();
    for (dy, dx, readings) in places {
        match runs.last_mut() {
            Some(run) if run.dy == dy && dx - run.last < LANES.cast_signed() => {
                (run.last, run.readings) = (dx, run.readings | readings);
            }
            _ => runs.push(NeededRun { dy, first: dx, last: dx, readings }),
        }
    }
    runs
}
