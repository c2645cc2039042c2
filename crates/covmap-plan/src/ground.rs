//! Ground that the robot may yet reach: before a run ends, the robot measures what keeps it off.
//!
//! The promise of a scan counts the entropy of cells alone, and not that a whole room may lie out of
//! sight behind them. So if no scan is worth taking any longer, the planner asks whether the robot could
//! stand on more ground if cells that may be free were free. The robot then measures these cells as long
//! as it learns anything about them.

use crate::parameters::LeastChange;
use crate::passage::{ROOM, regions};
use crate::planner::Candidates;
use crate::{Planner, TravelCosts};
use covmap::{Cell, CoverageMap, bin_coverage};
use covmap_gain::ViewPoints;

/// A cell may be free if it is free with at least this probability. (An unknown cell has .27 with 11 bins.)
const MAY_BE_FREE: f64 = 0.2;

/// Least expected fall of the entropy of a cell that keeps the robot off \[nats\], if something is known
/// of the cell.
const DOUBT: f64 = 0.1;

/// Share of the largest entropy from which on next to nothing is known of a cell. For such a cell any
/// change that counts is worth a scan.
const BLANK: f64 = 0.9;

impl Planner {
    /// The candidates towards more ground for a robot in the cell `from`, and what a scan must promise then.
    ///
    /// For each cell that keeps the robot off, this is the candidate that is expected to change the cell
    /// most, if that change is enough; a scan must promise as much as one cell that counts. `None` if there
    /// is no such ground, if the parameters ask for no expected change, or with the product of Eq. (9),
    /// which does not tell the cells apart.
    pub(crate) fn candidates_towards_ground(
        &mut self,
        map: &CoverageMap,
        from: Cell,
    ) -> Option<(Candidates, LeastChange)> {
        let LeastChange { cell: least, .. } = self.least_change?;
        let mut candidates = self.candidates(from);
        let keeps_off = self.what_keeps_off_ground(map, &candidates.costs)?;
        let is_wanted =
            |&(index, distance): &(usize, f32)| keeps_off[index] && self.is_reason(index, distance);
        candidates.indices.retain(|index| self.gains.sees(*index, is_wanted));
        let wanted = ViewPoints::of(&self.grid, candidates.indices.iter().copied());
        let largest = self.gains.largest_changes(&wanted);
        let enough = |index: usize| if self.is_blank(index) { least } else { DOUBT };
        let kept_off = (0..keeps_off.len()).filter(|index| keeps_off[*index]);
        let promising = kept_off
            .filter_map(|index| largest[index].filter(|(change, _)| *change >= enough(index)));
        candidates.indices = promising.map(|(_, from)| from).collect();
        candidates.indices.sort_unstable();
        candidates.indices.dedup();
        let least = LeastChange { cell: least, scan: least };
        (!candidates.indices.is_empty()).then_some((candidates, least))
    }

    /// Marks the cells that keep the robot off ground, where it could stand if all cells that may be free
    /// were free; `None` if there is no such ground of about a square metre next to the reachable cells.
    fn what_keeps_off_ground(&self, map: &CoverageMap, costs: &TravelCosts) -> Option<Vec<bool>> {
        let is_reached = |i: usize| costs.cost(i).is_some();
        let may_be_free: Vec<bool> = self.grid.cells().map(|c| self.may_be_free(map, c)).collect();
        let hoped = self.traversable.with_free(|index| may_be_free[index]);
        let steps = hoped.steps();
        let is_new = |i: usize| hoped.at(i) && !is_reached(i) && !self.exploration.is_outside(i);
        let is_next_to_reached = |i: usize| steps.neighbours(i).any(is_reached);
        let least = ROOM * self.traversable.body_cells();
        let ground = regions(&steps, least, is_new, is_next_to_reached);
        let mut keeps_off = vec![false; self.grid.len()];
        for index in (0..self.grid.len()).filter(|index| ground[*index]) {
            for under_body in self.traversable.under_body_at(index) {
                keeps_off[under_body] |= !self.traversable.is_free(under_body);
            }
        }
        keeps_off.contains(&true).then_some(keeps_off)
    }

    /// Whether next to nothing is known of a cell.
    fn is_blank(&self, index: usize) -> bool {
        let largest = libm::log(self.model.parameters().bins as f64);
        f64::from(self.gains.entropy(index)) >= BLANK * largest
    }

    /// Whether the robot may be able to drive over a cell.
    fn may_be_free(&self, map: &CoverageMap, cell: Cell) -> bool {
        let histogram = map.histogram(cell);
        let most = self.parameters().traversable_coverage + 1e-9;
        let probabilities = histogram.probabilities().iter().enumerate();
        let free = probabilities.filter(|(bin, _)| bin_coverage(*bin, map.bins()) <= most);
        free.map(|(_, p)| p).sum::<f64>() >= MAY_BE_FREE
    }
}
