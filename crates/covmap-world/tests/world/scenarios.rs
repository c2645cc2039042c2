//! Scenarios as files, valid and hostile.

use crate::build::{rectangle, scenario, wall, with_start, world};
use covmap_world::{Scenario, Shape, Surface, World, WorldError};
use nalgebra::{Point2, Vector2};
use proptest::prelude::*;

const OFFICE: &str = r#"(
    name: "office",
    extent: (width: 20.0, height: 12.0),
    start: (x: 1.5, y: 6.0, heading: 0.0),
    obstacles: [
        (shape: Rectangle(center: (3.0, 1.4), size: (0.8, 0.9), angle: 0.3), surface: Rough),
        (shape: Polygon([(6.0, 0.2), (7.5, 0.2), (7.5, 0.6), (6.4, 1.9)]), surface: Smooth),
        (shape: Wall(from: (0.0, 4.9), to: (2.0, 4.9), thickness: 0.15), surface: Smooth),
        (shape: Circle(center: (12.0, 9.5), radius: 0.3), surface: Rough),
    ],
)"#;

fn read(text: &str) -> Result<Scenario, ron::error::SpannedError> {
    ron::from_str(text)
}

#[test]
fn a_scenario_reads_as_documented() {
    let scenario = read(OFFICE).unwrap();
    let world = World::from_scenario(&scenario, Surface::Rough).unwrap();
    assert_eq!((world.name(), world.size()), ("office", Vector2::new(20.0, 12.0)));
    assert_eq!(world.given_start().unwrap().translation.vector, Vector2::new(1.5, 6.0));
    assert!(world.is_solid(Point2::new(7.0, 0.5)) && !world.is_solid(Point2::new(5.9, 0.5)));
    let right = world.cast_ray(Point2::new(10.0, 9.5), Vector2::x(), 9.0).unwrap();
    assert!((right - 1.7).abs() < 1e-12);
    assert_eq!(read(&ron::to_string(&scenario).unwrap()).unwrap(), scenario);
    let without = OFFICE.replace("start: (x: 1.5, y: 6.0, heading: 0.0),", "");
    let without = read(&without).unwrap();
    assert_eq!(without.start, None);
    assert_eq!(read(&ron::to_string(&without).unwrap()).unwrap(), without);
}

#[test]
fn an_unknown_or_missing_field_is_an_error() {
    assert!(read(&OFFICE.replace("heading", "angle")).is_err());
    assert!(read(&OFFICE.replace("height: 12.0", "")).is_err());
    assert!(read(&OFFICE.replace("surface: Rough", "")).is_err());
    assert!(read(&OFFICE.replace("radius: 0.3", "radius: 0.3, color: 1")).is_err());
}

#[track_caller]
fn refused(scenario: &Scenario, message: &str) {
    let error = World::from_scenario(scenario, Surface::Rough).unwrap_err().to_string();
    assert!(error.contains(message), "{error}");
}

#[test]
fn bad_scenarios_are_refused_in_one_clear_sentence() {
    let of = |shape: Shape| {
        scenario(8.0, 6.0, &[wall((1.0, 1.0), (2.0, 1.0), 0.1), shape], Surface::Rough)
    };
    refused(
        &of(rectangle((1.0, f64::NAN), (1.0, 1.0), 0.0)),
        "obstacle 1 (Rectangle): NaN must be a finite",
    );
    refused(
        &of(rectangle((1.0, 1.0), (1.0, -1.0), 0.0)),
        "obstacle 1 (Rectangle): its height of -1 m",
    );
    refused(&of(wall((1.0, 1.0), (1.0, 1.0), 0.1)), "obstacle 1 (Wall): its length of 0 m");
    refused(&of(Shape::Circle { center: (1.0, 1.0), radius: 0.0 }), "its radius of 0 m");
    refused(
        &of(Shape::Circle { center: (1e9, 1.0), radius: 1.0 }),
        "1000000000 must be a finite number within",
    );
    let bow = vec![(0.0, 0.0), (2.0, 1.0), (2.0, 0.0), (0.0, 2.0)];
    refused(
        &of(Shape::Polygon(bow)),
        "obstacle 1 (Polygon): the sides from points 0 and 2 cross or touch",
    );
    refused(&of(Shape::Polygon(vec![(0.0, 0.0); 20_000])), "20000 points are more than");
    refused(&scenario(0.0, 6.0, &[], Surface::Rough), "the extent of 0 × 6 m");
    refused(&scenario(8.0, f64::INFINITY, &[], Surface::Rough), "inf m must lie between");
    let free = scenario(8.0, 6.0, &[rectangle((4.0, 3.0), (1.0, 1.0), 0.0)], Surface::Rough);
    refused(
        &with_start(free.clone(), 4.2, 3.2, 0.0),
        "the start (4.2, 3.2) lies inside an obstacle",
    );
    refused(&with_start(free.clone(), 9.0, 3.0, 0.0), "inside the extent");
    refused(&with_start(free.clone(), 1.0, 3.0, f64::NAN), "heading of NaN rad");
    refused(&Scenario { name: "../x".into(), ..free }, "\"../x\" must have");
}

