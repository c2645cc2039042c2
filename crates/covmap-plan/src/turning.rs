//! The turns on a path.

use covmap::Cell;
use nalgebra::Vector2;

/// The straight way from the centre of one cell to that of another \[cells\].
pub(crate) fn straight(from: Cell, to: Cell) -> Vector2<f64> {
    Vector2::new(f64::from(to.x - from.x), f64::from(to.y - from.y))
}

/// Returns the sum of the turns on a path of straight pieces \[rad\]: the angle between each piece and
/// the next, at most π each. A piece of length 0 has no direction and does not count.
pub fn turns(pieces: impl IntoIterator<Item = Vector2<f64>>) -> f64 {
    let pieces: Vec<_> = pieces.into_iter().filter(|piece| piece.norm() > 0.0).collect();
    let angle =
        |pair: &[Vector2<f64>]| libm::atan2(pair[0].perp(&pair[1]), pair[0].dot(&pair[1])).abs();
    pieces.windows(2).map(angle).sum()
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
