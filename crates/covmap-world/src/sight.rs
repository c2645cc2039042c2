//! What a robot can reach and see in truth: the yardstick of a run.

use crate::drive::Drive;
use crate::world::World;
use covmap::{Cell, Grid, Raster};
use nalgebra::{Isometry2, Point2, Vector2};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// The neighbours of a cell.
const NEIGHBORS: [(i32, i32); 8] =
    [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)];
/// A cell this full is solid.
const SOLID: f64 = 0.5;
/// Lengths that differ by less are equal [m].
const EQUAL: f64 = 1e-9;
/// How many parts the cells that look are divided into.
const PARTS: usize = 16;

/// What can be seen from some places.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The cells that a line of sight passes before it meets a solid.
    pub in_sight: Raster<bool>,
    /// The cells, at least half full, in which a line of sight ends.
    pub first_solid: Raster<bool>,
}

impl World {
    /// The roomiest place: the centre of the free cell with the largest clearance in the
    /// largest free component, with heading 0.
    ///
    /// A cell is free if its coverage is 0 and a disc of `radius` \[m\] fits at its centre;
    /// components are connected over eight neighbours. Ties go to the first in row-major
    /// order. `None` if no cell is free.
    pub fn default_start(&self, coverage: &Raster<f64>, radius: f64) -> Option<Isometry2<f64>> {
        let grid = *coverage.grid();
        let clearance = self.clearances(&grid, |i| coverage[i] <= 0.0);
        let free = |i: usize| clearance[i] >= radius && coverage[i] <= 0.0;
        let mut seen = Raster::filled(grid, false);
        let mut largest: Vec<usize> = Vec::new();
        for start in 0..grid.len() {
            if free(start) && !seen[start] {
                let component = flood(&grid, vec![start], &mut seen, |_, to| free(to));
                if component.len() > largest.len() {
                    largest = component;
                }
            }
        }
        largest.sort_unstable();
        let roomier =
            |best: usize, i: usize| if clearance[i] > clearance[best] + EQUAL { i } else { best };
        let best = largest.into_iter().reduce(roomier)?;
        Some(Isometry2::new(grid.center(grid.cell(best)).coords, 0.0))
    }

    /// The cells whose centres a disc of `radius` \[m\] truly reaches from `start`, by
    /// straight drives to the centres of neighbours, eight of them, without a bump.
    ///
    /// From the start itself it drives to the centre of its cell and of that cell's neighbours.
    pub fn reachable_cells(&self, grid: &Grid, start: Point2<f64>, radius: f64) -> Raster<bool> {
        let clearance = self.clearances(grid, |_| true);
        let step = grid.resolution() * std::f64::consts::SQRT_2;
        let arrives = |from, to| self.drive(from, to, radius) == Drive::Arrived;
        let fits = |i: usize| clearance[i] >= radius;
        let mut reached = Raster::filled(*grid, false);
        let home = grid.unbounded_cell_at(start);
        let around = [(0, 0)].iter().chain(&NEIGHBORS).map(|&(x, y)| home.offset(x, y));
        let first = around
            .filter_map(|cell| grid.index(cell))
            .filter(|&i| fits(i) && arrives(start, grid.center(grid.cell(i))))
            .collect();
        flood(grid, first, &mut reached, |from, to| {
            fits(to)
                && (clearance[from] >= radius + step
                    || arrives(grid.center(grid.cell(from)), grid.center(grid.cell(to))))
        });
        reached
    }

    /// What is seen within `range` \[m\] from the centres of the cells that hold some places;
    /// places outside of the grid are passed over.
    ///
    /// # Panics
    /// If `coverage` is not on `grid`.
    pub fn cells_seen_from(
        &self,
        grid: &Grid,
        coverage: &Raster<f64>,
        places: impl Iterator<Item = Point2<f64>>,
        range: f64,
    ) -> Seen {
        let mut from = Raster::filled(*grid, false);
        for at in places {
            if let Some(here) = grid.cell_at(at).and_then(|cell| from.get_mut(cell)) {
                *here = true;
            }
        }
        self.cells_seen(grid, coverage, &from, range)
    }

    /// What is seen within `range` \[m\] from the centres of the cells `from`.
    ///
    /// From each, rays are cast all around, less than a cell apart at `range`; those of
    /// neighbouring cells lie between each other. `coverage` is the world's, on the same grid.
    ///
    /// # Panics
    /// If the rasters are not on `grid`.
    pub fn cells_seen(
        &self,
        grid: &Grid,
        coverage: &Raster<f64>,
        from: &Raster<bool>,
        range: f64,
    ) -> Seen {
        assert!(coverage.grid() == grid && from.grid() == grid, "the rasters must be on the grid");
        let viewers: Vec<Cell> = from.iter().filter(|(_, from)| **from).map(|(c, _)| c).collect();
        let eye =
            Eye { world: self, grid, coverage, range, fan: Fan::new(range, grid.resolution()) };
        let nothing = Raster::filled(*grid, false);
        let nothing = Seen { in_sight: nothing.clone(), first_solid: nothing };
        let part = |cells: &[Cell]| {
            let mut seen = nothing.clone();
            cells.iter().for_each(|&cell| eye.look(cell, &mut seen));
            seen
        };
        let parts: Vec<Seen> =
            viewers.par_chunks(viewers.len().div_ceil(PARTS).max(1)).map(part).collect();
        parts.iter().fold(nothing.clone(), |mut all, part| {
            add(&mut all.in_sight, &part.in_sight);
            add(&mut all.first_solid, &part.first_solid);
            all
        })
    }

