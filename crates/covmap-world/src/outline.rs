//! Obstacles as simple polygons, checked and oriented.

use crate::error::{
    MAX_EXTENT, MAX_OBSTACLES, MAX_POINTS, MAX_POLYGON_POINTS, MIN_LENGTH, WorldError,
};
use crate::faces::{Bounds, Index};
use crate::scenario::{Obstacle, Shape, Surface};
use nalgebra::{Point2, Vector2};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

const CIRCLE_SIDES: u32 = 64;
/// The smallest area of a polygon [m²].
const MIN_AREA: f64 = MIN_LENGTH * MIN_LENGTH * 1e-3;
/// Points in a row that are nearer to each other than this are one point [m].
const SAME_POINT: f64 = 1e-12;

/// Outlines with more sides than this have an index of them.
const MANY_SIDES: usize = 128;

/// A simple polygon, counter-clockwise, with at least three points.
#[derive(Debug, Clone)]
pub struct Outline {
    /// The corners \[m\].
    pub points: Vec<Point2<f64>>,
    /// The surface.
    pub surface: Surface,
    bounds: Bounds,
    index: Option<Box<Index>>,
}

impl Outline {
    /// Makes the outline of at least three points.
    ///
    /// # Panics
    /// If there is no point.
    pub fn new(points: Vec<Point2<f64>>, surface: Surface) -> Self {
        let first = points[0];
        let around = |(low, high): Bounds, p: &Point2<f64>| (low.inf(p), high.sup(p));
        let bounds = points.iter().fold((first, first), around);
        let mut outline = Self { points, surface, bounds, index: None };
        if outline.points.len() > MANY_SIDES {
            let side = |i| {
                let (a, b) = outline.side(i);
                (a.inf(&b), a.sup(&b))
            };
            let boxes: Vec<Bounds> = (0..outline.points.len()).map(side).collect();
            outline.index = Some(Box::new(Index::new(bounds.0, &boxes)));
        }
        outline
    }

    /// Returns the outline's bounding box.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the start and the end of a side.
    fn side(&self, i: usize) -> (Point2<f64>, Point2<f64>) {
        (self.points[i], self.points[if i + 1 < self.points.len() { i + 1 } else { 0 }])
    }

    /// Returns the sides whose boxes meet a box.
    pub fn sides_meeting(
        &self,
        (low, high): Bounds,
    ) -> impl Iterator<Item = (Point2<f64>, Point2<f64>)> + '_ {
        let (all, few) = match &self.index {
            None => (0..self.points.len(), None),
            Some(index) => (0..0, Some(index.meeting((low, high)))),
        };
        let sides = all.chain(few.into_iter().flatten()).map(|i| self.side(i));
        sides.filter(move |(a, b)| {
            a.x.min(b.x) <= high.x
                && low.x <= a.x.max(b.x)
                && a.y.min(b.y) <= high.y
                && low.y <= a.y.max(b.y)
        })
    }

    /// Returns whether a point lies inside.
    ///
    /// The test is the winding number of the sides around the point, counted along a ray to the
    /// right.
    pub fn holds(&self, point: Point2<f64>) -> bool {
        let (low, high) = self.bounds;
        if point.x < low.x || point.y < low.y || high.x < point.x || high.y < point.y {
            return false;
        }
        let mut winding = 0;
        for (a, b) in self.sides_meeting((point, Point2::new(high.x, point.y))) {
            let along = b - a;
            if (a.y <= point.y) != (b.y <= point.y) && along.perp(&(point - a)) * along.y > 0.0 {
                winding += if b.y > a.y { 1 } else { -1 };
            }
        }
        winding > 0
    }
}

/// Returns the outlines of all obstacles of a scenario.
///
/// # Errors
/// If an obstacle has an impossible number, or there are too many of them.
pub fn outlines(obstacles: &[Obstacle]) -> Result<Vec<Outline>, WorldError> {
    if obstacles.len() > MAX_OBSTACLES {
        return Err(WorldError::TooManyObstacles(obstacles.len()));
    }
    let points_of = |o: &Obstacle| match &o.shape {
        Shape::Polygon(points) => points.len(),
        Shape::Circle { .. } => CIRCLE_SIDES as usize,
        Shape::Rectangle { .. } | Shape::Wall { .. } => 4,
    };
    let total = obstacles.iter().map(points_of).fold(0, usize::saturating_add);
    if total > MAX_POINTS {
        return Err(WorldError::TooManyPoints(total));
    }
    let outline = |(number, obstacle): (usize, &Obstacle)| {
        let check = Check { obstacle: number, kind: obstacle.shape.kind() };
        let points = check.points(&obstacle.shape)?;
        Ok(Outline::new(points, obstacle.surface))
    };
    obstacles.iter().enumerate().map(outline).collect()
}

/// Removes outlines that repeat an earlier one point by point.
pub(crate) fn distinct(mut outlines: Vec<Outline>) -> Vec<Outline> {
    let mut seen = BTreeSet::new();
    outlines.retain(|outline| {
        let bits = outline.points.iter().map(|p| (p.x.to_bits(), p.y.to_bits()));
        seen.insert((outline.surface == Surface::Rough, bits.collect::<Vec<_>>()))
    });
    outlines
}

