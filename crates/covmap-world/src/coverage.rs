//! The exact coverage of every cell.
//!
//! The algorithm clips each outline to halves of its range of cells, and to halves of these,
//! until a range is full or a single cell. The clipped pieces inside a cell are scaled to the
//! unit square, where the area of their union is computed.

use crate::faces::Bounds;
use crate::outline::{Outline, twice_area};
use crate::world::World;
use covmap::{Cell, Grid, Raster};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;
use nalgebra::{Point2, Vector2};
use rayon::prelude::*;

/// The number of rows of cells that one task works on.
const BAND: i32 = 8;
/// A coverage this near to 0 or 1 is taken as rounding, and becomes 0 or 1.
const ROUNDING: f64 = 1e-12;
/// Units of the integer grid in a cell's side. Areas are good to some 1e-12.
const UNITS: f64 = 1_099_511_627_776.0;

impl World {
    /// Returns the exact coverage of every cell of a grid.
    ///
    /// The coverage is the share of the cell's area that lies inside an obstacle or outside of
    /// the extent; each place counts once. The error is below 1e-9.
    pub fn coverage(&self, grid: &Grid) -> Raster<f64> {
        let (outlines, bounds, disjoint) = (&self.outlines, self.bounds(), self.disjoint);
        Solids { outlines, bounds, disjoint }.coverage(grid)
    }
}

/// The solids: outlines, and everything outside of the bounds, which may be infinite.
#[derive(Debug)]
pub struct Solids<'a> {
    /// The outlines of the solids.
    pub outlines: &'a [Outline],
    /// The bounds, outside of which everything is solid.
    pub bounds: Bounds,
    /// Whether no two outlines overlap.
    pub disjoint: bool,
}

impl Solids<'_> {
    /// Returns the exact coverage of every cell of a grid.
    pub fn coverage(&self, grid: &Grid) -> Raster<f64> {
        #[allow(clippy::cast_possible_truncation, reason = "a grid has at most 2e7 cells")]
        let (width, height) = (grid.width() as i32, grid.height() as i32);
        let boxes: Vec<_> = self.outlines.iter().map(Outline::bounds).collect();
        let starts: Vec<i32> = (0..height).step_by(BAND as usize).collect();
        let bands: Vec<Vec<f64>> = starts
            .into_par_iter()
            .map(|start| {
                let cells = Cells { x: (0, width), y: (start, height.min(start + BAND)) };
                let mut band = Band::new(self.bounds, grid, cells);
                let ((low, high), (reach_low, reach_high)) = (band.range(cells), self.bounds);
                let (low, high) = (low.sup(&reach_low), high.inf(&reach_high));
                for (outline, (from, to)) in self.outlines.iter().zip(&boxes) {
                    if from.x < high.x && from.y < high.y && low.x < to.x && low.y < to.y {
                        band.add(outline, (low.sup(from), high.inf(to)));
                    }
                }
                band.coverage(self.disjoint)
            })
            .collect();
        Raster::from_values(*grid, bands.concat())
            .unwrap_or_else(|| unreachable!("the bands hold every cell"))
    }
}

/// A range of cells, in each direction from the first index to the one before the second.
#[derive(Clone, Copy)]
struct Cells {
    x: (i32, i32),
    y: (i32, i32),
}

struct Band<'a> {
    bounds: Bounds,
    grid: &'a Grid,
    cells: Cells,
    /// The number of full ranges that begin (or, negative, end) here. The sum along x and y tells
    /// whether a cell is full.
    full: Vec<i32>,
    /// Parts of outlines in cells, in cell-local coordinates.
    pieces: Vec<(usize, Vec<Point2<f64>>)>,
}

impl<'a> Band<'a> {
    fn new(bounds: Bounds, grid: &'a Grid, cells: Cells) -> Self {
        let count = (cells.x.1 - cells.x.0 + 1) * (cells.y.1 - cells.y.0 + 1);
        Self { bounds, grid, cells, full: vec![0; usize_of(count)], pieces: Vec::new() }
    }

    /// Returns the corners of a range of cells.
    fn range(&self, cells: Cells) -> (Point2<f64>, Point2<f64>) {
        let corner = |x, y| self.grid.lower_corner(Cell::new(x, y));
        (corner(cells.x.0, cells.y.0), corner(cells.x.1, cells.y.1))
    }

