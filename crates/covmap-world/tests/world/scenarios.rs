//! Scenarios as files, good and hostile.

use crate::build::{rectangle, scenario, wall, with_start};
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
    refused(&with_start(free.clone(), 1.0, 3.0, f64::NAN), "heading NaN");
    refused(&Scenario { name: "../x".into(), ..free }, "\"../x\" must have");
}

#[test]
fn too_much_is_refused() {
    let circle = Shape::Circle { center: (1.0, 1.0), radius: 0.5 };
    let many = scenario(8.0, 6.0, &vec![circle.clone(); 100_001], Surface::Rough);
    let error = World::from_scenario(&many, Surface::Rough).unwrap_err();
    assert_eq!(error, WorldError::TooManyObstacles(100_001));
    let piled = scenario(8.0, 6.0, &vec![circle; 10_000], Surface::Rough);
    let error = World::from_scenario(&piled, Surface::Rough).unwrap_err();
    assert_eq!(error, WorldError::TooDense);
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
