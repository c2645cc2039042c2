//! What the planner says of the cells: the certificate, and counts for progress and reports.

use crate::exploration::InSight;
use crate::{CellStatus, Planner};
use covmap::{Cell, CoverageMap, Raster};

impl Planner {
    /// What became of every cell, for a robot in the cell `from`: explored means that none
    /// is [`CellStatus::Open`].
    pub fn certificate(&mut self, map: &CoverageMap, from: Cell) -> Raster<CellStatus> {
        let mut in_sight = vec![InSight::Nowhere; self.grid.len()];
        let candidates = self.candidates(from);
        for view_point in candidates.costs.reached() {
            let is_candidate = candidates.indices.binary_search(&view_point).is_ok();
            let sight = if is_candidate { InSight::Candidate } else { InSight::Spent };
            for (index, distance) in self.beams.cells_in_sight(view_point) {
                if self.is_reason(index, distance) {
                    in_sight[index] = in_sight[index].max(sight);
                }
            }
        }
        Raster::from_fn(self.grid, |cell| {
            let index = self.grid.index(cell).unwrap_or(0);
            let (known, entropy) = (map.is_known(cell), map.entropy(cell));
            self.exploration.status(index, known, entropy, in_sight[index])
        })
    }

    /// The share of cells that are finished among those that are known or finished; cheap,
    /// for progress.
    pub fn share_finished(&self, map: &CoverageMap) -> f64 {
        let status = |index: usize| {
            let cell = self.grid.cell(index);
            self.exploration.status(
                index,
                map.is_known(cell),
                map.entropy(cell),
                InSight::Candidate,
            )
        };
        let count = |wanted: fn(CellStatus) -> bool| {
            (0..self.grid.len())
                .filter(|i| map.is_known(self.grid.cell(*i)) && wanted(status(*i)))
                .count()
        };
        let (finished, open) = (
            count(|s| matches!(s, CellStatus::Resolved | CellStatus::Exhausted)),
            count(|s| s == CellStatus::Open),
        );
        #[allow(clippy::cast_precision_loss, reason = "a share of at most 2e7 cells")]
        let share = finished as f64 / (finished + open).max(1) as f64;
        share
    }

    /// How many cells were given up by the cap on counted scans.
    pub fn capped_cells(&self) -> usize {
        self.exploration.capped_cells()
    }

    /// How many scans were counted for each cell.
    pub fn counted_scans(&self) -> Raster<u32> {
        self.exploration.counted_scans(self.grid)
    }

    /// Whether a step leads the robot out of the cell that it is in.
    pub fn can_move(&self, from: Cell) -> bool {
        self.grid.index(from).is_some_and(|i| self.traversable.steps().from(i) != 0)
    }
}
