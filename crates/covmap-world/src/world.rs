//! The world itself: faces, solids and the space that they enclose.

use crate::error::{MAX_BURIALS, MAX_EXTENT, MAX_HEADING, MIN_LENGTH, WorldError};
use crate::exposed::Exposed;
use crate::faces::{Bounds, Face, Index};
use crate::feature::{Feature, between, of_joint};
use crate::moved::beyond_sides;
use crate::outline::{Outline, distinct, outlines};
use crate::raster_world;
use crate::scenario::{Scenario, Surface};
use covmap::{Grid, GridError, Raster};
use nalgebra::{Isometry2, Point2, Vector2};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A grid reaches at least this far beyond the extent [m] …
const MARGIN: f64 = 0.30;
/// … and at least this many cells.
const MARGIN_CELLS: f64 = 2.0;

/// A simulated world: the truth.
///
/// Everything outside of its extent is solid.
#[derive(Debug, Clone)]
pub struct World {
    name: String,
    low: Point2<f64>,
    high: Point2<f64>,
    start: Option<Isometry2<f64>>,
    /// The solids inside the extent; with `disjoint`, no two overlap.
    pub(crate) outlines: Vec<Outline>,
    pub(crate) disjoint: bool,
    outline_index: Index,
    /// The faces that no solid buries.
    pub(crate) faces: Vec<Face>,
    index: Index,
    pub(crate) features: Vec<Feature>,
    pub(crate) feature_index: Index,
}

/// The first face that a ray meets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hit {
    pub(crate) distance: f64,
    pub(crate) face: usize,
}

impl World {
    /// Makes the world that a scenario describes.
    ///
    /// Everything outside of the scenario's extent is solid, with the surface `outside`.
    ///
    /// # Errors
    /// If the scenario has a number that is not finite, absurd or not positive, a polygon that is
    /// not simple, too many obstacles, or a start that is not free.
    pub fn from_scenario(scenario: &Scenario, outside: Surface) -> Result<Self, WorldError> {
        let size = Vector2::new(scenario.extent.width, scenario.extent.height);
        if !size.iter().all(|v| (MIN_LENGTH..=MAX_EXTENT).contains(v)) {
            return Err(WorldError::Extent(size.x, size.y));
        }
        let outlines = distinct(outlines(&scenario.obstacles)?);
        let (low, high) = (Point2::origin(), Point2::from(size));
        // Clockwise: the solid is on the left, outside.
        let border = [low, Point2::new(low.x, high.y), high, Point2::new(high.x, low.y)];
        let (name, extent) = (&scenario.name, (low, high));
        let mut world = Self::new(name, extent, outlines, Vec::new(), Vec::new())?;
        world.find_faces(&border, outside)?;
        if let Some(start) = scenario.start {
            let (x, y, heading) = (start.x, start.y, start.heading);
            // NaN is not a heading.
            if !(-MAX_HEADING..=MAX_HEADING).contains(&heading) {
                return Err(WorldError::StartHeading(heading));
            }
            if !world.is_inside(Point2::new(x, y)) {
                return Err(WorldError::StartOutside(x, y));
            }
            if world.is_solid(Point2::new(x, y)) {
                return Err(WorldError::StartInObstacle(x, y));
            }
            world.start = Some(Isometry2::new(Vector2::new(x, y), heading));
        }
        Ok(world)
    }

    /// Makes the world of a raster: each `true` cell is a solid square with a surface, and
    /// everything outside of the raster is solid too.
    ///
    /// Faces of cells in a row are one smooth face. The extent is that of the raster, without the
    /// solid cells more than .30 m beyond all free cells.
    ///
    /// # Errors
    /// If the name cannot name a file, or a side is longer than 10 km.
    pub fn from_raster(
        name: &str,
        solid: &Raster<bool>,
        surface: Surface,
    ) -> Result<Self, WorldError> {
        Self::from_turned_raster(name, solid, &Isometry2::identity(), surface)
    }

    /// Makes the world of a raster that `world_from_raster` turns and shifts, squares and all.
    ///
    /// The extent is the box around the turned raster.
    ///
    /// # Errors
    /// As [`World::from_raster`].
    pub fn from_turned_raster(
        name: &str,
        solid: &Raster<bool>,
        world_from_raster: &Isometry2<f64>,
        surface: Surface,
    ) -> Result<Self, WorldError> {
        let solid = raster_world::trimmed(solid, MARGIN);
        let grid = solid.grid();
        let low = grid.lower_left();
        let high =
            low + Vector2::new(grid.width() as f64, grid.height() as f64) * grid.resolution();
        let corners = [low, Point2::new(high.x, low.y), high, Point2::new(low.x, high.y)];
        let corners = corners.map(|corner| world_from_raster * corner);
        let low = corners[1..].iter().fold(corners[0], |low, corner| low.inf(corner));
        let high = corners[1..].iter().fold(corners[0], |high, corner| high.sup(corner));
        let size = high - low;
        let far = low.coords.amax().max(high.coords.amax()) > 100.0 * MAX_EXTENT;
        if far || !size.iter().all(|v| (MIN_LENGTH..=MAX_EXTENT).contains(v)) {
            return Err(WorldError::Extent(size.x, size.y));
        }
        let (mut outlines, (faces, features)) =
            raster_world::solids(&solid, world_from_raster, surface);
        let beyond = beyond_sides(corners, low, high).map(|triangle| triangle.to_vec());
        outlines.extend(beyond.map(|points| Outline::new(points, surface)));
        let mut world = Self::new(name, (low, high), outlines, faces, features)?;
        world.disjoint = true;
        Ok(world)
    }

