//! Obstacles as simple polygons, checked and oriented.

use crate::error::{
    MAX_EXTENT, MAX_OBSTACLES, MAX_POINTS, MAX_POLYGON_POINTS, MIN_LENGTH, WorldError,
};
use crate::scenario::{Obstacle, Shape, Surface};
use nalgebra::{Point2, Vector2};
use std::f64::consts::TAU;

const CIRCLE_SIDES: u32 = 64;
/// Points in a row that are nearer to each other are one point [m].
const SAME_POINT: f64 = 1e-12;

/// A simple polygon, counter-clockwise, with at least three points.
#[derive(Debug, Clone)]
pub(crate) struct Outline {
    pub(crate) points: Vec<Point2<f64>>,
    pub(crate) surface: Surface,
}

impl Outline {
    pub(crate) fn bounds(&self) -> (Point2<f64>, Point2<f64>) {
        let first = self.points[0];
        self.points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
    }
}

/// The outlines of all obstacles of a scenario.
pub(crate) fn outlines(obstacles: &[Obstacle]) -> Result<Vec<Outline>, WorldError> {
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
        Ok(Outline { points, surface: obstacle.surface })
    };
    obstacles.iter().enumerate().map(outline).collect()
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
        for &pair in given {
            let point = self.point(pair)?;
            if points.last().is_none_or(|last| (point - last).norm() > SAME_POINT) {
                points.push(point);
            }
        }
        while points.len() > 1 && (points[points.len() - 1] - points[0]).norm() <= SAME_POINT {
            points.pop();
        }
        if points.len() < 3 {
            return Err(WorldError::TooFewPoints { obstacle, points: points.len() });
        }
        let area = twice_area(&points);
        if area.abs() < 2.0 * MIN_LENGTH * MIN_LENGTH * 1e-3 {
            return Err(WorldError::Flat { obstacle });
        }
        if let Some((first, second)) = crossing_sides(&points) {
            let Point2 { coords } = points[first.max(second)];
            let (x, y) = (coords.x, coords.y);
            return Err(WorldError::SelfCrossing { obstacle, first, second, x, y });
        }
        if area < 0.0 {
            points.reverse();
        }
        Ok(points)
    }
}

/// Two sides of a closed polygon, each by its first point, that meet where they should not.
///
/// Sides are compared in order of their left ends, so that only those that overlap in x meet.
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

/// Whether the path a → b → c turns back onto itself.
fn folds_back(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>) -> bool {
    let (before, after) = (b - a, c - b);
    before.dot(&after) < 0.0 && before.perp(&after).abs() <= 1e-14 * before.norm() * after.norm()
}

/// Whether the segments ab and cd have a point in common.
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
        let spike = [(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (1.0, 0.0), (1.0, 1.0)];
        let pinch = [(0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0)];
        let line = [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)];
        for refused in [&bow[..], &spike, &pinch] {
            let error = polygon(refused).unwrap_err();
            assert!(matches!(error, WorldError::SelfCrossing { obstacle: 3, .. }), "{error}");
        }
        assert_eq!(polygon(&line), Err(WorldError::Flat { obstacle: 3 }));
        let few = polygon(&[(0.0, 0.0), (1.0, 1.0), (0.0, 0.0)]).unwrap_err();
        assert_eq!(
            few.to_string(),
            "obstacle 3 (Polygon): 2 different points; a polygon needs at least 3"
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