    /// Adds the part of an outline that lies between two corners.
    fn add(&mut self, outline: &Outline, (low, high): (Point2<f64>, Point2<f64>)) {
        let first = self.grid.unbounded_cell_at(low).offset(-1, -1);
        let last = self.grid.unbounded_cell_at(high).offset(2, 2);
        let within = |v: i32, (from, to): (i32, i32)| v.clamp(from, to);
        let cells = Cells {
            x: (within(first.x, self.cells.x), within(last.x, self.cells.x)),
            y: (within(first.y, self.cells.y), within(last.y, self.cells.y)),
        };
        if cells.x.0 >= cells.x.1 || cells.y.0 >= cells.y.1 {
            return;
        }
        let (band_low, band_high) = self.range(cells);
        let (world_low, world_high) = self.bounds;
        let (low, high) = (band_low.sup(&world_low), band_high.inf(&world_high));
        let mut polygon = outline.points.clone();
        for (axis, bound, keep_below) in
            [(0, low.x, false), (0, high.x, true), (1, low.y, false), (1, high.y, true)]
        {
            polygon = clipped(&polygon, axis, bound, keep_below);
        }
        self.divide(&polygon, cells);
    }

    fn divide(&mut self, polygon: &[Point2<f64>], cells: Cells) {
        if polygon.len() < 3 {
            return;
        }
        let (low, high) = self.range(cells);
        if fills(polygon, low, high) {
            return self.mark_full(cells);
        }
        let (Cells { x, y }, halves) = (cells, (cells.x.1 - cells.x.0, cells.y.1 - cells.y.0));
        if halves == (1, 1) {
            let scale = 1.0 / self.grid.resolution();
            let local = |p: &Point2<f64>| Point2::from((p - low) * scale);
            let place = self.place(x.0, y.0);
            self.pieces.push((place, polygon.iter().map(local).collect()));
        } else if halves.0 >= halves.1 {
            let middle = x.0 + halves.0 / 2;
            let bound = self.grid.lower_corner(Cell::new(middle, 0)).x;
            self.divide(&clipped(polygon, 0, bound, true), Cells { x: (x.0, middle), y });
            self.divide(&clipped(polygon, 0, bound, false), Cells { x: (middle, x.1), y });
        } else {
            let middle = y.0 + halves.1 / 2;
            let bound = self.grid.lower_corner(Cell::new(0, middle)).y;
            self.divide(&clipped(polygon, 1, bound, true), Cells { x, y: (y.0, middle) });
            self.divide(&clipped(polygon, 1, bound, false), Cells { x, y: (middle, y.1) });
        }
    }

    fn mark_full(&mut self, Cells { x, y }: Cells) {
        for (column, row, count) in [(x.0, y.0, 1), (x.1, y.0, -1), (x.0, y.1, -1), (x.1, y.1, 1)] {
            let place = self.place(column, row);
            self.full[place] += count;
        }
    }

    /// Returns the index of a cell in `full`, which has one column and one row more than the
    /// band.
    fn place(&self, x: i32, y: i32) -> usize {
        let columns = self.cells.x.1 - self.cells.x.0 + 1;
        usize_of((y - self.cells.y.0) * columns + x - self.cells.x.0)
    }

    fn coverage(mut self, disjoint: bool) -> Vec<f64> {
        self.pieces.sort_by_key(|(place, _)| *place);
        let Cells { x, y } = self.cells;
        let mut above = vec![0; usize_of(x.1 - x.0)];
        let mut values = Vec::with_capacity(usize_of((x.1 - x.0) * (y.1 - y.0)));
        let mut pieces = self.pieces.as_slice();
        for row in y.0..y.1 {
            let mut along = 0;
            for column in x.0..x.1 {
                let place = self.place(column, row);
                along += self.full[place];
                let full = &mut above[usize_of(column - x.0)];
                *full += along;
                let count = pieces.partition_point(|(p, _)| *p <= place);
                let (here, rest) = pieces.split_at(count);
                pieces = rest;
                let outside = self.outside(Cell::new(column, row));
                let covered = if *full > 0 {
                    1.0
                } else {
                    outside + if disjoint { sum(here) } else { union(here) }
                };
                values.push(match covered {
                    c if c < ROUNDING => 0.0,
                    c if c > 1.0 - ROUNDING => 1.0,
                    c => c,
                });
            }
        }
        values
    }

    /// Returns the share of a cell that lies outside of the extent.
    fn outside(&self, cell: Cell) -> f64 {
        let (low, high) = self.range(Cells { x: (cell.x, cell.x + 1), y: (cell.y, cell.y + 1) });
        let (from, to) = self.bounds;
        if from.x <= low.x && from.y <= low.y && high.x <= to.x && high.y <= to.y {
            return 0.0;
        }
        let inside = high.inf(&to) - low.sup(&from);
        let scale = 1.0 / self.grid.resolution();
        1.0 - (inside.x * scale).clamp(0.0, 1.0) * (inside.y * scale).clamp(0.0, 1.0)
    }
}

