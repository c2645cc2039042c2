//! The parts of a face that free space may touch: those that no other solid buries.
//!
//! Where thousands of solids overlap, nearly all faces are buried, and the search for corners
//! skips them.

use crate::faces::{Bounds, Face};
use crate::outline::Outline;
use nalgebra::{Point2, Vector2};

/// A part this deep inside another solid is buried [m]: deeper than the hair beside a point at
/// which the world looks for free space.
const DEEP: f64 = 2e-5;
/// Places along a face that differ by less than this are the same [m].
const SAME: f64 = 1e-6;

/// The start and end of a part, along a face [m].
type Part = (f64, f64);

/// The exposed parts of a face, in order.
#[derive(Debug, Clone)]
pub(crate) struct Exposed(Vec<Part>);

impl Exposed {
    /// Finds the parts of a face inside an extent that `others` leave exposed.
    pub(crate) fn new<'a>(
        face: &Face,
        extent: Bounds,
        others: impl Iterator<Item = &'a Outline>,
    ) -> Self {
        let (low, high) = extent;
        let deep = Vector2::repeat(DEEP);
        let inside = within(face, (low - deep, high + deep), (0.0, face.length));
        let mut left: Vec<Part> = inside.into_iter().collect();
        for outline in others {
            if left.is_empty() {
                break;
            }
            for buried in buried(face, outline) {
                left = left.into_iter().flat_map(|part| without(part, buried)).collect();
            }
        }
        Self(left)
    }

    /// Returns whether no part is exposed.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns whether a place along the face is exposed.
    pub(crate) fn holds(&self, place: f64) -> bool {
        let next = self.0.partition_point(|(_, end)| *end + SAME < place);
        self.0.get(next).is_some_and(|(begin, _)| begin - SAME <= place)
    }
}

/// Returns the parts of a face deep inside of an outline, in order.
fn buried(face: &Face, outline: &Outline) -> Vec<Part> {
    let margin = Vector2::repeat(DEEP);
    let (low, high) = face.bounds();
    let whole = (0.0, face.length);
    let sides = outline.sides_meeting((low - margin, high + margin));
    let mut near: Vec<Part> = sides.filter_map(|side| beside(face, side, whole)).collect();
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    // Between two places near the outline the face is all inside or all outside.
    let mut buried = Vec::new();
    let mut from = 0.0;
    for (begin, end) in near.into_iter().chain([(face.length, face.length)]) {
        if from < begin && outline.holds(face.a + face.along * (0.5 * (from + begin))) {
            buried.push((from, begin));
        }
        from = from.max(end);
    }
    buried
}

/// Returns the part of a face that is near a side of an outline.
fn beside(face: &Face, (a, b): (Point2<f64>, Point2<f64>), part: Part) -> Option<Part> {
    let length = (b - a).norm();
    let along = (b - a) / length;
    let (from, way) = (face.a - a, face.along);
    let part = between(part, from.dot(&along), way.dot(&along), (-DEEP, length + DEEP))?;
    between(part, along.perp(&from), along.perp(&way), (-DEEP, DEEP))
}

/// Returns the part of a face within a box.
fn within(face: &Face, (low, high): Bounds, part: Part) -> Option<Part> {
    let part = between(part, face.a.x, face.along.x, (low.x, high.x))?;
    between(part, face.a.y, face.along.y, (low.y, high.y))
}

/// Returns the part along which `start + slope · place` lies between two bounds.
fn between((from, to): Part, start: f64, slope: f64, (low, high): (f64, f64)) -> Option<Part> {
    let (first, last) = ((low - start) / slope, (high - start) / slope);
    let (first, last) = match slope {
        s if s > 0.0 => (first, last),
        s if s < 0.0 => (last, first),
        _ if (low..=high).contains(&start) => (from, to),
        _ => return None,
    };
    let (from, to) = (from.max(first), to.min(last));
    (from <= to).then_some((from, to))
}

/// Returns the remainder of one part without another.
fn without((from, to): Part, (begin, end): Part) -> impl Iterator<Item = Part> {
    let apart = end <= from || to <= begin;
    let whole = apart.then_some((from, to));
    let before = (!apart && from < begin).then_some((from, begin));
    let after = (!apart && end < to).then_some((end, to));
    [whole, before, after].into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Surface;

    fn outline(points: &[(f64, f64)]) -> Outline {
        let points = points.iter().map(|(x, y)| Point2::new(*x, *y)).collect();
        Outline::new(points, Surface::Rough)
    }

    /// Checks the exposed parts of the face from (0, 0) to (10, 0).
    #[track_caller]
    fn check(others: &[Outline], expected: &[Part]) {
        let face = Face::new(Point2::origin(), Point2::new(10.0, 0.0), Surface::Rough);
        let extent = (Point2::new(-5.0, -5.0), Point2::new(9.0, 5.0));
        let Exposed(parts) = Exposed::new(&face, extent, others.iter());
        assert_eq!(parts.len(), expected.len(), "{parts:?}");
        for (part, expected) in parts.iter().zip(expected) {
            let off = (part.0 - expected.0).abs().max((part.1 - expected.1).abs());
            assert!(off < 1e-4, "{part:?}");
        }
    }

    #[test]
    fn what_lies_deep_in_a_solid_is_buried() {
        check(&[], &[(0.0, 9.0)]);
        let square = outline(&[(2.0, -1.0), (4.0, -1.0), (4.0, 1.0), (2.0, 1.0)]);
        check(std::slice::from_ref(&square), &[(0.0, 2.0), (4.0, 9.0)]);
        let next = outline(&[(3.0, -1.0), (11.0, -1.0), (11.0, 1.0), (3.0, 1.0)]);
        check(&[square, next], &[(0.0, 2.0)]);
    }

    #[test]
    fn what_a_solid_only_touches_is_exposed() {
        let above = outline(&[(2.0, 0.0), (4.0, 0.0), (4.0, 1.0), (2.0, 1.0)]);
        check(std::slice::from_ref(&above), &[(0.0, 9.0)]);
        let far = outline(&[(2.0, 1.0), (4.0, 1.0), (4.0, 2.0), (2.0, 2.0)]);
        check(&[above, far], &[(0.0, 9.0)]);
    }

    #[test]
    fn a_solid_that_is_not_convex_buries_in_parts() {
        // A comb: two teeth down over the face.
        let comb = [
            (1.0, 2.0),
            (1.0, -1.0),
            (2.0, -1.0),
            (2.0, 1.0),
            (5.0, 1.0),
            (5.0, -1.0),
            (6.0, -1.0),
            (6.0, 2.0),
        ];
        check(&[outline(&comb)], &[(0.0, 1.0), (2.0, 5.0), (6.0, 9.0)]);
    }
}
