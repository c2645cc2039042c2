//! The geometry of a grid: cells ↔ world.

use crate::short;
use nalgebra::{Point2, Vector2};
use serde::{Deserialize, Serialize};

/// The largest number of cells that a grid may have.
pub const MAX_CELLS: usize = 20_000_000;

/// A cell by its column `x` and its row `y`, counted from the lower left corner.
///
/// Coordinates are signed, so offsets between cells can be added. Only [`Grid::index`] decides whether a cell
/// lies in a grid. Cells are ordered row by row; this project breaks all ties in that order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Cell {
    /// Column, growing to the right.
    pub x: i32,
    /// Row, growing upwards.
    pub y: i32,
}

impl Cell {
    /// Returns the cell in column `x` of row `y`.
    pub fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }

    /// Returns the cell `dx` columns to the right and `dy` rows up. Coordinates saturate at the
    /// bounds of `i32`.
    #[must_use]
    pub fn offset(self, dx: i32, dy: i32) -> Self {
        Self { x: self.x.saturating_add(dx), y: self.y.saturating_add(dy) }
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.y, self.x).cmp(&(other.y, other.x))
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// Reason why a grid cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GridError {
    /// The resolution is not a positive length.
    #[error("the resolution {} m must be a positive, finite number", short(.0))]
    Resolution(f64),
    /// The origin or the size is not a finite number, or the size is not positive.
    #[error("the grid's origin {0:?} and size {1:?} must be finite, and the size positive")]
    Extent([f64; 2], [f64; 2]),
    /// The grid has no cell.
    #[error("a grid of {0} × {1} cells is empty")]
    Empty(usize, usize),
    /// The grid has more cells than [`MAX_CELLS`].
    #[error("a grid of {0} × {1} cells has more than {MAX_CELLS} cells; use a coarser resolution")]
    TooLarge(usize, usize),
}

/// A grid of square cells, row by row from the lower left corner.
///
/// Cell `(x, y)` is the half-open square
/// `[x·r, (x+1)·r) × [y·r, (y+1)·r)` from the lower left corner, with r the resolution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "GridFields", into = "GridFields")]
pub struct Grid {
    lower_left: Point2<f64>,
    resolution: f64,
    width: usize,
    height: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GridFields {
    lower_left: [f64; 2],
    resolution: f64,
    width: usize,
    height: usize,
}

impl TryFrom<GridFields> for Grid {
    type Error = GridError;
    fn try_from(f: GridFields) -> Result<Self, GridError> {
        Grid::new(Point2::from(f.lower_left), f.resolution, f.width, f.height)
    }
}

impl From<Grid> for GridFields {
    fn from(g: Grid) -> Self {
        let Grid { lower_left, resolution, width, height } = g;
        Self { lower_left: lower_left.into(), resolution, width, height }
    }
}

impl Grid {
    /// Returns the grid of `width × height` cells of side `resolution` \[m\] whose lower left
    /// corner is at `lower_left` \[m\].
    ///
    /// # Errors
    /// If the resolution is not finite or not positive, a coordinate of the corner is not finite or
    /// not within ±10⁹ m, or there are no cells or more than [`MAX_CELLS`].
    pub fn new(
        lower_left: Point2<f64>,
        resolution: f64,
        width: usize,
        height: usize,
    ) -> Result<Self, GridError> {
        if !(resolution.is_finite() && resolution > 0.0) {
            return Err(GridError::Resolution(resolution));
        }
        if !lower_left.iter().all(|v| v.is_finite() && v.abs() < 1e9) {
            return Err(GridError::Extent(lower_left.into(), [f64::NAN, f64::NAN]));
        }
        if width == 0 || height == 0 {
            return Err(GridError::Empty(width, height));
        }
        if width.checked_mul(height).is_none_or(|n| n > MAX_CELLS) {
            return Err(GridError::TooLarge(width, height));
        }
        Ok(Self { lower_left, resolution, width, height })
    }

