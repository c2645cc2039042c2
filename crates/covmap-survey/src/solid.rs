//! The solids of a survey, and their exact coverage.

use super::line::Line;
use super::{Post, Side, Survey, WallSegment};
use covmap::{Grid, Raster};
use covmap_world::WorldError;
use covmap_world::geometry::Solids;
use covmap_world::geometry::{Outline, outlines};
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface};
use nalgebra::{Point2, Vector2};

/// Ends of walls that are this near to each other are one corner [m].
const SAME: f64 = 0.005;
/// Walls that turn by less than this leave no gap behind their corner (the sine).
const STRAIGHT: f64 = 0.1;
/// The largest distance of the back of a corner from its front, in thicknesses [1].
const FAR: f64 = 3.0;

impl WallSegment {
    /// Returns the line of the front, seen from its left, and its length; `None` without length.
    pub(super) fn front(&self) -> Option<(Line, f64)> {
        let [from, to] = [self.from, self.to].map(|(x, y)| Point2::new(x, y));
        let (from, to) = if self.seen_from == Side::Left { (from, to) } else { (to, from) };
        Some((Line::through(from, to)?, (to - from).norm()))
    }

    /// Returns the solid behind the front.
    fn shape(&self) -> Shape {
        let thickness = self.thickness;
        let Some((line, length)) = self.front() else {
            return Shape::Wall { from: self.from, to: self.to, thickness };
        };
        let middle = line.back() * (0.5 * thickness);
        let (from, to) = (line.at + middle, line.point(length) + middle);
        Shape::Wall { from: (from.x, from.y), to: (to.x, to.y), thickness }
    }
}

impl Survey {
    /// Returns the outlines of walls, posts and other solids, in this order; then those of the
    /// solids behind the corners of rooms, between the walls that meet there.
    pub(super) fn outlines(&self) -> Result<Vec<Outline>, WorldError> {
        let mut all = outlines(&obstacles(self.shapes()))?;
        all.extend(outlines(&obstacles(corners(&self.walls).into_iter()))?);
        Ok(all)
    }

    fn shapes(&self) -> impl Iterator<Item = Shape> {
        let walls = self.walls.iter().map(WallSegment::shape);
        let posts = self.posts.iter();
        let posts = posts.map(|&Post { center, radius }| Shape::Circle { center, radius });
        walls.chain(posts).chain(self.solids.iter().cloned())
    }

    /// Returns the world of the surveyed solids, and the place of its lower left corner in the
    /// survey.
    ///
    /// The solids have rough surfaces, and free space of width `margin` \[m\] around them.
    ///
    /// # Errors
    /// As [`Survey::coverage`].
    pub fn scenario(&self, name: &str, margin: f64) -> Result<(Scenario, Point2<f64>), WorldError> {
        let [low, high] = self.bounds()?.unwrap_or_default();
        let corner = low - Vector2::repeat(margin);
        let size = high - corner + Vector2::repeat(margin);
        let shapes = self.shapes().chain(corners(&self.walls));
        let moved = shapes.map(|shape| shape.moved(0.0, &|(x, y)| (x - corner.x, y - corner.y)));
        let extent = Extent { width: size.x, height: size.y };
        let obstacles = obstacles(moved);
        Ok((Scenario { name: name.to_owned(), extent, start: None, obstacles }, corner))
    }

    /// Returns the exact coverage of every cell of a grid: the share of its area that lies in a
    /// solid.
    ///
    /// Each place counts once. Solid are the space behind a front, up to its thickness; the space
    /// between two walls that meet in the corner of a room; and posts and other solids.
    ///
    /// # Errors
    /// If a primitive has a number that is not finite, absurd or not positive, or a polygon is not
    /// simple. The error counts walls first, then posts, then the other solids.
    pub fn coverage(&self, grid: &Grid) -> Result<Raster<f64>, WorldError> {
        let outlines = self.outlines()?;
        let all = Vector2::repeat(f64::INFINITY);
        let bounds = (Point2::from(-all), Point2::from(all));
        Ok(Solids { outlines: &outlines, bounds, disjoint: false }.coverage(grid))
    }

    /// Returns the corners of the smallest box around all solids \[m\]; `None` without solids.
    ///
    /// # Errors
    /// As [`Survey::coverage`].
    pub fn bounds(&self) -> Result<Option<[Point2<f64>; 2]>, WorldError> {
        let outlines = self.outlines()?;
        let all = outlines.iter().map(Outline::bounds);
        let all = all.reduce(|(low, high), (from, to)| (low.inf(&from), high.sup(&to)));
        Ok(all.map(|(low, high)| [low, high]))
    }
}

fn obstacles(shapes: impl Iterator<Item = Shape>) -> Vec<Obstacle> {
    shapes.map(|shape| Obstacle { shape, surface: Surface::Rough }).collect()
}

/// Returns the solids behind the corners where one wall ends, the next begins, and the room between
/// the walls is less than half a turn wide.
fn corners(walls: &[WallSegment]) -> Vec<Shape> {
    let fronts: Vec<(Line, f64, f64)> = walls
        .iter()
        .filter_map(|w| w.front().map(|(line, length)| (line, length, w.thickness)))
        .collect();
    let mut begins: Vec<usize> = (0..fronts.len()).collect();
    begins.sort_by(|&i, &j| fronts[i].0.at.x.total_cmp(&fronts[j].0.at.x));
    let mut found = Vec::new();
    for (line, length, thickness) in &fronts {
        let end = line.point(*length);
        let first = begins.partition_point(|&i| fronts[i].0.at.x < end.x - SAME);
        for &i in begins[first..].iter().take_while(|&&i| fronts[i].0.at.x <= end.x + SAME) {
            let (next, _, depth) = &fronts[i];
            if (next.at - end).norm() <= SAME {
                found.extend(corner(end, (line, *thickness), (next, *depth)));
            }
        }
    }
    found
}

fn corner(at: Point2<f64>, before: (&Line, f64), after: (&Line, f64)) -> Option<Shape> {
    let (a, b) = (before.0.back(), after.0.back());
    let sine = a.perp(&b);
    if sine < STRAIGHT {
        return None;
    }
    // The point where the backs of both walls meet: a · v and b · v are the thicknesses.
    let v = Vector2::new(before.1 * b.y - after.1 * a.y, after.1 * a.x - before.1 * b.x) / sine;
    let mut points = vec![at, at + a * before.1, at + v, at + b * after.1];
    if v.norm() > FAR * before.1.max(after.1) || v.perp(&a) > 0.0 || b.perp(&v) > 0.0 {
        points.remove(2);
    }
    Some(Shape::Polygon(points.iter().map(|p| (p.x, p.y)).collect()))
}