#[test]
fn too_much_is_refused() {
    let circle = Shape::Circle { center: (1.0, 1.0), radius: 0.5 };
    let many = scenario(8.0, 6.0, &vec![circle.clone(); 100_001], Surface::Rough);
    let error = World::from_scenario(&many, Surface::Rough).unwrap_err();
    assert_eq!(error, WorldError::TooManyObstacles(100_001));
    // The circles are so near to each other that none buries another.
    let beside = |k| Shape::Circle { center: (1.0 + 1e-9 * f64::from(k), 1.0), radius: 0.5 };
    let piled = scenario(8.0, 6.0, &(0..10_000).map(beside).collect::<Vec<_>>(), Surface::Rough);
    let error = World::from_scenario(&piled, Surface::Rough).unwrap_err();
    assert_eq!(error, WorldError::TooDense);
}

#[test]
fn the_same_thing_ten_thousand_times_is_there_once() {
    let circle = Shape::Circle { center: (3.0, 3.0), radius: 0.5 };
    let world = world(8.0, 6.0, &vec![circle; 10_000], Surface::Rough);
    assert!((world.clearance(Point2::new(3.0, 2.0)) - 0.5).abs() < 1e-12);
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -3.0..10.0,
        1 => any::<f64>(),
        1 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, 1e-300, 5e-324, 1e308, 1.0, 2.0]),
    ]
}

fn any_pair() -> impl Strategy<Value = (f64, f64)> {
    (any_number(), any_number())
}

fn hostile_shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (any_pair(), any_pair(), any_number()).prop_map(|(c, s, a)| rectangle(c, s, a)),
        (any_pair(), any_pair(), any_number()).prop_map(|(a, b, t)| wall(a, b, t)),
        (any_pair(), any_number()).prop_map(|(center, radius)| Shape::Circle { center, radius }),
        prop::collection::vec(any_pair(), 0..9).prop_map(Shape::Polygon),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_scenario_panics(shapes in prop::collection::vec(hostile_shape(), 0..4),
                          size in prop_oneof![Just((8.0, 6.0)), any_pair()], place in any_pair()) {
        let scenario = scenario(size.0, size.1, &shapes, Surface::Smooth);
        if let Ok(world) = World::from_scenario(&scenario, Surface::Rough) {
            let point = Point2::new(place.0, place.1);
            let clearance = world.clearance(point);
            prop_assert!(clearance >= 0.0);
            let _ = world.cast_ray(point, Vector2::y(), 5.0);
            let _ = world.drive(Point2::new(1.0, 1.0), point, 0.27);
            if let Ok(grid) = world.grid(size.0.max(size.1) / 20.0) {
                prop_assert!(world.coverage(&grid).values().iter().all(|c| (0.0..=1.0).contains(c)));
            }
        }
    }
}

/// Returns circles that lie on top of each other, and a free ring around them.
fn heap(count: u32) -> Vec<((f64, f64), f64)> {
    let place = |i: u32, by: f64| 2.0 + 6.0 * (f64::from(i) * by).fract();
    (0..count).map(|i| ((place(i, 0.618_034), place(i, 0.414_214)), 0.7)).collect()
}

#[test]
fn a_thousand_overlapping_circles_are_what_each_of_them_is() {
    let circles = heap(1000);
    let shape = |&(center, radius): &((f64, f64), f64)| Shape::Circle { center, radius };
    let shapes: Vec<Shape> = circles.iter().map(shape).collect();
    let world = world(10.0, 10.0, &shapes, Surface::Rough);
    // A circle of 64 sides lies between the circles of these radii.
    let inner = 0.7 * libm::cos(std::f64::consts::PI / 64.0);
    let nearest = |x: f64, y: f64| {
        let distance = |((u, v), _): &((f64, f64), f64)| libm::hypot(x - u, y - v);
        circles.iter().map(distance).fold(f64::INFINITY, f64::min)
    };
    for i in 0..4000 {
        let at = |by: f64| 10.0 * (f64::from(i) * by).fract();
        let (x, y) = (at(0.732_051), at(0.236_068));
        let (solid, nearest) = (world.is_solid(Point2::new(x, y)), nearest(x, y));
        assert!(solid || nearest > inner - 1e-9, "({x}, {y}) is free");
        assert!(!solid || nearest < 0.7 + 1e-9, "({x}, {y}) is solid");
        if !solid {
            let border = x.min(y).min(10.0 - x).min(10.0 - y);
            let clearance = world.clearance(Point2::new(x, y));
            let bounds = [nearest - 0.7, nearest - inner].map(|c| c.min(border));
            assert!(bounds[0] - 1e-9 <= clearance && clearance <= bounds[1] + 1e-9);
        }
    }
}