/// Returns the part of a polygon on one side of an axis-parallel line (Sutherland–Hodgman).
///
/// A part that falls apart stays connected along the line, without area.
fn clipped(polygon: &[Point2<f64>], axis: usize, bound: f64, keep_below: bool) -> Vec<Point2<f64>> {
    let inside = |p: &Point2<f64>| if keep_below { p[axis] <= bound } else { p[axis] >= bound };
    let mut kept = Vec::with_capacity(polygon.len() + 4);
    let Some(mut before) = polygon.last() else { return kept };
    for point in polygon {
        if inside(before) != inside(point) {
            // Computed from the lower end: neighbours on both sides of a line agree.
            let (p, q) = if before[axis] < point[axis] { (before, point) } else { (point, before) };
            let share = (bound - p[axis]) / (q[axis] - p[axis]);
            let mut crossing = p + (q - p) * share;
            crossing[axis] = bound;
            kept.push(crossing);
        }
        if inside(point) {
            kept.push(*point);
        }
        before = point;
    }
    kept
}

/// Returns whether a polygon that was clipped to a rectangle fills it: no side runs inside it.
#[allow(clippy::float_cmp, reason = "clipping sets coordinates to exactly these")]
fn fills(polygon: &[Point2<f64>], low: Point2<f64>, high: Point2<f64>) -> bool {
    let next = polygon.iter().cycle().skip(1);
    let along = |(p, q): (&Point2<f64>, &Point2<f64>)| {
        (0..2).any(|k| p[k] == q[k] && (p[k] == low[k] || p[k] == high[k]))
    };
    polygon.iter().zip(next).all(along) && {
        let size: Vector2<f64> = high - low;
        twice_area(polygon) > size.x * size.y
    }
}

type Piece = (usize, Vec<Point2<f64>>);

fn sum(pieces: &[Piece]) -> f64 {
    pieces.iter().map(|(_, p)| 0.5 * twice_area(p)).sum()
}

/// Returns the area of the union of pieces inside the unit square.
fn union(pieces: &[Piece]) -> f64 {
    if pieces.len() < 2 || are_apart(pieces) { sum(pieces) } else { overlapping(pieces) }
}

/// Returns whether the boxes of all pieces are apart.
fn are_apart(pieces: &[Piece]) -> bool {
    const MANY: usize = 16;
    let bounds =
        |(_, p): &Piece| p.iter().fold((p[0], p[0]), |(low, high), q| (low.inf(q), high.sup(q)));
    let boxes: Vec<_> = pieces.iter().take(MANY).map(bounds).collect();
    pieces.len() < MANY
        && boxes.iter().enumerate().all(|(i, (a, b))| {
            boxes[..i].iter().all(|(c, d)| {
                let overlap = b.inf(d) - a.sup(c);
                overlap.min() <= 0.1 * ROUNDING
            })
        })
}

/// Returns the area of a union, on a fine grid of integers.
fn overlapping(pieces: &[Piece]) -> f64 {
    let points = pieces.iter().map(|(_, p)| p.len()).sum();
    let mut overlay = Overlay::<i64>::new(points);
    #[allow(clippy::cast_possible_truncation, reason = "the unit square has 2^40 units a side")]
    let unit = |v: f64| (v * UNITS).round() as i64;
    for (_, piece) in pieces {
        let contour: Vec<_> = piece.iter().map(|p| IntPoint::new(unit(p.x), unit(p.y))).collect();
        overlay.add_contour(&contour, ShapeType::Subject);
    }
    let shapes = overlay.overlay(OverlayRule::Subject, FillRule::NonZero);
    let twice = |contour: &Vec<IntPoint<i64>>| -> i128 {
        let next = contour.iter().cycle().skip(1);
        let wide = |p: &IntPoint<i64>| (i128::from(p.x), i128::from(p.y));
        let cross = |(p, q)| {
            let ((px, py), (qx, qy)) = (wide(p), wide(q));
            px * qy - py * qx
        };
        contour.iter().zip(next).map(cross).sum()
    };
    let total: i128 = shapes.iter().flatten().map(twice).sum();
    let total = total.abs() as f64;
    0.5 * total / (UNITS * UNITS)
}

fn usize_of(v: i32) -> usize {
    usize::try_from(v).unwrap_or_else(|_| unreachable!("{v} counts cells of a band"))
}
