//! Sets of view-points, in groups of neighbours.
//!
//! Each row of the grid is cut into pieces of [`LANES`] neighbours. A piece is called a *group* where
//! its members are view-points, and a *block* where they are cells that are looked at; groups and
//! blocks are numbered alike, row by row. The *lane* of a member is its place in the piece. The last
//! piece of a row may have fewer members.

use covmap::Grid;
use covmap::lanes::LANES;

/// A set of view-points.
#[derive(Debug, Clone)]
pub struct ViewPoints {
    width: usize,
    /// For each group a bit for each lane.
    bits: Vec<u16>,
}

impl ViewPoints {
    /// Creates the empty set.
    pub fn new(grid: &Grid) -> Self {
        Self { width: grid.width(), bits: vec![0; grid.height() * groups_per_row(grid)] }
    }

    /// Creates a set of some view-points, by their row-major indices.
    pub fn of(grid: &Grid, indices: impl IntoIterator<Item = usize>) -> Self {
        let mut set = Self::new(grid);
        indices.into_iter().for_each(|index| set.insert(index));
        set
    }

    /// Creates a set of one view-point, by its row-major index.
    pub fn one(grid: &Grid, index: usize) -> Self {
        Self::of(grid, [index])
    }

    /// Adds a view-point by its row-major index.
    pub fn insert(&mut self, index: usize) {
        let (group, lane) = group_and_lane(self.width, index);
        self.bits[group] |= 1 << lane;
    }

    /// Adds all view-points of another set that are in the same group as one of them. Neighbours
    /// are computed side by side and cost nothing.
    pub fn insert_neighbours(&mut self, of: &Self, index: usize) {
        let (group, _) = group_and_lane(self.width, index);
        self.bits[group] |= of.bits[group];
    }

    /// Returns the members of each group, bit by bit, row by row.
    pub(crate) fn groups(&self) -> &[u16] {
        &self.bits
    }

    /// Returns the row-major indices of those members that `keep` leaves in each group, in order.
    pub(crate) fn indices(&self, keep: impl Fn(usize) -> u16) -> Vec<usize> {
        let mut indices = Vec::new();
        let per_row = self.width.div_ceil(LANES);
        for (group, bits) in self.bits.iter().enumerate().filter(|(_, bits)| **bits != 0) {
            let first = group / per_row * self.width + group % per_row * LANES;
            let kept = bits & keep(group);
            indices
                .extend((0..LANES).filter(|lane| kept >> lane & 1 == 1).map(|lane| first + lane));
        }
        indices
    }
}

/// Returns the number of groups, or blocks, of a row.
pub(crate) fn groups_per_row(grid: &Grid) -> usize {
    grid.width().div_ceil(LANES)
}

/// Returns the group of a view-point and its lane, by its row-major index and the grid's width; for
/// a cell its block and its lane.
pub(crate) fn group_and_lane(width: usize, index: usize) -> (usize, usize) {
    let (x, y) = (index % width, index / width);
    (y * width.div_ceil(LANES) + x / LANES, x % LANES)
}
