//! The gains of the cells around some rows of view-points, at one ring.

use crate::belief::Belief;
use crate::product::tables::basis::Basis;
use crate::product::tables::rings::DistanceRing;
use covmap::Grid;
use covmap::lanes::LANES;
use pulp::{Simd, WithSimd};
use std::ops::Range;

use crate::view_points::groups_per_row;

/// Layout of the planes of gains in memory: row of cells by row, in each row reading by reading,
/// for each reading the cells of the row with a border on either side.
///
/// The terms of the sums of a beam thus lie at constant offsets from any view-point, and the
/// readings of a cell one `stride` apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    /// Rows and columns around the grid's cells, as many as a stencil needs, in whole blocks.
    pub(super) border: usize,
    /// Distance from one reading of a row to the next.
    pub(super) stride: usize,
    /// Distance from one row of cells to the next.
    pub(super) row: usize,
}

impl Layout {
    /// Creates the layout for as many readings as the ring with the most of them has.
    pub(super) fn new(grid: &Grid, radius: i32, readings: usize) -> Self {
        let border = usize::try_from(radius).unwrap_or(0).next_multiple_of(LANES);
        let stride = grid.width().next_multiple_of(LANES) + 2 * border;
        Self { border, stride, row: stride * readings.max(1) }
    }
}

/// The planes of a ring, and the readings that each block needs.
#[derive(Debug, Default)]
pub(super) struct GainPlanes {
    /// 0 outside of the grid.
    pub(super) gains: Vec<f32>,
    /// For each block of cells its readings, bit by bit.
    pub(super) needed: Vec<u64>,
    /// The rows inside of the grid at the last use.
    inside: Range<usize>,
}

impl Clone for GainPlanes {
    /// Returns empty planes: their gains are never needed again.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl GainPlanes {
    /// Makes room for a number of rows of cells, some of them `inside` of the grid, of a number of
    /// blocks.
    ///
    /// Zeroed memory costs nothing until it is used, and most rows outside were outside before.
    pub(super) fn prepare(
        &mut self,
        layout: Layout,
        rows: usize,
        inside: Range<usize>,
        blocks: usize,
    ) {
        let row = layout.row;
        if self.gains.len() < rows * row {
            *self = Self { gains: vec![0.0; rows * row], ..Self::default() };
        }
        for outside in self.inside.clone().filter(|y| !inside.contains(y)) {
            self.gains[outside * row..(outside + 1) * row].fill(0.0);
        }
        self.inside = inside;
        self.needed.resize(rows * blocks, 0);
    }
}

/// Finds the gains of one row of cells by the readings that are needed.
pub(super) struct FillRow<'a> {
    pub(super) grid: &'a Grid,
    pub(super) basis: &'a Basis,
    pub(super) layout: Layout,
    pub(super) ring: &'a DistanceRing,
    pub(super) belief: &'a Belief,
    /// The row of the grid.
    pub(super) y: usize,
    /// Block by block.
    pub(super) needed: &'a [u64],
    /// The row's gains.
    pub(super) gains: &'a mut [f32],
}

impl WithSimd for FillRow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { grid, basis, layout, ring, belief, y, needed, gains } = self;
        for (x, needed) in needed.iter().enumerate().filter(|(_, needed)| **needed != 0) {
            let block = y * groups_per_row(grid) + x;
            let prior = belief.prior(block);
            let column = layout.border + x * LANES;
            // Bit by bit: a branch for each reading would be mispredicted too often.
            let mut left = *needed;
            while left != 0 {
                let first = left.trailing_zeros() as usize;
                left &= left - 1;
                for (i, reading) in ring.readings.iter().enumerate().skip(first).step_by(64) {
                    let at = i * layout.stride + column;
                    gains[at..at + LANES].copy_from_slice(&basis.gain(reading, &prior, block));
                }
            }
        }
    }
}
