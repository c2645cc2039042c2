//! Which cells and which of a ring's readings the outcomes of a beam ask for.

use super::rings::{Ring, Shares, Source};
use crate::{Stencil, StencilCell};
use covmap::lanes::LANES;
use std::ops::{Range, RangeInclusive};

/// A run of neighbouring cells from a view-point: row, first and last column, and which readings
/// of theirs are asked for, bit by bit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ask {
    pub(crate) dy: isize,
    first: isize,
    last: isize,
    pub(crate) readings: u64,
}

/// The bit of a reading: with more than 64 several share one.
#[inline(always)]
fn bit(reading: usize) -> u64 {
    1 << (reading % 64)
}

/// What a ring's outcomes ask for: some readings of all its cells, or for each beam what its
/// cells ask for themselves.
#[derive(Debug, Clone)]
pub(crate) struct Asks {
    /// For each beam all its cells.
    pub(crate) cells: Vec<Vec<Ask>>,
    pub(crate) front: u64,
    /// In the order of the ring's own.
    pub(crate) near: Vec<(u64, Vec<Vec<Ask>>)>,
    pub(crate) no_echo: u64,
}

impl Asks {
    /// What each outcome of a ring asks for.
    pub(crate) fn new(ring: &Ring, stencil: &Stencil) -> Self {
        let cells = |beam: usize| &stencil.beams[beam].cells[ring.cells[beam].clone()];
        let bits = |readings: Range<usize>| readings.fold(0, |bits, reading| bits | bit(reading));
        let of_source = |source: &Source| match &source.shares {
            Shares::Weights(_) => (bits(source.first..source.first + source.count), Vec::new()),
            Shares::Own(own) => {
                let ask = |(beam, own): (usize, &Vec<(usize, usize)>)| {
                    runs(
                        own.iter()
                            .map(|(i, reading)| (&cells(beam)[*i], bit(source.first + reading))),
                    )
                };
                (0, own.iter().enumerate().map(ask).collect())
            }
        };
        let all = |beam| runs(cells(beam).iter().map(|cell| (cell, 0)));
        Self {
            cells: (0..stencil.beams.len()).map(all).collect(),
            front: ring.front.as_ref().map_or(0, |f| bits(f.base..f.base + f.count)),
            near: ring.near.iter().map(|(_, source)| of_source(source)).collect(),
            no_echo: ring.no_echo.as_ref().map_or(0, |source| of_source(source).0),
        }
    }
}

impl Ask {
    /// The blocks of cells that a group of view-points asks for, of so many in a row.
    #[inline(always)]
    pub(crate) fn blocks(&self, group: usize, blocks: usize) -> RangeInclusive<isize> {
        let (lanes, x) = (LANES.cast_signed(), (group * LANES).cast_signed());
        let from = ((x + self.first) >> LANES.ilog2()).max(0);
        from..=((x + self.last + lanes - 1) >> LANES.ilog2()).min(blocks.cast_signed() - 1)
    }
}

/// Runs of neighbouring cells, with the readings that any of them asks for.
fn runs<'a>(cells: impl Iterator<Item = (&'a StencilCell, u64)>) -> Vec<Ask> {
    let mut places: Vec<(isize, isize, u64)> =
        cells.map(|(cell, readings)| (cell.dy as isize, cell.dx as isize, readings)).collect();
    places.sort_unstable();
    let mut runs: Vec<Ask> = Vec::new();
    for (dy, dx, readings) in places {
        match runs.last_mut() {
            Some(run) if run.dy == dy && dx - run.last < LANES.cast_signed() => {
                (run.last, run.readings) = (dx, run.readings | readings);
            }
            _ => runs.push(Ask { dy, first: dx, last: dx, readings }),
        }
    }
    runs
}
