//! Worlds for tests.

use covmap_world::{Extent, Obstacle, Scenario, Shape, Start, Surface, World};
use proptest::prelude::*;
use std::f64::consts::TAU;

pub(crate) fn scenario(width: f64, height: f64, shapes: &[Shape], surface: Surface) -> Scenario {
    let obstacle = |shape: &Shape| Obstacle { shape: shape.clone(), surface };
    Scenario {
        name: "test".into(),
        extent: Extent { width, height },
        start: None,
        obstacles: shapes.iter().map(obstacle).collect(),
    }
}

pub(crate) fn world(width: f64, height: f64, shapes: &[Shape], surface: Surface) -> World {
    World::from_scenario(&scenario(width, height, shapes, surface), surface).unwrap()
}

pub(crate) fn with_start(mut scenario: Scenario, x: f64, y: f64, heading: f64) -> Scenario {
    scenario.start = Some(Start { x, y, heading });
    scenario
}

pub(crate) fn rectangle(center: (f64, f64), size: (f64, f64), angle: f64) -> Shape {
    Shape::Rectangle { center, size, angle }
}

pub(crate) fn wall(from: (f64, f64), to: (f64, f64), thickness: f64) -> Shape {
    Shape::Wall { from, to, thickness }
}

/// Any valid shape around the inside of a world of 8 × 6 m.
pub(crate) fn any_shape() -> impl Strategy<Value = Shape> {
    let place = || (-0.5..8.5, -0.5..6.5);
    let angle = -4.0..4.0;
    prop_oneof![
        (place(), (0.05..2.0, 0.05..2.0), angle).prop_map(|(c, s, a)| rectangle(c, s, a)),
        (place(), place(), 0.05..0.4)
            .prop_filter("a length", |((x, y), (u, v), _)| (x - u).abs() + (y - v).abs() > 0.1)
            .prop_map(|(a, b, t)| wall(a, b, t)),
        (place(), 0.02..0.8).prop_map(|(center, radius)| Shape::Circle { center, radius }),
        (place(), prop::collection::vec(0.1..1.2, 3..12), any::<bool>()).prop_map(star),
    ]
}

/// Returns a polygon with points at given distances around a centre, of either winding.
fn star(((x, y), radii, clockwise): ((f64, f64), Vec<f64>, bool)) -> Shape {
    let count = radii.len() as f64;
    let point = |(k, r): (usize, &f64)| {
        let (sin, cos) = libm::sincos(TAU * k as f64 / count);
        (x + r * cos, y + r * sin)
    };
    let mut points: Vec<_> = radii.iter().enumerate().map(point).collect();
    if clockwise {
        points.reverse();
    }
    Shape::Polygon(points)
}

pub(crate) fn any_shapes() -> impl Strategy<Value = Vec<Shape>> {
    prop::collection::vec(any_shape(), 0..10)
}
