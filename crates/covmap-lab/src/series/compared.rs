//! The cells over which maps of a world are compared, whatever run made them.

use crate::Truth;
use covmap::{Cell, Class, Raster};
use covmap_model::cells_under_body;

/// Offsets to a cell itself and to its neighbours on one side: each pair of neighbours occurs once.
const FORWARD: [(i32, i32); 5] = [(0, 0), (1, 0), (0, 1), (1, 1), (-1, 1)];

impl Truth {
    /// Returns the observable cells without those that a body of `radius` \[m\] may pin, in row-major order.
    ///
    /// The body may pin a free cell that is under it somewhere between two neighbouring cells that it can
    /// truly reach. The set is a function of world, grid and body. Unlike [`Truth::scored_cells`] it does not
    /// depend on the path of a run, so maps of different runs can be compared over it.
    pub fn compared_cells(&self, radius: f64) -> Vec<Cell> {
        let pinned = self.pinnable(radius);
        let is_out = |cell: Cell| pinned.get(cell) == Some(&true);
        let observable = self.observable.iter().filter(|(_, o)| **o).map(|(cell, _)| cell);
        observable.filter(|cell| !(is_out(*cell) && self.is_free(*cell))).collect()
    }

    /// Marks the cells whose centres are under the body somewhere in the space that the body can reach.
    fn pinnable(&self, radius: f64) -> Raster<bool> {
        let grid = *self.reachable.grid();
        let reached = |cell: Cell| self.reachable.get(cell) == Some(&true);
        let mut under = Raster::filled(grid, false);
        for from in grid.cells().filter(|cell| reached(*cell)) {
            let steps = FORWARD.iter().map(|(i, j)| from.offset(*i, *j));
            for to in steps.filter(|cell| reached(*cell)) {
                for cell in cells_under_body(&grid, grid.center(from), grid.center(to), radius) {
                    under.get_mut(cell).into_iter().for_each(|under| *under = true);
                }
            }
        }
        under
    }

    fn is_free(&self, cell: Cell) -> bool {
        self.coverage.get(cell).is_some_and(|coverage| Class::of(*coverage) == Class::Free)
    }
}
