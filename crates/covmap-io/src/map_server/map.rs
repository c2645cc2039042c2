//! The content of a map of ROS.

use covmap::{Cell, Grid, Raster};
use nalgebra::{Isometry2, Point2, Vector2};
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

/// A yaw counts as a whole number of quarter turns, written with few digits, if no cell moves by
/// more than this share of a cell from there.
const ROUNDED: f64 = 0.25;

/// The content of one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MapCell {
    /// Nothing is known.
    Unknown,
    /// Occupancy in [0, 1]: free 0, occupied 1.
    Occupancy(f64),
}

impl MapCell {
    /// Returns whether a robot cannot be there: in occupied and in unknown cells.
    ///
    /// Reading: a cell of graded occupancy (`scale`, `raw`) is occupied from one half on.
    pub fn is_solid(self) -> bool {
        match self {
            Self::Unknown => true,
            Self::Occupancy(occupancy) => occupancy >= 0.5,
        }
    }
}

/// Areas of the free, occupied and unknown parts of the image \[m²\], including the parts that were cut away.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MapAreas {
    /// Free area.
    pub free: f64,
    /// Occupied area.
    pub occupied: f64,
    /// Unknown area.
    pub unknown: f64,
    /// The part of the free area that is painted in the grey that map-saving programs give to
    /// unknown cells: the thresholds make it free.
    pub unknown_grey_is_free: f64,
}

/// A map of ROS: as map_server would publish it, without the unknown border.
#[derive(Debug, Clone, PartialEq)]
pub struct MapServerMap {
    /// The geometry, before `world_from_map` turns the map: one cell for each pixel of the smallest
    /// rectangle of the image that holds all known pixels.
    pub grid: Grid,
    /// The content of each cell.
    pub cells: Raster<MapCell>,
    /// Turns the map about the origin that its file names; the identity if the yaw is a whole
    /// number of quarter turns, which are in `cells` already.
    pub world_from_map: Isometry2<f64>,
    /// Areas of the free, occupied and unknown parts of the image.
    pub areas: MapAreas,
    /// Columns and rows of the image.
    pub image_size: (usize, usize),
    /// Path of the image that was read, if it was found beside the YAML file and not where the file says.
    pub image_beside: Option<PathBuf>,
}

impl MapServerMap {
    /// Returns the cells where a robot cannot be: occupied and unknown ones.
    pub fn solid(&self) -> Raster<bool> {
        self.cells.map(|cell| cell.is_solid())
    }

    /// Turns a map that is not turned yet about a point, counter-clockwise \[rad\]: its cells for a
    /// whole number of quarter turns, else the whole map.
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

/// Returns the cell whose lower corner is the upper corner of a grid.
#[allow(clippy::cast_possible_truncation, reason = "a grid has at most 2e7 cells")]
fn beyond(grid: &Grid) -> Cell {
    Cell::new(grid.width() as i32, grid.height() as i32)
}

/// Returns a raster turned by 90° about a point, counter-clockwise.
fn quarter_turned<T: Copy>(cells: &Raster<T>, origin: Point2<f64>) -> Option<Raster<T>> {
    let (grid, Cell { x: width, y: height }) = (cells.grid(), beyond(cells.grid()));
    let upper_left = grid.lower_corner(Cell::new(0, height)) - origin;
    let corner = origin + Vector2::new(-upper_left.y, upper_left.x);
    let turned = Grid::new(corner, grid.resolution(), grid.height(), grid.width()).ok()?;
    let from = (0..width).flat_map(|x| (0..height).rev().map(move |y| Cell::new(x, y)));
    Raster::from_values(turned, from.filter_map(|cell| cells.get(cell).copied()).collect())
}
