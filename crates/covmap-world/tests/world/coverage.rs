//! Exact coverage against analytic areas and against a second, slower computation.

use crate::build::{any_shapes, rectangle, wall, world};
use covmap::{Cell, Grid, Raster};
use covmap_world::{Shape, Surface, World};
use nalgebra::Point2;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_4, TAU};

const EXACT: f64 = 1e-9;

/// Returns the covered area inside the extent: the margin is outside and full.
fn covered_area(world: &World, resolution: f64) -> f64 {
    let grid = world.grid(resolution).unwrap();
    let cell = resolution * resolution;
    let total: f64 = world.coverage(&grid).values().iter().sum::<f64>() * cell;
    total - (grid.len() as f64 * cell - world.size().x * world.size().y)
}

#[track_caller]
fn check_area(shapes: &[Shape], area: f64) {
    for resolution in [0.1, 0.37, 1.0] {
        let covered = covered_area(&world(8.0, 6.0, shapes, Surface::Rough), resolution);
        assert!((covered - area).abs() < 1e-8, "{covered} instead of {area} at {resolution} m");
    }
}

#[test]
fn coverage_sums_to_the_area_of_the_union() {
    check_area(&[], 0.0);
    check_area(&[rectangle((3.0, 3.0), (1.3, 0.7), 0.31)], 1.3 * 0.7);
    let circle = Shape::Circle { center: (4.0, 3.1), radius: 0.9 };
    check_area(&[circle], 0.5 * 64.0 * 0.81 * libm::sin(TAU / 64.0));
    check_area(&[wall((1.0, 1.0), (4.0, 5.0), 0.2)], 5.0 * 0.2);
    let arrow = Shape::Polygon(vec![(1.0, 1.0), (5.0, 3.0), (1.0, 5.0), (3.0, 3.0)]);
    check_area(&[arrow], 4.0);
}

#[test]
fn overlaps_count_once() {
    let square = |x| rectangle((x, 3.0), (2.0, 2.0), 0.0);
    check_area(&[square(3.0), square(4.0)], 6.0);
    check_area(&[square(3.0), square(3.0)], 4.0);
    // A square and the same turned by 45° about its centre make an eight-pointed star.
    let turned = rectangle((3.0, 3.0), (2.0, 2.0), FRAC_PI_4);
    let point = std::f64::consts::SQRT_2 - 1.0;
    check_area(&[square(3.0), turned], 4.0 + 4.0 * point * point);
    check_area(&[rectangle((0.0, 0.0), (2.0, 2.0), 0.0)], 1.0);
}

#[test]
fn an_oblique_wall_covers_half_of_a_cell() {
    let half = Shape::Polygon(vec![(0.0, 0.0), (6.0, 6.0), (0.0, 6.0)]);
    let world = world(8.0, 6.0, &[half], Surface::Rough);
    let grid = world.grid(0.1).unwrap();
    let coverage = world.coverage(&grid);
    let at = |x, y| coverage[grid.index(grid.cell_at(Point2::new(x, y)).unwrap()).unwrap()];
    assert!((at(3.05, 3.05) - 0.5).abs() < EXACT);
    assert_eq!((at(3.15, 3.05), at(3.05, 3.15), at(-0.05, 3.0)), (0.0, 1.0, 1.0));
}

#[test]
fn a_wall_on_the_lines_of_the_grid_covers_whole_cells() {
    let shapes = [rectangle((3.0, 3.0), (0.2, 6.0), 0.0)];
    let world = world(8.0, 6.0, &shapes, Surface::Rough);
    let grid = world.grid(0.1).unwrap();
    assert!(world.coverage(&grid).values().iter().all(|&c| c == 0.0 || c == 1.0));
}

#[test]
fn the_cell_that_an_extent_cuts_is_partly_outside() {
    let world = world(1.0, 0.25, &[], Surface::Rough);
    let grid = world.grid(0.1).unwrap();
    let coverage = world.coverage(&grid);
    let cell = grid.cell_at(Point2::new(0.55, 0.22)).unwrap();
    assert!((coverage.get(cell).unwrap() - 0.5).abs() < EXACT);
}

/// Returns the points of a shape, computed independently of the crate.
fn points(shape: &Shape) -> Vec<(f64, f64)> {
    match shape.clone() {
        Shape::Polygon(points) => points,
        Shape::Circle { center: (x, y), radius } => (0..64)
            .map(|k| libm::sincos(TAU * f64::from(k) / 64.0))
            .map(|(sin, cos)| (x + radius * cos, y + radius * sin))
            .collect(),
        Shape::Rectangle { center: (x, y), size: (w, h), angle } => {
            let (sin, cos) = libm::sincos(angle);
            let turned = |u: f64, v: f64| (x + u * cos - v * sin, y + u * sin + v * cos);
            let (w, h) = (0.5 * w, 0.5 * h);
            vec![turned(-w, -h), turned(w, -h), turned(w, h), turned(-w, h)]
        }
        Shape::Wall { from: (x, y), to: (u, v), thickness } => {
            let length = libm::hypot(u - x, v - y);
            let (a, b) = ((y - v) / length * 0.5 * thickness, (u - x) / length * 0.5 * thickness);
            vec![(x - a, y - b), (u - a, v - b), (u + a, v + b), (x + a, y + b)]
        }
    }
}

