//! The half of a disc's rim that looks ahead.

use covmap::Cell;
use nalgebra::{Point2, Vector2};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Returns the squares of side `step` \[m\], from a corner on, under the front of a disc that
/// drives in a direction, in row-major order, with their shares of its width. The shares sum to 1.
pub(super) fn front(
    corner: Point2<f64>,
    step: f64,
    at: Point2<f64>,
    direction: Vector2<f64>,
    radius: f64,
) -> Vec<(Cell, f64)> {
    let ahead = libm::atan2(direction.y, direction.x);
    let is_finite = at.coords.iter().chain(&direction).all(|v| v.is_finite());
    // Farther away, parts could not be told apart.
    let is_near = (at - corner).amax() <= 1e9 * step;
    if !is_finite || !is_near || direction.norm() <= 0.0 || !(0.0..=1e4 * step).contains(&radius) {
        return Vec::new();
    }
    let mut ends = vec![-FRAC_PI_2, FRAC_PI_2];
    let offset = at - corner;
    for (along, turn) in [(offset.x, 0.0), (offset.y, FRAC_PI_2)] {
        // Where the rim crosses the line between two columns, or two rows.
        let line = |k: f64| (k * step - along) / radius;
        let first = ((along - radius) / step).ceil();
        let lines = std::iter::successors(Some(first), |k| Some(k + 1.0));
        for cosine in lines.map(line).take_while(|cosine| *cosine <= 1.0) {
            let angle = libm::acos(cosine.clamp(-1.0, 1.0));
            ends.extend([turn + angle, turn - angle].map(|angle| around(angle - ahead)));
        }
    }
    ends.retain(|end| end.abs() <= FRAC_PI_2);
    ends.sort_by(f64::total_cmp);
    let mut shares: BTreeMap<Cell, f64> = BTreeMap::new();
    for part in ends.windows(2) {
        let (sin, cos) = libm::sincos(ahead + 0.5 * (part[0] + part[1]));
        let share = 0.5 * (libm::sin(part[1]) - libm::sin(part[0]));
        let square = (offset + Vector2::new(cos, sin) * radius) / step;
        #[allow(clippy::cast_possible_truncation, reason = "saturates outside of every grid")]
        let square = Cell::new(square.x.floor() as i32, square.y.floor() as i32);
        if share > 0.0 {
            *shares.entry(square).or_default() += share;
        }
    }
    shares.into_iter().collect()
}

/// Wraps an angle to [−π, π).
fn around(angle: f64) -> f64 {
    angle - TAU * ((angle + PI) / TAU).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_the_half_of_the_rim_ahead() {
        // A disc of .2 m around the middle of cell (10, 10), driving to the right: its front
        // crosses y = ±.05 and ±.15 around the centre, so the rows have ¼ each of its .4 m and
        // the outermost two ⅛ each.
        let shares = front(Point2::origin(), 0.1, Point2::new(1.05, 1.05), Vector2::x(), 0.2);
        let row = |y: i32| shares.iter().filter(|(c, _)| c.y == y).map(|(_, w)| w).sum::<f64>();
        for (y, share) in [(8, 0.125), (9, 0.25), (10, 0.25), (11, 0.25), (12, 0.125)] {
            assert!((row(y) - share).abs() < 1e-12, "{y}: {}", row(y));
        }
        assert!(shares.iter().all(|(cell, _)| cell.x >= 10));
        // Right ahead .2 m: cell (12, 10), and no other of its row.
        assert!(shares.iter().any(|(c, w)| *c == Cell::new(12, 10) && (w - 0.25).abs() < 1e-12));
    }

    #[test]
    fn the_front_turns_with_the_direction() {
        let corner = Point2::new(-1.0, -1.0);
        let turned = |cell: Cell| Cell::new(19 - cell.y, cell.x);
        let shares = |direction| front(corner, 0.1, Point2::origin(), direction, 0.27);
        let mut expected: Vec<(Cell, f64)> =
            shares(Vector2::new(0.6, 0.8)).into_iter().map(|(c, w)| (turned(c), w)).collect();
        expected.sort_by_key(|(cell, _)| *cell);
        let found = shares(Vector2::new(-0.8, 0.6));
        assert_eq!(found.len(), expected.len());
        for ((a, v), (b, w)) in found.iter().zip(&expected) {
            assert!(a == b && (v - w).abs() < 1e-9, "{a:?} {v} {b:?} {w}");
        }
        assert!((found.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-12);
        for direction in [Vector2::zeros(), Vector2::new(f64::NAN, 1.0)] {
            assert!(shares(direction).is_empty());
        }
    }
}
