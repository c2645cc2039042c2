//! Benchmarks: a ring's firing beside the ray casts of parry alone, and the exact coverage of an
//! office.
#![allow(missing_docs, reason = "a benchmark")]

use covmap::Grid;
use covmap_sonar::SonarRing;
use covmap_statistics::stream;
use covmap_world::{Extent, Obstacle, Scenario, Shape, SonarPhysics, Surface, World};
use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry2, Point2, Vector2};
use parry2d::math::Vec2;
use parry2d::partitioning::{Bvh, BvhBuildStrategy};
use parry2d::query::{Ray, RayCast};
use parry2d::shape::Segment;
use std::hint::black_box;

/// Turned boxes on a lattice, four sides each.
fn boxes(width: f64, height: f64, columns: u32, rows: u32) -> Scenario {
    let (dx, dy) = (width / f64::from(columns), height / f64::from(rows));
    let shape = |k: u32| Shape::Rectangle {
        center: (dx * (f64::from(k % columns) + 0.5), dy * (f64::from(k / columns) + 0.5)),
        size: (0.35 * dx, 0.3 * dy),
        angle: f64::from(k),
    };
    let obstacles = (0..columns * rows)
        .map(|k| Obstacle { shape: shape(k), surface: Surface::Rough })
        .collect();
    Scenario { name: "boxes".into(), extent: Extent { width, height }, start: None, obstacles }
}

fn firing(criterion: &mut Criterion) {
    let scenario = boxes(50.0, 25.0, 50, 25);
    let world = World::from_scenario(&scenario, Surface::Rough).expect("a valid world");
    let (ring, physics) = (SonarRing::b21r(), SonarPhysics::b21r());
    let pose = Isometry2::new(Vector2::new(25.0, 12.0), 0.2);
    let mut rng = stream(1, "bench", 0);
    criterion.bench_function("fire 24 sonars among 5000 segments", |b| {
        b.iter(|| world.fire(&ring, black_box(&pose), &physics, &mut rng));
    });

    let segments: Vec<Segment> = scenario.obstacles.iter().flat_map(sides).collect();
    let leaves: Vec<_> = segments.iter().map(Segment::local_aabb).collect();
    let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves);
    let rays: Vec<Ray> = (0..24 * 11)
        .map(|k| libm::sincosf(std::f32::consts::TAU * k as f32 / (24.0 * 11.0)))
        .map(|(sin, cos)| Ray::new(Vec2::new(25.0, 12.0), Vec2::new(cos, sin)))
        .collect();
    criterion.bench_function("parry: 264 rays among 5000 segments", |b| {
        b.iter(|| {
            let hit = |ray: &Ray| {
                tree.cast_ray(ray, 10.7, |i, best| {
                    segments[i as usize].cast_local_ray(ray, best, true)
                })
            };
            rays.iter().filter_map(hit).map(|(_, t)| t).sum::<f32>()
        });
    });
}

fn sides(obstacle: &Obstacle) -> Vec<Segment> {
    let &Shape::Rectangle { center: (x, y), size: (w, h), angle } = &obstacle.shape else {
        unreachable!("all are boxes")
    };
    let (sin, cos) = libm::sincos(angle);
    #[allow(clippy::cast_possible_truncation, reason = "parry computes in f32")]
    let corner = |u: f64, v: f64| {
        let (u, v) = (0.5 * u * w, 0.5 * v * h);
        Vec2::new((x + u * cos - v * sin) as f32, (y + u * sin + v * cos) as f32)
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    (0..4).map(|k| Segment::new(corners[k], corners[(k + 1) % 4])).collect()
}

fn covering(criterion: &mut Criterion) {
    let world = World::from_scenario(&boxes(20.0, 12.0, 10, 6), Surface::Rough).expect("valid");
    let grid = Grid::new(Point2::origin(), 0.1, 200, 120).expect("valid");
    criterion.bench_function("coverage of 200 × 120 cells with 60 obstacles", |b| {
        b.iter(|| world.coverage(black_box(&grid)));
    });
    let coverage = world.coverage(&grid);
    let reached = world.reachable_cells(&grid, Point2::new(0.1, 0.1), 0.05);
    criterion.bench_function("reachable cells", |b| {
        b.iter(|| world.reachable_cells(&grid, Point2::new(0.1, 0.1), 0.05));
    });
    criterion.bench_function("cells seen within 3 m", |b| {
        b.iter(|| world.cells_seen(&grid, &coverage, &reached, 3.0));
    });
}

fn building(criterion: &mut Criterion) {
    let place = |i: u32, by: f64| 2.0 + 6.0 * (f64::from(i) * by).fract();
    for count in [250, 500, 1000, 2000] {
        let circle = |i: u32| Shape::Circle {
            center: (place(i, 0.618_034), place(i, 0.414_214)),
            radius: 1.0,
        };
        let obstacles =
            (0..count).map(|i| Obstacle { shape: circle(i), surface: Surface::Rough }).collect();
        let extent = Extent { width: 10.0, height: 10.0 };
        let scenario = Scenario { name: "heap".into(), extent, start: None, obstacles };
        criterion.bench_function(&format!("a world of {count} overlapping circles"), |b| {
            b.iter(|| World::from_scenario(black_box(&scenario), Surface::Rough));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = firing, covering, building
}
criterion_main!(benches);