/// Twice the signed area of a polygon, relative to its first point.
pub(crate) fn twice_area(points: &[Point2<f64>]) -> f64 {
    let Some(&first) = points.first() else { return 0.0 };
    points.windows(2).map(|w| (w[0] - first).perp(&(w[1] - first))).sum()
}

/// Checks the numbers of one obstacle.
#[derive(Clone, Copy)]
struct Check {
    obstacle: usize,
    kind: &'static str,
}

impl Check {
    fn points(self, shape: &Shape) -> Result<Vec<Point2<f64>>, WorldError> {
        match *shape {
            Shape::Rectangle { center, size, angle } => {
                let center = self.point(center)?;
                let half = 0.5 * self.length("width", size.0)?;
                let up = 0.5 * self.length("height", size.1)?;
                let (sin, cos) = libm::sincos(self.number(angle)?);
                let (x, y) = (Vector2::new(cos, sin) * half, Vector2::new(-sin, cos) * up);
                Ok(vec![center - x - y, center + x - y, center + x + y, center - x + y])
            }
            Shape::Wall { from, to, thickness } => {
                let (from, to) = (self.point(from)?, self.point(to)?);
                let along = to - from;
                let length = self.length("length", along.norm())?;
                let half = 0.5 * self.length("thickness", thickness)?;
                let side = Vector2::new(-along.y, along.x) * (half / length);
                Ok(vec![from - side, to - side, to + side, from + side])
            }
            Shape::Circle { center, radius } => {
                let center = self.point(center)?;
                let radius = self.length("radius", radius)?;
                let vertex = |i: u32| {
                    let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(CIRCLE_SIDES));
                    center + Vector2::new(cos, sin) * radius
                };
                Ok((0..CIRCLE_SIDES).map(vertex).collect())
            }
            Shape::Polygon(ref points) => self.polygon(points),
        }
    }

    fn number(self, value: f64) -> Result<f64, WorldError> {
        let Self { obstacle, kind } = self;
        // Not finite numbers compare as false.
        if value.abs() <= 2.0 * MAX_EXTENT {
            Ok(value)
        } else {
            Err(WorldError::Number { obstacle, kind, value })
        }
    }

    fn point(self, (x, y): (f64, f64)) -> Result<Point2<f64>, WorldError> {
        Ok(Point2::new(self.number(x)?, self.number(y)?))
    }

    fn length(self, what: &'static str, value: f64) -> Result<f64, WorldError> {
        let Self { obstacle, kind } = self;
        if self.number(value)? >= MIN_LENGTH {
            Ok(value)
        } else {
            Err(WorldError::Length { obstacle, kind, what, value })
        }
    }

    fn polygon(self, given: &[(f64, f64)]) -> Result<Vec<Point2<f64>>, WorldError> {
        let obstacle = self.obstacle;
        if given.len() > MAX_POLYGON_POINTS {
            return Err(WorldError::TooManyPolygonPoints { obstacle, points: given.len() });
        }
        let mut points: Vec<Point2<f64>> = Vec::with_capacity(given.len());
        // The index in `given` of each point.
        let mut numbers = Vec::with_capacity(given.len());
        for (number, &pair) in given.iter().enumerate() {
            let point = self.point(pair)?;
            if points.last().is_none_or(|last| (point - last).norm() > SAME_POINT) {
                points.push(point);
                numbers.push(number);
            }
        }
        while points.len() > 1 && (points[points.len() - 1] - points[0]).norm() <= SAME_POINT {
            points.pop();
        }
        if points.len() < 3 {
            return Err(WorldError::TooFewPoints { obstacle, points: points.len() });
        }
        let area = twice_area(&points);
        let is_flat = area.abs() < 2.0 * MIN_AREA;
        if is_flat && lie_on_a_line(&points) {
            return Err(WorldError::Flat { obstacle });
        }
        if let Some((first, second)) = crossing_sides(&points) {
            let Point2 { coords } = meeting_point(&points, first, second);
            let (first, second) = (numbers[first], numbers[second]);
            return Err(WorldError::SelfCrossing {
                obstacle,
                first,
                second,
                x: coords.x,
                y: coords.y,
            });
        }
        if is_flat {
            return Err(WorldError::TooSmall { obstacle, area: 0.5 * area.abs() });
        }
        if area < 0.0 {
            points.reverse();
        }
        Ok(points)
    }
}

/// Returns two sides of a closed polygon, each by its first point, that meet where they should
/// not.
///
/// Sides are compared in order of their left ends: only those that overlap in x meet.
fn crossing_sides(points: &[Point2<f64>]) -> Option<(usize, usize)> {
    let n = points.len();
    let side = |i: usize| (points[i], points[(i + 1) % n]);
    let left = |i: usize| side(i).0.x.min(side(i).1.x);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| left(i).total_cmp(&left(j)).then(i.cmp(&j)));
    for (rank, &i) in order.iter().enumerate() {
        let (a, b) = side(i);
        let right = a.x.max(b.x);
        for &j in order[rank + 1..].iter().take_while(|&&j| left(j) <= right) {
            let meet = if (i + 1) % n == j {
                folds_back(a, b, side(j).1)
            } else if (j + 1) % n == i {
                folds_back(side(j).0, a, b)
            } else {
                touch(a, b, side(j).0, side(j).1)
            };
            if meet {
                return Some((i.min(j), i.max(j)));
            }
        }
    }
    None
}