    /// Returns the grid that covers a rectangle of `size` \[m\]. The rectangle has its lower left
    /// corner at `lower_left`, to which the cells are aligned. The grid has `ceil(size / r)` cells
    /// a side, and `margin` more cells all around.
    ///
    /// # Errors
    /// As [`Grid::new`], and if `size` is not finite or not positive.
    pub fn covering(
        lower_left: Point2<f64>,
        size: Vector2<f64>,
        resolution: f64,
        margin: usize,
    ) -> Result<Self, GridError> {
        if !(resolution.is_finite() && resolution > 0.0) {
            return Err(GridError::Resolution(resolution));
        }
        if !size.iter().all(|v| v.is_finite() && *v > 0.0) {
            return Err(GridError::Extent(lower_left.into(), size.into()));
        }
        // An exact multiple of the resolution must not gain a cell by rounding.
        let cells = |length: f64| {
            let count = (length / resolution - 1e-9).ceil().max(1.0);
            #[allow(
                clippy::cast_possible_truncation,
                reason = "at least 1; saturates, and is then refused as too large"
            )]
            (count as usize).saturating_add(margin.saturating_mul(2))
        };
        let shift = margin as f64 * resolution;
        let corner = lower_left - Vector2::new(shift, shift);
        Self::new(corner, resolution, cells(size.x), cells(size.y))
    }

    /// Returns the lower left corner of cell (0, 0) \[m\].
    #[inline]
    pub fn lower_left(&self) -> Point2<f64> {
        self.lower_left
    }

    /// Returns the side of a cell, r \[m\].
    #[inline]
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// Returns the number of columns.
    #[inline]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    #[inline]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the number of cells.
    #[allow(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Returns the cell that holds a point; `None` outside the grid, and for a point that is not finite.
    pub fn cell_at(&self, point: Point2<f64>) -> Option<Cell> {
        let cell = self.unbounded_cell_at(point);
        let is_place = point.iter().all(|v| v.is_finite());
        self.index(cell).filter(|_| is_place).map(|_| cell)
    }

    /// Returns the cells that meet the box between two corners \[m\], in row-major order.
    pub fn cells_between(
        &self,
        low: Point2<f64>,
        high: Point2<f64>,
    ) -> impl Iterator<Item = Cell> + use<> {
        let (low, high) = (self.unbounded_cell_at(low), self.unbounded_cell_at(high));
        let last = |side: usize| i32::try_from(side).unwrap_or(i32::MAX) - 1;
        let rows = low.y.max(0)..=high.y.min(last(self.height));
        let columns = low.x.max(0)..=high.x.min(last(self.width));
        rows.flat_map(move |y| columns.clone().map(move |x| Cell::new(x, y)))
    }

    /// Returns the cell that holds a point, whether it lies in the grid or not. Coordinates
    /// saturate at the bounds of `i32`; NaN gives column or row 0.
    #[inline]
    pub fn unbounded_cell_at(&self, point: Point2<f64>) -> Cell {
        let scaled = (point - self.lower_left) / self.resolution;
        #[allow(clippy::cast_possible_truncation, reason = "saturates far outside of any grid")]
        let cell = |v: f64| v.floor() as i32;
        Cell::new(cell(scaled.x), cell(scaled.y))
    }

    /// Returns the centre of a cell \[m\].
    #[inline]
    pub fn center(&self, cell: Cell) -> Point2<f64> {
        self.lower_corner(cell) + Vector2::repeat(0.5 * self.resolution)
    }

    /// Returns the lower left corner of a cell \[m\].
    #[inline]
    pub fn lower_corner(&self, cell: Cell) -> Point2<f64> {
        self.lower_left + Vector2::new(f64::from(cell.x), f64::from(cell.y)) * self.resolution
    }

    /// Returns the row-major index of a cell; `None` outside the grid.
    #[inline]
    pub fn index(&self, cell: Cell) -> Option<usize> {
        let (x, y) = (usize::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
        (x < self.width && y < self.height).then(|| y * self.width + x)
    }

    /// Returns the cell with a row-major index, whether it lies in the grid or not.
    #[inline]
    pub fn cell(&self, index: usize) -> Cell {
        #[allow(clippy::cast_possible_truncation, reason = "a grid has at most 2e7 cells")]
        Cell::new((index % self.width) as i32, (index / self.width) as i32)
    }

    /// Returns all cells, row by row from the lower left.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + use<> {
        let grid = *self;
        (0..grid.len()).map(move |index| grid.cell(index))
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_cell_is_half_open() {
        let grid = Grid::new(Point2::new(-1.0, 2.0), 0.5, 4, 2).unwrap();
        assert_eq!(grid.cell_at(Point2::new(-1.0, 2.0)), Some(Cell::new(0, 0)));
        assert_eq!(grid.cell_at(Point2::new(-0.5, 2.49)), Some(Cell::new(1, 0)));
        assert_eq!(grid.cell_at(Point2::new(1.0, 2.0)), None);
        assert_eq!(grid.cell_at(Point2::new(-1.01, 2.0)), None);
        assert_eq!(grid.cell_at(Point2::new(f64::NAN, 2.0)), None);
    }

    #[test]
    fn cells_far_out_stay_out() {
        let far = Cell::new(i32::MAX, i32::MIN);
        assert_eq!(far.offset(i32::MAX, i32::MIN), far);
        let grid = Grid::new(Point2::origin(), 0.5, 4, 2).unwrap();
        let at = grid.unbounded_cell_at(Point2::new(1e300, -1e300));
        assert_eq!((at, grid.index(at)), (far, None));
    }

    #[test]
    fn a_multiple_of_the_resolution_gains_no_cell() {
        let size = Vector2::new(20.0, 12.0);
        let grid = Grid::covering(Point2::origin(), size, 0.1, 2).unwrap();
        assert_eq!((grid.width(), grid.height()), (204, 124));
        assert_eq!(grid.cell_at(Point2::new(0.05, 0.05)), Some(Cell::new(2, 2)));
    }

    #[test]
    fn an_absurd_grid_is_refused() {
        let make = |r, w, h| Grid::new(Point2::origin(), r, w, h);
        assert_eq!(make(0.0, 1, 1), Err(GridError::Resolution(0.0)));
        assert!(matches!(make(f64::NAN, 1, 1), Err(GridError::Resolution(_))));
        assert_eq!(make(1.0, 0, 5), Err(GridError::Empty(0, 5)));
        assert_eq!(make(1.0, usize::MAX, 2), Err(GridError::TooLarge(usize::MAX, 2)));
        let huge = Grid::covering(Point2::origin(), Vector2::new(1e300, 1.0), 1e-3, 2);
        assert!(matches!(huge, Err(GridError::TooLarge(..))));
        let wide = |margin| Grid::covering(Point2::origin(), Vector2::new(1.0, 1.0), 1e-9, margin);
        for margin in [1 << 31, 1 << 63, usize::MAX] {
            assert!(wide(margin).is_err(), "{margin}");
        }
    }

    proptest! {
        #[test]
        fn the_centre_of_a_cell_lies_in_it(x in -50.0..50.0, y in -50.0..50.0, r in 0.01..1.0,
                                           i in 0..60, j in 0..40) {
            let grid = Grid::new(Point2::new(x, y), r, 60, 40).unwrap();
            let cell = Cell::new(i, j);
            prop_assert_eq!(grid.cell_at(grid.center(cell)), Some(cell));
            prop_assert_eq!(grid.cell(grid.index(cell).unwrap()), cell);
        }
    }
}
