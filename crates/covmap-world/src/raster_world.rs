//! The solids and the boundary of a world made from a raster.

use crate::faces::Face;
use crate::feature::{Feature, Kind};
use crate::outline::Outline;
use crate::scenario::Surface;
use covmap::{Cell, Grid, Raster};
use nalgebra::{Isometry2, Point2};
use std::ops::Range;

/// Returns the raster without the solid cells farther than `margin` \[m\] beyond all free cells.
///
/// Everything outside of a world is solid anyway, and a grid over it costs memory.
pub(crate) fn trimmed(solid: &Raster<bool>, margin: f64) -> Raster<bool> {
    let grid = solid.grid();
    let free = solid.iter().filter_map(|(cell, solid)| (!solid).then_some(cell));
    let span = |found: Option<(Cell, Cell)>, cell: Cell| match found {
        None => Some((cell, cell)),
        Some((low, high)) => Some((
            Cell::new(low.x.min(cell.x), low.y.min(cell.y)),
            Cell::new(high.x.max(cell.x), high.y.max(cell.y)),
        )),
    };
    let Some((low, high)) = free.fold(None, span) else { return solid.clone() };
    #[allow(clippy::cast_possible_truncation, reason = "clamped")]
    let margin = (margin / grid.resolution() - 1e-9).ceil().clamp(1.0, 1e6) as i32;
    let low = Cell::new((low.x - margin).max(0), (low.y - margin).max(0));
    let width = (high.x + margin + 1).min(columns(grid)) - low.x;
    let height = (high.y + margin + 1).min(rows(grid)) - low.y;
    let kept = (0..height).flat_map(|y| (0..width).map(move |x| low.offset(x, y)));
    let kept: Vec<bool> = kept.filter_map(|cell| solid.get(cell).copied()).collect();
    let corner = grid.lower_corner(low);
    let size = [width, height].map(|side| usize::try_from(side).unwrap_or_default());
    let grid = Grid::new(corner, grid.resolution(), size[0], size[1]);
    let raster = grid.ok().and_then(|grid| Raster::from_values(grid, kept));
    raster.unwrap_or_else(|| unreachable!("it is a part of a raster"))
}

/// Returns the disjoint outlines of a raster's solid cells, its faces and their features, placed
/// by `world_from_raster`.
pub(crate) fn solids(
    solid: &Raster<bool>,
    world_from_raster: &Isometry2<f64>,
    surface: Surface,
) -> (Vec<Outline>, (Vec<Face>, Vec<Feature>)) {
    let place = |point: Point2<f64>| world_from_raster * point;
    let outlines = rectangles(solid, surface).into_iter().map(|outline| {
        Outline::new(outline.points.into_iter().map(place).collect(), outline.surface)
    });
    let (faces, mut features) = boundary(solid, surface);
    let faces = faces.iter().map(|f| Face::new(place(f.a), place(f.b), f.surface)).collect();
    features.iter_mut().for_each(|feature| feature.at = place(feature.at));
    (outlines.collect(), (faces, features))
}

/// Returns disjoint rectangles that make up the solid cells: runs of a row, grown upwards.
fn rectangles(solid: &Raster<bool>, surface: Surface) -> Vec<Outline> {
    let grid = solid.grid();
    let mut done = Vec::new();
    let mut open: Vec<(Range<i32>, i32)> = Vec::new();
    for y in 0..=rows(grid) {
        let runs = runs(columns(grid), |x| is_solid_cell(solid, x, y, false).then_some(()));
        let runs: Vec<Range<i32>> = runs.into_iter().map(|(run, ())| run).collect();
        let mut still = Vec::with_capacity(runs.len());
        for (run, since) in open {
            // Both lists are in order of x.
            if runs.binary_search_by(|r| r.start.cmp(&run.start)).is_ok_and(|k| runs[k] == run) {
                still.push((run, since));
            } else {
                done.push(rectangle(grid, run, since..y, surface));
            }
        }
        for run in runs {
            if let Err(place) = still.binary_search_by(|(r, _)| r.start.cmp(&run.start)) {
                still.insert(place, (run, y));
            }
        }
        open = still;
    }
    done
}

/// Returns the faces between solid and free cells, and their features; the outside is solid.
fn boundary(solid: &Raster<bool>, surface: Surface) -> (Vec<Face>, Vec<Feature>) {
    let grid = solid.grid();
    let mut faces = Vec::new();
    let at = |x: i32, y: i32| grid.lower_corner(Cell::new(x, y));
    let cell = |x: i32, y: i32| is_solid_cell(solid, x, y, true);
    // The solid is on the left of a face.
    for y in 0..=rows(grid) {
        let step = |x: i32| (cell(x, y) != cell(x, y - 1)).then(|| cell(x, y));
        for (run, solid_above) in runs(columns(grid), step) {
            let (left, right) = (at(run.start, y), at(run.end, y));
            let (a, b) = if solid_above { (left, right) } else { (right, left) };
            faces.push(Face::new(a, b, surface));
        }
    }
    for x in 0..=columns(grid) {
        let step = |y: i32| (cell(x, y) != cell(x - 1, y)).then(|| cell(x, y));
        for (run, solid_right) in runs(rows(grid), step) {
            let (low, high) = (at(x, run.start), at(x, run.end));
            let (a, b) = if solid_right { (high, low) } else { (low, high) };
            faces.push(Face::new(a, b, surface));
        }
    }
    let mut features = Vec::new();
    for y in 0..=rows(grid) {
        for x in 0..=columns(grid) {
            let around = [cell(x, y), cell(x - 1, y), cell(x, y - 1), cell(x - 1, y - 1)];
            let diagonal = around[0] == around[3] && around[1] == around[2];
            match around.iter().filter(|&&s| s).count() {
                1 => features.push(Feature { at: at(x, y), kind: Kind::Edge }),
                2 if diagonal => features.push(Feature { at: at(x, y), kind: Kind::Corner }),
                3 => features.push(Feature { at: at(x, y), kind: Kind::Corner }),
                _ => {}
            }
        }
    }
    (faces, features)
}

/// Returns the maximal runs of 0..n in which `kind` is the same and not `None`.
fn runs<K: PartialEq>(n: i32, kind: impl Fn(i32) -> Option<K>) -> Vec<(Range<i32>, K)> {
    let mut runs: Vec<(Range<i32>, K)> = Vec::new();
    for i in 0..n {
        let Some(kind) = kind(i) else { continue };
        match runs.last_mut() {
            Some((run, last)) if run.end == i && *last == kind => run.end = i + 1,
            _ => runs.push((i..i + 1, kind)),
        }
    }
    runs
}

fn rectangle(grid: &Grid, x: Range<i32>, y: Range<i32>, surface: Surface) -> Outline {
    let low = grid.lower_corner(Cell::new(x.start, y.start));
    let high = grid.lower_corner(Cell::new(x.end, y.end));
    let points = vec![low, Point2::new(high.x, low.y), high, Point2::new(low.x, high.y)];
    Outline::new(points, surface)
}

fn is_solid_cell(solid: &Raster<bool>, x: i32, y: i32, outside: bool) -> bool {
    solid.get(Cell::new(x, y)).copied().unwrap_or(outside)
}

#[allow(clippy::cast_possible_truncation, reason = "a grid has at most 2e7 cells")]
fn columns(grid: &Grid) -> i32 {
    grid.width() as i32
}

#[allow(clippy::cast_possible_truncation, reason = "a grid has at most 2e7 cells")]
fn rows(grid: &Grid) -> i32 {
    grid.height() as i32
}
