//! Lines through points, by total least squares.

use nalgebra::{Point2, Vector2};

/// The number, mean and scatter of points: all that a line through the points needs.
///
/// The sum of two is exact: the line through the points of many scans is the line of all their
/// points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments {
    pub(super) count: f64,
    mean: Point2<f64>,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Moments {
    pub(super) fn of(points: impl IntoIterator<Item = Point2<f64>>) -> Self {
        let none = Self { count: 0.0, mean: Point2::origin(), xx: 0.0, xy: 0.0, yy: 0.0 };
        points.into_iter().fold(none, |all, p| all.with(&Self { count: 1.0, mean: p, ..none }))
    }

    /// Returns the moments of the points of both.
    pub(super) fn with(&self, other: &Self) -> Self {
        let count = self.count + other.count;
        if count <= 0.0 {
            return *self;
        }
        let apart = other.mean - self.mean;
        let weight = self.count * other.count / count;
        Self {
            count,
            mean: self.mean + apart * (other.count / count),
            xx: self.xx + other.xx + weight * apart.x * apart.x,
            xy: self.xy + other.xy + weight * apart.x * apart.y,
            yy: self.yy + other.yy + weight * apart.y * apart.y,
        }
    }

    /// Returns the line with the least sum of squared distances.
    ///
    /// The line's direction is
    ///
    /// ```text
    /// ½ · atan2(2·S_xy, S_xx − S_yy)
    /// ```
    ///
    /// The result is `None` without two different points.
    pub(super) fn line(&self) -> Option<Line> {
        let (difference, cross) = (self.xx - self.yy, 2.0 * self.xy);
        let positive = self.xx + self.yy > 0.0;
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(cross, difference));
        positive.then_some(Line { at: self.mean, along: Vector2::new(cos, sin) })
    }

    /// Returns the root of the mean squared distance from the line [m].
    pub(super) fn residual(&self) -> f64 {
        let (difference, cross) = (self.xx - self.yy, 2.0 * self.xy);
        let spread = (difference * difference + cross * cross).sqrt();
        (0.5 * (self.xx + self.yy - spread) / self.count.max(1.0)).max(0.0).sqrt()
    }
}

/// A line with a direction; the viewer stands on its left.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) at: Point2<f64>,
    /// A unit vector.
    pub(super) along: Vector2<f64>,
}

impl Line {
    /// Returns the line from one point to another, if they differ.
    pub(super) fn through(from: Point2<f64>, to: Point2<f64>) -> Option<Self> {
        (to - from).try_normalize(1e-9).map(|along| Self { at: from, along })
    }

    /// Returns the same line, in the direction that has a point on its left.
    pub(super) fn seen_from(self, eye: Point2<f64>) -> Self {
        if self.height(eye) < 0.0 { Self { along: -self.along, ..self } } else { self }
    }

    /// Returns the signed distance of a point, positive on the left [m].
    pub(super) fn height(&self, point: Point2<f64>) -> f64 {
        self.along.perp(&(point - self.at))
    }

    /// Returns the unit vector to the right: away from the viewer.
    pub(super) fn back(&self) -> Vector2<f64> {
        Vector2::new(self.along.y, -self.along.x)
    }

    /// Returns the place of a point along the line [m].
    pub(super) fn place(&self, point: Point2<f64>) -> f64 {
        self.along.dot(&(point - self.at))
    }

    /// Returns the point at a place.
    pub(super) fn point(&self, place: f64) -> Point2<f64> {
        self.at + self.along * place
    }

    /// Returns the smallest and the largest place of some points.
    pub(super) fn span(&self, points: impl IntoIterator<Item = Point2<f64>>) -> (f64, f64) {
        points
            .into_iter()
            .map(|p| self.place(p))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)))
    }
}
