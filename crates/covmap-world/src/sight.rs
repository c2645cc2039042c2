//! The cells that a robot can truly reach and see: the yardstick of a run.

use crate::scenario::Surface;
use crate::world::World;
use covmap::{Cell, Grid, Raster, STEPS, Steps, neighbour};
use covmap_sonar::Drive;
use nalgebra::{Isometry2, Point2, Vector2};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Coverage from which a cell is solid.
const SOLID: f64 = 0.5;
/// Lengths that differ by less than this are equal [m].
const EQUAL: f64 = 1e-9;
/// The number of parts into which the viewing cells are divided.
const PARTS: usize = 16;

/// The cells that can be seen from some places.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The cells that a line of sight passes before it meets a solid.
    pub in_sight: Raster<bool>,
    /// The cells, at least half full, in which a line of sight ends.
    pub first_solid: Raster<bool>,
    /// Those of `first_solid` in which a line of sight ends at a smooth surface.
    pub first_smooth: Raster<bool>,
}

impl World {
    /// Returns the roomiest place: the centre of the free cell with the largest clearance in the
    /// largest free component, with heading 0.
    ///
    /// A cell is free if its coverage is 0 and a disc of `radius` \[m\] fits at its centre. In a
    /// component the disc gets from each cell to any other by its [steps](Self::steps). Ties go
    /// to the first in row-major order. The result is `None` if no cell is free.
    pub fn default_start(&self, coverage: &Raster<f64>, radius: f64) -> Option<Isometry2<f64>> {
        let grid = *coverage.grid();
        let clearance = self.clearances(&grid);
        let regions = self
            .steps_over(&grid, &clearance, radius)
            .regions(|i| clearance[i] >= radius && coverage[i] <= 0.0);
        // The first of the largest.
        let largest = regions.into_iter().reduce(|a, b| if b.len() > a.len() { b } else { a });
        let mut largest = largest?;
        largest.sort_unstable();
        let roomier =
            |best: usize, i: usize| if clearance[i] > clearance[best] + EQUAL { i } else { best };
        let best = largest.into_iter().reduce(roomier)?;
        Some(Isometry2::new(grid.center(grid.cell(best)).coords, 0.0))
    }

    /// Returns the steps that a disc of `radius` \[m\] can take without a bump.
    pub fn steps(&self, grid: &Grid, radius: f64) -> Steps {
        self.steps_over(grid, &self.clearances(grid), radius)
    }

    fn steps_over(&self, grid: &Grid, clearance: &[f64], radius: f64) -> Steps {
        let center = |index: usize| grid.center(grid.cell(index));
        let mut steps = Steps::between(grid, |i| clearance[i] >= radius);
        let longest = grid.resolution() * std::f64::consts::SQRT_2;
        // Half of the steps: the others are the same, in reverse.
        let bumps = |from: usize| -> Vec<(usize, usize)> {
            if !(radius..radius + longest).contains(&clearance[from]) {
                return Vec::new();
            }
            let to =
                |step: usize| neighbour(grid, from, step).filter(|to| clearance[*to] >= radius);
            let bumps = |step: &usize| {
                to(*step).is_some_and(|to| {
                    self.drive(center(from), center(to), radius) != Drive::Arrived
                })
            };
            (0..STEPS.len() / 2).filter(bumps).map(|step| (from, step)).collect()
        };
        let closed: Vec<Vec<(usize, usize)>> = (0..grid.len()).into_par_iter().map(bumps).collect();
        closed.into_iter().flatten().for_each(|(from, step)| steps.close(from, step));
        steps
    }

    /// Returns the cells whose centres a disc of `radius` \[m\] truly reaches from `start`, by
    /// its [steps](Self::steps).
    ///
    /// The disc begins at the centre of the start's cell. If the disc cannot get there, it begins
    /// at the start itself, with steps to the centres of that cell's neighbours.
    pub fn reachable_cells(&self, grid: &Grid, start: Point2<f64>, radius: f64) -> Raster<bool> {
        self.reachable_by(&self.steps(grid, radius), start, radius)
    }

    /// Returns the cells of [`World::reachable_cells`], by steps that are known already.
    pub fn reachable_by(&self, steps: &Steps, start: Point2<f64>, radius: f64) -> Raster<bool> {
        let grid = steps.grid();
        let Some(home) = grid.cell_at(start).and_then(|cell| grid.index(cell)) else {
            return Raster::filled(*grid, false);
        };
        let arrives = |i: usize| {
            let center = grid.center(grid.cell(i));
            self.clearance(center) >= radius && self.drive(start, center, radius) == Drive::Arrived
        };
        if arrives(home) {
            return steps.reached([home]);
        }
        let around = (0..STEPS.len()).filter_map(|step| neighbour(grid, home, step));
        steps.reached(around.filter(|i| arrives(*i)))
    }

    /// Returns the cells seen within `range` \[m\] from the centres of the cells that hold some
    /// places.
    ///
    /// Places outside of the grid are passed over.
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

    /// Returns the cells seen within `range` \[m\] from the centres of the cells `from`.
    ///
    /// Rays are cast all around from each centre, less than a cell apart at `range`; the rays of
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
        let nothing =
            Seen { in_sight: nothing.clone(), first_solid: nothing.clone(), first_smooth: nothing };
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
            add(&mut all.first_smooth, &part.first_smooth);
            all
        })
    }

    /// Returns the clearance at the centre of every cell.
    fn clearances(&self, grid: &Grid) -> Vec<f64> {
        let clearance = |i| self.clearance(grid.center(grid.cell(i)));
        (0..grid.len()).into_par_iter().map(clearance).collect()
    }
}

fn add(all: &mut Raster<bool>, part: &Raster<bool>) {
    for (all, part) in all.values_mut().iter_mut().zip(part.values()) {
        *all |= part;
    }
}

/// Directions all around, half a cell apart at full range.
struct Fan {
    directions: Vec<Vector2<f64>>,
}

impl Fan {
    fn new(range: f64, resolution: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, reason = "clamped to a small number")]
        let count = (TAU * range / (0.5 * resolution)).ceil().clamp(64.0, 8192.0) as u32;
        let direction = |k: u32| {
            let (sin, cos) = libm::sincos(TAU * (f64::from(k) + 0.5) / f64::from(count));
            Vector2::new(cos, sin)
        };
        Self { directions: (0..count).map(direction).collect() }
    }

    /// Returns every second direction; the four neighbours of a cell use the other half.
    fn of(&self, cell: Cell) -> impl Iterator<Item = &Vector2<f64>> {
        self.directions.iter().skip(usize::from((cell.x + cell.y) % 2 != 0)).step_by(2)
    }
}

/// A viewer at the centres of cells.
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
            let face = &self.world.faces[hit.face];
            let inward = -face.normal();
            for depth in [1e-6, 0.25 * self.grid.resolution()] {
                let cell = self.grid.cell_at(at + inward * depth);
                let solid = cell.and_then(|c| self.grid.index(c));
                if let Some(i) = solid.filter(|&i| self.coverage[i] >= SOLID) {
                    seen.first_solid[i] = true;
                    seen.first_smooth[i] |= face.surface == Surface::Smooth;
                    break;
                }
            }
        }
    }
}

/// Visits the cells of a grid along a ray, up to the grid's border.
pub fn cells_along(
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