    /// The clearance at the centres of cells; 0 where it is not asked for.
    fn clearances(&self, grid: &Grid, wanted: impl Fn(usize) -> bool + Sync) -> Vec<f64> {
        let clearance = |i| if wanted(i) { self.clearance(grid.center(grid.cell(i))) } else { 0.0 };
        (0..grid.len()).into_par_iter().map(clearance).collect()
    }
}

fn add(all: &mut Raster<bool>, part: &Raster<bool>) {
    for (all, part) in all.values_mut().iter_mut().zip(part.values()) {
        *all |= part;
    }
}

/// Marks and returns what is connected with the cells `first` over steps that are `open`.
fn flood(
    grid: &Grid,
    first: Vec<usize>,
    seen: &mut Raster<bool>,
    open: impl Fn(usize, usize) -> bool,
) -> Vec<usize> {
    for &i in &first {
        seen[i] = true;
    }
    let mut queue = VecDeque::from(first);
    let mut component = Vec::new();
    while let Some(from) = queue.pop_front() {
        component.push(from);
        let cell = grid.cell(from);
        for to in NEIGHBORS.iter().filter_map(|&(x, y)| grid.index(cell.offset(x, y))) {
            if !seen[to] && open(from, to) {
                seen[to] = true;
                queue.push_back(to);
            }
        }
    }
    component
}

/// Directions all around, half a cell apart at full range.
struct Fan {
    directions: Vec<Vector2<f64>>,
}

impl Fan {
    fn new(range: f64, resolution: f64) -> Self {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to a small number"
        )]
        let count = (TAU * range / (0.5 * resolution)).ceil().clamp(64.0, 8192.0) as u32;
        let direction = |k: u32| {
            let (sin, cos) = libm::sincos(TAU * (f64::from(k) + 0.5) / f64::from(count));
            Vector2::new(cos, sin)
        };
        Self { directions: (0..count).map(direction).collect() }
    }

    /// Every second direction; the other half for the four neighbours of a cell.
    fn of(&self, cell: Cell) -> impl Iterator<Item = &Vector2<f64>> {
        self.directions.iter().skip(usize::from((cell.x + cell.y) % 2 != 0)).step_by(2)
    }
}

/// Looks around.
struct Eye<'a> {
    world: &'a World,
    grid: &'a Grid,
    coverage: &'a Raster<f64>,
    range: f64,
    fan: Fan,
}

impl Eye<'_> {
    fn look(&self, cell: Cell, seen: &mut Seen) {
        let origin = self.grid.center(cell);
        if self.world.is_solid(origin) {
            return;
        }
        for &direction in self.fan.of(cell) {
            let hit = self.world.first_hit(origin, direction, self.range);
            let length = hit.map_or(self.range, |hit| hit.distance);
            cells_along(self.grid, origin, direction, length, |i| seen.in_sight[i] = true);
            let Some(hit) = hit else { continue };
            let at = origin + direction * hit.distance;
            let inward = -self.world.faces[hit.face].normal();
            for depth in [1e-6, 0.25 * self.grid.resolution()] {
                let cell = self.grid.cell_at(at + inward * depth);
                let solid = cell.and_then(|c| self.grid.index(c));
                if let Some(i) = solid.filter(|&i| self.coverage[i] >= SOLID) {
                    seen.first_solid[i] = true;
                    break;
                }
            }
        }
    }
}

/// Visits the cells of a grid along a ray, as long as it stays in the grid.
pub(crate) fn cells_along(
    grid: &Grid,
    origin: Point2<f64>,
    direction: Vector2<f64>,
    length: f64,
    mut visit: impl FnMut(usize),
) {
    let resolution = grid.resolution();
    let mut cell = grid.unbounded_cell_at(origin);
    let corner = grid.lower_corner(cell);
    // Distance to the next line between columns and rows, and from line to line.
    let next = |from: f64, low: f64, d: f64| match d {
        d if d > 0.0 => (low + resolution - from) / d,
        d if d < 0.0 => (low - from) / d,
        _ => f64::INFINITY,
    };
    let mut along_x = next(origin.x, corner.x, direction.x);
    let mut along_y = next(origin.y, corner.y, direction.y);
    let (step_x, step_y) = ((resolution / direction.x).abs(), (resolution / direction.y).abs());
    while let Some(i) = grid.index(cell) {
        visit(i);
        if along_x.min(along_y) >= length - EQUAL {
            break;
        }
        if along_x <= along_y {
            along_x += step_x;
            cell.x += if direction.x > 0.0 { 1 } else { -1 };
        } else {
            along_y += step_y;
            cell.y += if direction.y > 0.0 { 1 } else { -1 };
        }
    }
}
