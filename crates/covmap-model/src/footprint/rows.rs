//! The rows of a grid across a sector, and the columns of each that it may cover.

use super::Sector;
use covmap::{Cell, Grid};
use nalgebra::{Point2, Vector2};

/// The rows of a grid across a sector.
pub(super) struct Rows<'a> {
    sector: &'a Sector,
    /// The lines that bound the sector: a point, dx/dy, and whether the line leads upwards.
    lines: [(Point2<f64>, f64, bool); 3],
    /// Number of these lines in use: the axis matters only where it adds cells.
    count: usize,
    /// The sector's box.
    low: f64,
    high: f64,
    /// Half of the height of a row, as far as it matters.
    half: f64,
}

impl<'a> Rows<'a> {
    pub(super) fn new(sector: &'a Sector, grid: &Grid, low: f64, high: f64) -> Self {
        let line = |(from, to): (Point2<f64>, Vector2<f64>)| (from, to.x / to.y, to.y >= 0.0);
        let (apex, sensor) = (sector.apex, sector.sensor);
        let lines = [(apex, sector.first), (apex, sector.last), (sensor, sector.axis)].map(line);
        // Either a cell's centre decides, or all of the cell; and the border has some width.
        let half = if sector.with_axis { 1.5 } else { 0.01 } * grid.resolution();
        let count = if sector.with_axis { 3 } else { 2 };
        Self { sector, lines, count, low, high, half }
    }

    /// Returns the first and the last column that the sector may cover in row `y`: those of its
    /// borders and axis within the row.
    #[inline(always)]
    pub(super) fn columns(&self, grid: &Grid, y: i32) -> Option<(i32, i32)> {
        let center = grid.center(Cell::new(0, y)).y;
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut include = |x: f64| (left, right) = (left.min(x), right.max(x));
        for (from, slope, upwards) in &self.lines[..self.count] {
            for edge in [center - self.half, center + self.half] {
                let height = edge - from.y;
                if (height >= 0.0) == *upwards {
                    include(from.x + height * slope);
                }
            }
            if (from.y - center).abs() <= self.half {
                include(from.x);
            }
        }
        // A row that a border does not leave on one side is open to the end of the box.
        let inside = |x: f64| {
            let offset = Point2::new(x, center) - self.sector.apex;
            let border = -self.half;
            self.sector.first.perp(&offset) >= border && offset.perp(&self.sector.last) >= border
        };
        left = if inside(self.low) { self.low } else { left.max(self.low) };
        right = if inside(self.high) { self.high } else { right.min(self.high) };
        // Rounds up outside of the grid, where no cell is lost by it.
        #[allow(clippy::cast_possible_truncation, reason = "saturates outside of any grid")]
        let column = |x: f64| ((x - grid.lower_left().x) / grid.resolution()) as i32;
        (left <= right).then(|| (column(left - self.half), column(right + self.half)))
    }
}
