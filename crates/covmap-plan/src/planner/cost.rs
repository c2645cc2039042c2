//! The cost of a path with its turns.

use super::Candidates;
use crate::turning::straight;
use crate::{Planner, Strategy, turns};
use covmap::Cell;

impl Planner {
    /// The cost of a candidate for a robot in the cell `from`: d_c(l, x) \[m\], for IG_CL plus the cost of
    /// the turns on the path that the robot would drive.
    pub(crate) fn cost(&self, candidates: &Candidates, from: Cell, index: usize) -> f64 {
        let length = candidates.costs.cost(index).unwrap_or(f64::INFINITY);
        let of_radian = self.parameters.turn_cost;
        let weighs_turns = matches!(self.parameters.strategy, Strategy::IgCl { .. });
        if of_radian == 0.0 || !weighs_turns {
            return length;
        }
        let path = candidates.costs.path_to(self.grid.cell(index)).unwrap_or_default();
        let corners = self.traversable.pulled_tight(from, &path);
        let starts = std::iter::once(from).chain(corners.iter().copied());
        let pieces = starts.zip(&corners).map(|(start, end)| straight(start, *end));
        length + of_radian * turns(self.ahead.into_iter().chain(pieces))
    }
}