/// Returns whether the points lie on a line: none is farther than the shortest length from the
/// line through two points that are far apart.
fn lie_on_a_line(points: &[Point2<f64>]) -> bool {
    let farthest_from = |from: Point2<f64>| {
        let farther =
            |a: &&Point2<f64>, b: &&Point2<f64>| (*a - from).norm().total_cmp(&(*b - from).norm());
        points.iter().max_by(farther).copied().unwrap_or(from)
    };
    let from = farthest_from(points[0]);
    let along = farthest_from(from) - from;
    points.iter().all(|p| along.perp(&(p - from)).abs() <= MIN_LENGTH * along.norm())
}

/// Returns the approximate place where two sides meet, each given by its first point.
fn meeting_point(points: &[Point2<f64>], first: usize, second: usize) -> Point2<f64> {
    let side = |i: usize| (points[i], points[(i + 1) % points.len()]);
    let ((a, b), (c, d)) = (side(first), side(second));
    let sine = (b - a).perp(&(d - c));
    let share = (c - a).perp(&(d - c)) / sine;
    // Sides that lie on each other, or next to each other.
    if (0.0..=1.0).contains(&share) { a + (b - a) * share } else { c }
}

/// Returns whether the path a → b → c turns back onto itself.
fn folds_back(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>) -> bool {
    let (before, after) = (b - a, c - b);
    before.dot(&after) < 0.0 && before.perp(&after).abs() <= 1e-14 * before.norm() * after.norm()
}

/// Returns whether the segments ab and cd have a point in common.
fn touch(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>, d: Point2<f64>) -> bool {
    if a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y) {
        return false;
    }
    if a.x.max(b.x) < c.x.min(d.x) || c.x.max(d.x) < a.x.min(b.x) {
        return false;
    }
    let (ab, cd) = (b - a, d - c);
    ab.perp(&(c - a)) * ab.perp(&(d - a)) <= 0.0 && cd.perp(&(a - c)) * cd.perp(&(b - c)) <= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Result<Vec<Point2<f64>>, WorldError> {
        Check { obstacle: 3, kind: "Polygon" }.polygon(points)
    }

    #[test]
    fn a_polygon_may_have_either_winding_and_close_itself() {
        let square = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)];
        let points = polygon(&square).unwrap();
        assert_eq!(points.len(), 4);
        assert!(twice_area(&points) > 0.0);
    }

    #[test]
    fn a_polygon_that_is_not_simple_is_refused() {
        let bow = [(0.0, 0.0), (2.0, 1.0), (2.0, 0.0), (0.0, 2.0)];
        // Both halves of the bow have the same size: the signed area is zero.
        let even_bow = [(1.0, 1.0), (3.0, 3.0), (3.0, 1.0), (1.0, 3.0)];
        let spike = [(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (1.0, 0.0), (1.0, 1.0)];
        let pinch = [(0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0)];
        let line = [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)];
        for refused in [&bow[..], &even_bow, &spike, &pinch] {
            let error = polygon(refused).unwrap_err();
            assert!(matches!(error, WorldError::SelfCrossing { obstacle: 3, .. }), "{error}");
        }
        assert_eq!(polygon(&line), Err(WorldError::Flat { obstacle: 3 }));
        let speck = [(0.0, 0.0), (1e-7, 0.0), (0.0, 1e-7)];
        assert_eq!(polygon(&speck), Err(WorldError::Flat { obstacle: 3 }));
        let few = polygon(&[(0.0, 0.0), (1.0, 1.0), (0.0, 0.0)]).unwrap_err();
        assert_eq!(
            few.to_string(),
            "obstacle 3 (Polygon): 2 different points; a polygon needs at least 3"
        );
    }

    #[test]
    fn where_a_polygon_crosses_itself_is_said_by_its_own_points() {
        let bow = [(1.0, 1.0), (1.0, 1.0), (3.0, 3.0), (3.0, 1.0), (1.0, 3.0)];
        assert_eq!(
            polygon(&bow).unwrap_err().to_string(),
            "obstacle 3 (Polygon): the sides from points 0 and 3 cross or touch near \
             (2.000, 2.000); split it into simple polygons"
        );
    }

    #[test]
    fn a_comb_of_ten_thousand_points_is_checked_in_no_time() {
        let mut comb: Vec<(f64, f64)> =
            (0..4999).map(|i| (f64::from(i) * 0.1, if i % 2 == 0 { 1.0 } else { 9.0 })).collect();
        comb.extend([(499.8, 0.0), (0.0, 0.0)]);
        assert_eq!(polygon(&comb).unwrap().len(), 5001);
    }
}
