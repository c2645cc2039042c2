//! The straight faces of solids, and their intersections with rays.

use crate::faces::Bounds;
use crate::scenario::Surface;
use nalgebra::{Point2, Vector2};

/// A ray that starts on a face may start this far behind it [m].
const BEHIND: f64 = 1e-9;

/// One straight side of a solid, from `a` to `b` with the solid on its left.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    /// Start \[m\].
    pub a: Point2<f64>,
    /// End \[m\].
    pub b: Point2<f64>,
    /// Unit vector from `a` to `b`.
    pub along: Vector2<f64>,
    /// Length \[m\].
    pub length: f64,
    /// Surface of the solid.
    pub surface: Surface,
}

impl Face {
    /// Makes the face from `a` to `b`, which must differ.
    pub fn new(a: Point2<f64>, b: Point2<f64>, surface: Surface) -> Self {
        let length = (b - a).norm();
        Self { a, b, along: (b - a) / length, length, surface }
    }

    /// Returns the unit normal into the free space, to the right of a → b.
    pub fn normal(&self) -> Vector2<f64> {
        Vector2::new(self.along.y, -self.along.x)
    }

    /// Returns the face's bounding box.
    pub fn bounds(&self) -> Bounds {
        (self.a.inf(&self.b), self.a.sup(&self.b))
    }

    /// Returns the height of a point above the face's line \[m\]; negative behind the line.
    pub fn height(&self, point: Point2<f64>) -> f64 {
        (point - self.a).dot(&self.normal())
    }

    /// Returns the point of the face that is nearest to a point.
    pub fn nearest(&self, point: Point2<f64>) -> Point2<f64> {
        let s = (point - self.a).dot(&self.along);
        if s <= 0.0 {
            self.a
        } else if s >= self.length {
            self.b
        } else {
            self.a + self.along * s
        }
    }

    /// Returns the distance at which a ray enters the solid through this face \[m\].
    ///
    /// Both ends belong to the face, and the same expression judges them as the ends of its
    /// neighbours: no ray slips between two faces.
    pub fn entered_at(&self, origin: Point2<f64>, direction: Vector2<f64>) -> Option<f64> {
        let (to_a, to_b) = (self.a - origin, self.b - origin);
        let (side_a, side_b) = (direction.perp(&to_a), direction.perp(&to_b));
        // From outside, a is on the left of the ray and b on its right.
        if side_a < 0.0 || side_b > 0.0 || side_a <= side_b {
            return None;
        }
        let share = side_a / (side_a - side_b);
        let distance = (to_a + (to_b - to_a) * share).dot(&direction);
        (distance >= -BEHIND).then_some(distance.max(0.0))
    }
}
