//! The world itself: faces, solids and what they enclose.

use crate::error::{MAX_EXTENT, MIN_LENGTH, WorldError};
use crate::geometry::{Bounds, Face, Feature, Index, feature};
use crate::outline::{Outline, outlines};
use crate::raster_world;
use crate::scenario::{Scenario, Surface};
use covmap::{Grid, GridError, Raster};
use nalgebra::{Isometry2, Point2, Vector2};
use std::f64::consts::TAU;

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
    /// What is solid inside the extent; with `disjoint`, no two overlap.
    pub(crate) outlines: Vec<Outline>,
    pub(crate) disjoint: bool,
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
    /// The world that a scenario describes; everything outside of its extent is solid, with
    /// the surface `outside`.
    ///
    /// # Errors
    /// If the scenario has a number that is not finite, absurd or not positive, a polygon
    /// that is not simple, too many obstacles, or a start that is not free.
    pub fn from_scenario(scenario: &Scenario, outside: Surface) -> Result<Self, WorldError> {
        let size = Vector2::new(scenario.extent.width, scenario.extent.height);
        if !size.iter().all(|v| (MIN_LENGTH..=MAX_EXTENT).contains(v)) {
            return Err(WorldError::Extent(size.x, size.y));
        }
        let outlines = outlines(&scenario.obstacles)?;
        let (low, high) = (Point2::origin(), Point2::from(size));
        let mut faces = Vec::new();
        let mut features = Vec::new();
        for outline in &outlines {
            add_ring(&mut faces, &mut features, &outline.points, outline.surface);
        }
        // Clockwise: the solid is on the left, outside.
        let border = [low, Point2::new(low.x, high.y), high, Point2::new(high.x, low.y)];
        add_ring(&mut faces, &mut features, &border, outside);
        let (name, extent) = (&scenario.name, (low, high));
        let mut world = Self::new(name, extent, outlines, faces, features)?;
        world.find_corners()?;
        if let Some(start) = scenario.start {
            let (x, y, heading) = (start.x, start.y, start.heading);
            if !heading.is_finite() || heading.abs() > 1e6 || !world.is_inside(Point2::new(x, y)) {
                return Err(WorldError::StartOutside(x, y, heading));
            }
            if world.is_solid(Point2::new(x, y)) {
                return Err(WorldError::StartInObstacle(x, y));
            }
            world.start = Some(Isometry2::new(Vector2::new(x, y), heading));
        }
        Ok(world)
    }

    /// The world in which each `true` cell of a raster is a solid square with a surface, and
    /// everything outside of the raster is solid too.
    ///
    /// Faces of cells in a row are one smooth face.
    ///
    /// # Errors
    /// If the name cannot name a file, or a side is longer than 10 km.
    pub fn from_raster(
        name: &str,
        solid: &Raster<bool>,
        surface: Surface,
    ) -> Result<Self, WorldError> {
        let grid = solid.grid();
        let low = grid.lower_left();
        #[allow(clippy::cast_precision_loss, reason = "a grid has at most 2e7 cells")]
        let high =
            low + Vector2::new(grid.width() as f64, grid.height() as f64) * grid.resolution();
        let size = high - low;
        let far = low.coords.amax().max(high.coords.amax()) > 100.0 * MAX_EXTENT;
        if far || !size.iter().all(|v| (MIN_LENGTH..=MAX_EXTENT).contains(v)) {
            return Err(WorldError::Extent(size.x, size.y));
        }
        let outlines = raster_world::rectangles(solid, surface);
        let (faces, features) = raster_world::boundary(solid, surface);
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
        let (name, start, disjoint) = (name.to_owned(), None, false);
        Ok(Self {
            name,
            low,
            high,
            start,
            outlines,
            disjoint,
            faces,
            index,
            features,
            feature_index,
        })
    }

    /// Adds the corners between different outlines, and drops what is hidden in a solid.
    fn find_corners(&mut self) -> Result<(), WorldError> {
        let mut features = feature::between(&self.faces, &self.index)?;
        features.append(&mut self.features);
        features.retain(|f| self.touches_free_space(f.at));
        features.sort_by(|f, g| {
            f.at.x.total_cmp(&g.at.x).then(f.at.y.total_cmp(&g.at.y)).then(f.kind.cmp(&g.kind))
        });
        features.dedup();
        self.feature_index = index_of(self.low, &features);
        self.features = features;
        Ok(())
    }

    /// The world's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The lower left corner of the extent \[m\].
    pub fn lower_left(&self) -> Point2<f64> {
        self.low
    }

    /// Width and height of the extent \[m\].
    pub fn size(&self) -> Vector2<f64> {
        self.high - self.low
    }

    /// The grid of cells of side `resolution` \[m\] over the extent, aligned to its lower
    /// left corner, with a margin of at least .30 m and two cells, so that the outer wall has
    /// its cells.
    ///
    /// # Errors
    /// If the resolution is not positive, or makes too many cells.
    pub fn grid(&self, resolution: f64) -> Result<Grid, GridError> {
        let cells = (MARGIN / resolution - 1e-9).ceil().clamp(MARGIN_CELLS, 1e5);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped; a resolution that is not a number is refused next"
        )]
        Grid::covering(self.low, self.size(), resolution, cells as usize)
    }

    /// The start that the scenario gives: `world_from_robot`.
    ///
    /// Its centre is free; whether the robot fits there is for the caller to ask with
    /// [`World::clearance`].
    pub fn given_start(&self) -> Option<Isometry2<f64>> {
        self.start
    }

    /// The distance from a point to the nearest solid \[m\]; 0 inside a solid and outside of
    /// the extent.
    pub fn clearance(&self, point: Point2<f64>) -> f64 {
        if self.is_solid(point) {
            return 0.0;
        }
        let distance = |face: usize| Some((point - self.faces[face].nearest(point)).norm());
        self.index.nearest_to(point, f64::INFINITY, distance).map_or(0.0, |(_, d)| d)
    }

    /// Whether a point lies inside a solid or outside of the extent.
    pub fn is_solid(&self, point: Point2<f64>) -> bool {
        if !self.is_inside(point) {
            return true;
        }
        // The winding number around the point of all faces, counted along a ray to the right.
        // The border runs clockwise around what is free: −1 there, and more in a solid.
        let right = Point2::new(f64::INFINITY, point.y);
        let mut winding = 0;
        for face in self.index.meeting((point, right)) {
            let Face { a, b, along, .. } = self.faces[face];
            if (a.y <= point.y) != (b.y <= point.y) && along.perp(&(point - a)) * along.y > 0.0 {
                winding += if b.y > a.y { 1 } else { -1 };
            }
        }
        winding >= 0
    }

    /// The distance at which a ray first meets a solid \[m\], if within `max` \[m\]; 0 if it
    /// starts in one. `direction` is a unit vector.
    pub fn cast_ray(&self, origin: Point2<f64>, direction: Vector2<f64>, max: f64) -> Option<f64> {
        if self.is_solid(origin) {
            return Some(0.0);
        }
        self.first_hit(origin, direction, max).map(|hit| hit.distance)
    }

    /// The first face that a ray from free space enters within `max` \[m\].
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

    /// The faces whose boxes meet a box.
    pub(crate) fn faces_meeting(&self, bounds: Bounds) -> impl Iterator<Item = usize> + '_ {
        self.index.meeting(bounds)
    }

    /// Whether there is free space a hair beside a point.
    fn touches_free_space(&self, point: Point2<f64>) -> bool {
        let hair = |k: i32| {
            let (sin, cos) = libm::sincos(TAU * (f64::from(k) + 0.3) / 16.0);
            point + Vector2::new(cos, sin) * 1e-5
        };
        (0..16).any(|k| !self.is_solid(hair(k)))
    }

    fn is_inside(&self, point: Point2<f64>) -> bool {
        // Not a number is outside.
        (self.low.x..=self.high.x).contains(&point.x)
            && (self.low.y..=self.high.y).contains(&point.y)
    }

    /// The corners of the extent \[m\].
    pub(crate) fn bounds(&self) -> Bounds {
        (self.low, self.high)
    }
}

fn index_of(origin: Point2<f64>, features: &[Feature]) -> Index {
    let boxes: Vec<Bounds> = features.iter().map(|f| (f.at, f.at)).collect();
    Index::new(origin, &boxes)
}

/// Adds the faces of a closed ring of points, and what they make where they join.
fn add_ring(
    faces: &mut Vec<Face>,
    features: &mut Vec<Feature>,
    points: &[Point2<f64>],
    surface: Surface,
) {
    let first = faces.len();
    let next = points.iter().cycle().skip(1);
    faces.extend(points.iter().zip(next).map(|(&a, &b)| Face::new(a, b, surface)));
    let ring = &faces[first..];
    let after = ring.iter().cycle().skip(1);
    features.extend(ring.iter().zip(after).filter_map(|(f, g)| feature::of_joint(f, g)));
}
