//! A path for drawing, with a bounded number of points, whatever its length.

use nalgebra::Point2;

/// The most corners of a line in a picture.
const MOST: usize = 20_000;

/// The corners of a path \[m\], every n-th of them once there are too many.
#[derive(Debug, Default)]
pub struct Trail {
    /// Each corner, and whether the way to it is unknown.
    corners: Vec<(Point2<f64>, bool)>,
    /// The number of corners that are left out after each kept one.
    left_out: usize,
    passed: usize,
    /// Whether the path was broken since the last corner that is kept.
    broken: bool,
}

impl Trail {
    /// Adds a corner; after a jump the way to it is unknown.
    pub fn push(&mut self, point: Point2<f64>, jump: bool) {
        self.broken |= jump;
        if self.passed < self.left_out {
            self.passed += 1;
            return;
        }
        self.corners.push((point, self.broken));
        (self.passed, self.broken) = (0, false);
        if self.corners.len() >= MOST {
            self.halve();
        }
    }

    fn halve(&mut self) {
        let pair = |pair: &[(Point2<f64>, bool)]| {
            let (point, _) = pair[0];
            (point, pair.iter().any(|(_, broken)| *broken))
        };
        self.corners = self.corners.chunks(2).map(pair).collect();
        self.left_out = 2 * self.left_out + 1;
    }

    /// Returns the corners, with one that is not finite wherever the path is broken.
    pub fn line(&self) -> Vec<Point2<f64>> {
        let gap = Point2::new(f64::NAN, f64::NAN);
        let corner = |&(point, broken): &(Point2<f64>, bool)| {
            broken.then_some(gap).into_iter().chain([point])
        };
        self.corners.iter().flat_map(corner).collect()
    }
}
