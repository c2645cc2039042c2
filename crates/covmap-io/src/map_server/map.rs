//! What a map of ROS says.

use covmap::{Cell, Grid, Raster};
use nalgebra::{Isometry2, Point2, Vector2};
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

/// A yaw that moves no cell by more than this share of a cell from a whole number of quarter
/// turns is one, written with few digits.
const ROUNDED: f64 = 0.25;

/// What a map says of one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MapCell {
    /// Nothing.
    Unknown,
    /// How occupied it is, in [0, 1]: free 0, occupied 1.
    Occupancy(f64),
}

impl MapCell {
    /// Whether a robot cannot be there: in occupied and in unknown cells.
    ///
    /// Reading: a cell of graded occupancy (`scale`, `raw`) is occupied from one half on.
    pub fn is_solid(self) -> bool {
        match self {
            Self::Unknown => true,
            Self::Occupancy(occupancy) => occupancy >= 0.5,
        }
    }
}

/// How much of the image is what \[m²\], also where it was cut away.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MapAreas {
    /// Free.
    pub free: f64,
    /// Occupied.
    pub occupied: f64,
    /// Unknown.
    pub unknown: f64,
    /// The part of the free area that is painted in the grey which programs that save maps
    /// give to unknown cells: the thresholds make it free.
    pub unknown_grey_is_free: f64,
}

/// A map of ROS: what map_server would publish of it, without what is unknown around it.
#[derive(Debug, Clone, PartialEq)]
pub struct MapServerMap {
    /// The geometry, before the map is turned: one cell for each pixel of the smallest
    /// rectangle of the image that holds all that is known.
    pub grid: Grid,
    /// What the map says of each cell.
    pub cells: Raster<MapCell>,
    /// Turns the map about the origin that its file names; the identity for a yaw of 0. Quarter
    /// turns are in `cells` already.
    pub world_from_map: Isometry2<f64>,
    /// How much of the image is free, occupied, unknown.
    pub areas: MapAreas,
    /// Columns and rows of the image.
    pub image_size: (usize, usize),
    /// The image that was read, if it is not where the file says but beside the file.
    pub image_beside: Option<PathBuf>,
}

impl MapServerMap {
    /// Where a robot cannot be: in occupied and in unknown cells.
    pub fn solid(&self) -> Raster<bool> {
        self.cells.map(|cell| cell.is_solid())
    }

    /// Turns a map that is not turned yet about a point, counter-clockwise \[rad\]: cells as
    /// far as quarter turns go, and the whole map by what is left.
    pub(super) fn turn(&mut self, origin: Point2<f64>, yaw: f64) {
        let quarters = (yaw / FRAC_PI_2).round();
        let rest = yaw - quarters * FRAC_PI_2;
        let corners = [Cell::new(0, 0), beyond(&self.grid)];
        let [low, high] = corners.map(|cell| self.grid.lower_corner(cell) - origin);
        let reach = low.abs().sup(&high.abs()).norm();
        if rest.abs() * reach > ROUNDED * self.grid.resolution() {
            let turn = Isometry2::rotation(yaw);
            self.world_from_map = Isometry2::new(origin - turn * origin, yaw);
            return;
        }
        #[allow(clippy::cast_possible_truncation, reason = "in 0..4")]
        for _ in 0..quarters.rem_euclid(4.0) as u8 {
            let turned = quarter_turned(&self.cells, origin);
            self.cells = turned.unwrap_or_else(|| unreachable!("as many cells as before"));
        }
        self.grid = *self.cells.grid();
    }
}

/// The cell whose lower corner is the upper corner of a grid.
#[allow(clippy::cast_possible_truncation, reason = "a grid has at most 2e7 cells")]
fn beyond(grid: &Grid) -> Cell {
    Cell::new(grid.width() as i32, grid.height() as i32)
}

/// A raster turned by 90° about a point, counter-clockwise.
fn quarter_turned<T: Copy>(cells: &Raster<T>, origin: Point2<f64>) -> Option<Raster<T>> {
    let (grid, Cell { x: width, y: height }) = (cells.grid(), beyond(cells.grid()));
    let upper_left = grid.lower_corner(Cell::new(0, height)) - origin;
    let corner = origin + Vector2::new(-upper_left.y, upper_left.x);
    let turned = Grid::new(corner, grid.resolution(), grid.height(), grid.width()).ok()?;
    let from = (0..width).flat_map(|x| (0..height).rev().map(move |y| Cell::new(x, y)));
    Raster::from_values(turned, from.filter_map(|cell| cells.get(cell).copied()).collect())
}