    fn new(
        name: &str,
        (low, high): Bounds,
        outlines: Vec<Outline>,
        faces: Vec<Face>,
        features: Vec<Feature>,
    ) -> Result<Self, WorldError> {
        let allowed = |c: char| !(c.is_control() || matches!(c, '/' | '\\'));
        if !(1..=100).contains(&name.chars().count()) || !name.chars().all(allowed) {
            return Err(WorldError::Name(name.to_owned()));
        }
        let boxes: Vec<Bounds> = faces.iter().map(Face::bounds).collect();
        let index = Index::new(low, &boxes);
        let feature_index = index_of(low, &features);
        let boxes: Vec<Bounds> = outlines.iter().map(Outline::bounds).collect();
        let outline_index = Index::new(low, &boxes);
        let (name, start, disjoint) = (name.to_owned(), None, false);
        Ok(Self {
            name,
            low,
            high,
            start,
            outlines,
            disjoint,
            outline_index,
            faces,
            index,
            features,
            feature_index,
        })
    }

    /// Finds the faces of all outlines and of the border that are not buried, and the corners,
    /// edges and seams that they make in free space.
    fn find_faces(&mut self, border: &[Point2<f64>], outside: Surface) -> Result<(), WorldError> {
        let rings = self.outlines.iter().map(|o| (o.points.as_slice(), o.surface));
        let faces_of = |(number, (points, surface)): (usize, (&[Point2<f64>], Surface))| {
            let faces = points.iter().zip(points.iter().cycle().skip(1));
            faces.map(|(a, b)| (number, Face::new(*a, *b, surface))).collect::<Vec<_>>()
        };
        let all: Vec<(usize, Face)> =
            rings.chain([(border, outside)]).enumerate().flat_map(faces_of).collect();
        let pairs = AtomicUsize::new(0);
        let exposed: Vec<Exposed> = all
            .par_iter()
            .map(|(number, face)| self.exposed(face, *number, &pairs))
            .collect::<Result<_, _>>()?;
        let mut features = joints(&all, &exposed);
        let left = all.into_iter().zip(exposed).filter(|(_, exposed)| !exposed.is_empty());
        let (faces, exposed): (Vec<Face>, Vec<Exposed>) =
            left.map(|((_, face), exposed)| (face, exposed)).unzip();
        let boxes: Vec<Bounds> = faces.iter().map(Face::bounds).collect();
        (self.faces, self.index) = (faces, Index::new(self.low, &boxes));
        features.extend(between(&self.faces, &exposed, &self.index)?);
        let in_free_space =
            features.into_par_iter().filter(|(f, free)| self.touches_free_space(f.at, *free));
        let mut features: Vec<Feature> = in_free_space.map(|(feature, _)| feature).collect();
        features.sort_by(|f, g| {
            f.at.x.total_cmp(&g.at.x).then(f.at.y.total_cmp(&g.at.y)).then(f.kind.cmp(&g.kind))
        });
        features.dedup();
        self.feature_index = index_of(self.low, &features);
        self.features = features;
        Ok(())
    }

    /// Returns the parts of a face that the other outlines leave exposed; counts the pairs it
    /// examined.
    fn exposed(&self, face: &Face, own: usize, all: &AtomicUsize) -> Result<Exposed, WorldError> {
        let mut pairs = 0;
        let others = self.outline_index.meeting(face.bounds()).filter(|number| *number != own);
        let others = others.inspect(|_| pairs += 1).take(MAX_BURIALS);
        let exposed =
            Exposed::new(face, self.bounds(), others.map(|number| &self.outlines[number]));
        // The count does not depend on the order.
        let pairs = pairs + all.fetch_add(pairs, Ordering::Relaxed);
        if pairs > MAX_BURIALS { Err(WorldError::TooDense) } else { Ok(exposed) }
    }

    /// Returns the world's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the lower left corner of the extent \[m\].
    pub fn lower_left(&self) -> Point2<f64> {
        self.low
    }

    /// Returns the width and height of the extent \[m\].
    pub fn size(&self) -> Vector2<f64> {
        self.high - self.low
    }