type Segment = ((f64, f64), (f64, f64));

fn crossing_height((a, b): &Segment, (c, d): &Segment) -> Option<f64> {
    let (u, v) = ((b.0 - a.0, b.1 - a.1), (d.0 - c.0, d.1 - c.1));
    let sine = u.0 * v.1 - u.1 * v.0;
    let t = ((c.0 - a.0) * v.1 - (c.1 - a.1) * v.0) / sine;
    (sine != 0.0 && (-0.01..=1.01).contains(&t)).then_some(a.1 + u.1 * t)
}

/// Returns the area of a union inside a box, slab by slab between all heights with a vertex or a
/// crossing.
///
/// Widths are linear in a slab: its middle is exact.
fn area_by_slabs(shapes: &[Shape], (x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> f64 {
    let closed = |p: Vec<(f64, f64)>| {
        let next = p.clone().into_iter().cycle().skip(1);
        p.into_iter().zip(next).collect::<Vec<Segment>>()
    };
    let rings: Vec<Vec<Segment>> = shapes.iter().map(|s| closed(points(s))).collect();
    let mut all: Vec<Segment> = rings.concat();
    all.extend([((x0, y0), (x0, y1)), ((x1, y0), (x1, y1))]);
    let mut heights: Vec<f64> = vec![y0, y1];
    for (i, s) in all.iter().enumerate() {
        heights.extend([s.0.1, s.1.1]);
        heights.extend(all[..i].iter().filter_map(|t| crossing_height(s, t)));
    }
    heights.retain(|y| (y0..=y1).contains(y));
    heights.sort_by(f64::total_cmp);
    let slab = |pair: &[f64]| {
        let middle = 0.5 * (pair[0] + pair[1]);
        let crosses = |(a, b): &&Segment| (a.1 <= middle) != (b.1 <= middle);
        let mut spans: Vec<(f64, f64)> = Vec::new();
        for ring in &rings {
            let at = |(a, b): &Segment| a.0 + (b.0 - a.0) * (middle - a.1) / (b.1 - a.1);
            let mut xs: Vec<f64> = ring.iter().filter(crosses).map(at).collect();
            xs.sort_by(f64::total_cmp);
            spans.extend(xs.chunks(2).map(|c| (c[0].clamp(x0, x1), c[1].clamp(x0, x1))));
        }
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut width, mut reached) = (0.0, x0);
        for (from, to) in spans {
            width += (to - from.max(reached)).max(0.0);
            reached = reached.max(to);
        }
        width * (pair[1] - pair[0])
    };
    heights.windows(2).map(slab).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn each_cell_is_exact(shapes in any_shapes(), resolution in 0.15..0.6) {
        let world = world(8.0, 6.0, &shapes, Surface::Rough);
        let grid = world.grid(resolution).unwrap();
        let coverage = world.coverage(&grid);
        for cell in grid.cells().filter(|c| (c.x + 3 * c.y) % 5 == 0) {
            let (low, high) = (grid.lower_corner(cell), grid.lower_corner(cell.offset(1, 1)));
            if low.x < 0.0 || low.y < 0.0 || high.x > 8.0 || high.y > 6.0 {
                continue;
            }
            let area = area_by_slabs(&shapes, (low.x, low.y), (high.x, high.y));
            let expected = area / (resolution * resolution);
            let found = *coverage.get(cell).unwrap();
            prop_assert!((found - expected).abs() < EXACT, "{cell:?}: {found} not {expected}");
        }
    }

    #[test]
    fn either_winding_covers_the_same(shapes in any_shapes()) {
        let turn = |shape: &Shape| {
            let mut points = points(shape);
            points.reverse();
            Shape::Polygon(points)
        };
        let turned: Vec<Shape> = shapes.iter().map(turn).collect();
        let of = |shapes: &[Shape]| {
            let world = world(8.0, 6.0, shapes, Surface::Rough);
            world.coverage(&world.grid(0.2).unwrap())
        };
        let (one, other): (Raster<f64>, Raster<f64>) = (of(&shapes), of(&turned));
        for (a, b) in one.values().iter().zip(other.values()) {
            prop_assert!((a - b).abs() < EXACT);
        }
    }

    #[test]
    fn a_coarser_cell_has_the_mean_of_its_parts(shapes in any_shapes()) {
        let world = world(8.0, 6.0, &shapes, Surface::Rough);
        let fine = world.coverage(&Grid::new(Point2::origin(), 0.1, 80, 60).unwrap());
        let coarse = world.coverage(&Grid::new(Point2::origin(), 0.2, 40, 30).unwrap());
        for (cell, c) in coarse.iter() {
            let part = |dx, dy| fine.get(Cell::new(2 * cell.x + dx, 2 * cell.y + dy)).unwrap();
            let mean = 0.25 * (part(0, 0) + part(1, 0) + part(0, 1) + part(1, 1));
            prop_assert!((c - mean).abs() < EXACT);
        }
    }
}
