//! The corners of a driven path.

use nalgebra::Point2;

/// Returns the corners of a path, without the points where the path goes straight on.
pub fn corners(path: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let mut kept: Vec<Point2<f64>> = Vec::new();
    for point in path {
        if let [.., a, b] = kept[..] {
            let (along, next) = (b - a, point - b);
            let straight = along.perp(&next).abs() <= 1e-9 * along.norm() * next.norm();
            if straight && along.dot(&next) >= 0.0 {
                kept.pop();
            }
        }
        kept.push(*point);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_corners_are_kept_and_ways_back_are_corners() {
        let points = |all: &[(f64, f64)]| -> Vec<Point2<f64>> {
            all.iter().map(|&(x, y)| Point2::new(x, y)).collect()
        };
        let path = [(0., 0.), (1., 0.), (2., 0.), (3., 1.), (4., 2.), (4., 0.), (4., 1.)];
        let expected = [(0., 0.), (2., 0.), (4., 2.), (4., 0.), (4., 1.)];
        assert_eq!(corners(&points(&path)), points(&expected));
    }
}