    /// Returns the grid of cells of side `resolution` \[m\] over the extent.
    ///
    /// The grid is aligned to the extent's lower left corner. A margin of at least .30 m and two
    /// cells holds the outer wall.
    ///
    /// # Errors
    /// If the resolution is not positive, or gives too many cells.
    pub fn grid(&self, resolution: f64) -> Result<Grid, GridError> {
        let cells = (MARGIN / resolution - 1e-9).ceil().clamp(MARGIN_CELLS, 1e5);
        #[allow(
            clippy::cast_possible_truncation,
            reason = "clamped; a resolution that is not a number is refused next"
        )]
        Grid::covering(self.low, self.size(), resolution, cells as usize)
    }

    /// Returns the start that the scenario gives: `world_from_robot`.
    ///
    /// The start's centre is free; the caller asks [`World::clearance`] whether the robot fits
    /// there.
    pub fn given_start(&self) -> Option<Isometry2<f64>> {
        self.start
    }

    /// Returns the distance from a point to the nearest solid \[m\]; 0 inside a solid and outside
    /// of the extent.
    pub fn clearance(&self, point: Point2<f64>) -> f64 {
        if self.is_solid(point) {
            return 0.0;
        }
        let distance = |face: usize| Some((point - self.faces[face].nearest(point)).norm());
        self.index.nearest_to(point, f64::INFINITY, distance).map_or(0.0, |(_, d)| d)
    }

    /// Returns whether a point lies inside a solid or outside of the extent.
    pub fn is_solid(&self, point: Point2<f64>) -> bool {
        // NaN is outside. Solids hold their lower and left borders only.
        let free = (self.low.x..self.high.x).contains(&point.x)
            && (self.low.y..self.high.y).contains(&point.y);
        !free || self.outline_index.meeting((point, point)).any(|i| self.outlines[i].holds(point))
    }

    /// Returns the distance at which a ray first meets a solid \[m\], if within `max` \[m\].
    ///
    /// The distance is 0 if the ray starts in a solid. `direction` is a unit vector.
    pub fn cast_ray(&self, origin: Point2<f64>, direction: Vector2<f64>, max: f64) -> Option<f64> {
        if self.is_solid(origin) {
            return Some(0.0);
        }
        self.first_hit(origin, direction, max).map(|hit| hit.distance)
    }

    /// Returns the first face that a ray from free space enters within `max` \[m\].
    pub(crate) fn first_hit(
        &self,
        origin: Point2<f64>,
        direction: Vector2<f64>,
        max: f64,
    ) -> Option<Hit> {
        let entered = |face: usize| self.faces[face].entered_at(origin, direction);
        let found = self.index.first_along(origin, direction, max, entered);
        found.map(|(face, distance)| Hit { distance, face })
    }

    /// Returns the faces whose boxes meet a box.
    pub(crate) fn faces_meeting(&self, bounds: Bounds) -> impl Iterator<Item = usize> + '_ {
        self.index.meeting(bounds)
    }

    /// Returns whether there is free space a hair beside a point, in one of 16 directions, the
    /// likely ones first.
    fn touches_free_space(&self, point: Point2<f64>, likely: Vector2<f64>) -> bool {
        const DIRECTIONS: i32 = 16;
        let hair = |k: i32| {
            let (sin, cos) = libm::sincos(TAU * (f64::from(k) + 0.3) / f64::from(DIRECTIONS));
            point + Vector2::new(cos, sin) * 1e-5
        };
        let turns = libm::atan2(likely.y, likely.x) / TAU * f64::from(DIRECTIONS);
        #[allow(clippy::cast_possible_truncation, reason = "at most half a turn")]
        let first = turns.round() as i32;
        (first..first + DIRECTIONS).any(|k| !self.is_solid(hair(k.rem_euclid(DIRECTIONS))))
    }

    fn is_inside(&self, point: Point2<f64>) -> bool {
        // NaN is outside.
        (self.low.x..=self.high.x).contains(&point.x)
            && (self.low.y..=self.high.y).contains(&point.y)
    }

    /// Returns the corners of the extent \[m\].
    pub(crate) fn bounds(&self) -> Bounds {
        (self.low, self.high)
    }
}

fn index_of(origin: Point2<f64>, features: &[Feature]) -> Index {
    let boxes: Vec<Bounds> = features.iter().map(|f| (f.at, f.at)).collect();
    Index::new(origin, &boxes)
}

/// Returns the features at the exposed joints of each ring's faces, each with the direction where
/// free space may be.
fn joints(rings: &[(usize, Face)], exposed: &[Exposed]) -> Vec<(Feature, Vector2<f64>)> {
    let mut found = Vec::new();
    let mut exposed = exposed.iter();
    for ring in rings.chunk_by(|(ring, _), (next, _)| ring == next) {
        let after = ring.iter().cycle().skip(1);
        for (((_, face), (_, next)), exposed) in ring.iter().zip(after).zip(&mut exposed) {
            let joint = of_joint(face, next).filter(|_| exposed.holds(face.length));
            found.extend(joint.map(|joint| (joint, face.normal() + next.normal())));
        }
    }
    found
}
