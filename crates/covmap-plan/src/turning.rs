//! What a way costs with its turns.

use crate::planner::Candidates;
use crate::{Planner, Strategy};
use covmap::Cell;
use nalgebra::Vector2;

/// The straight way from the centre of one cell to that of another \[cells\].
pub(crate) fn straight(from: Cell, to: Cell) -> Vector2<f64> {
    Vector2::new(f64::from(to.x - from.x), f64::from(to.y - from.y))
}

/// How far one turns on a way of straight pieces: the angles between each and the next, at most π,
/// summed up \[rad\]. A piece of no length has no direction, and does not count.
pub fn turns(pieces: impl IntoIterator<Item = Vector2<f64>>) -> f64 {
    let pieces: Vec<_> = pieces.into_iter().filter(|piece| piece.norm() > 0.0).collect();
    let angle =
        |pair: &[Vector2<f64>]| libm::atan2(pair[0].perp(&pair[1]), pair[0].dot(&pair[1])).abs();
    pieces.windows(2).map(angle).sum()
}

impl Planner {
    /// The cost of a candidate for a robot in the cell `from`: d_c(l, x) \[m\], and for IG_CL what the
    /// turns on the way that it would drive cost beside.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn turns_are_summed_up_over_the_pieces() {
        let close = |pieces: &[(f64, f64)], expected: f64| {
            let found = turns(pieces.iter().map(|(x, y)| Vector2::new(*x, *y)));
            assert!((found - expected).abs() < 1e-12, "{pieces:?}: {found} is not {expected}");
        };
        close(&[], 0.0);
        close(&[(0.0, 2.0)], 0.0);
        close(&[(0.0, 2.0), (0.0, 4.0)], 0.0);
        close(&[(0.0, 2.0), (4.0, 0.0)], PI / 2.0);
        close(&[(0.0, 2.0), (0.0, 0.0), (0.0, -4.0)], PI);
        // To the east, the north-east and the west: 90°, 45° and 135°.
        close(&[(0.0, 2.0), (4.0, 0.0), (1.0, 1.0), (-8.0, 0.0)], 1.5 * PI);
    }
}
