//! A drive never passes through a solid.

use crate::build::{any_shapes, rectangle, wall, world};
use covmap_sonar::Drive;
use covmap_world::{Surface, World};
use nalgebra::{Point2, Vector2};
use proptest::prelude::*;

const RADIUS: f64 = 0.27;

fn stop(world: &World, from: (f64, f64), to: (f64, f64)) -> (Point2<f64>, bool) {
    let (from, to) = (Point2::new(from.0, from.1), Point2::new(to.0, to.1));
    match world.drive(from, to, RADIUS) {
        Drive::Arrived => (to, true),
        Drive::Bumped { at } | Drive::Stopped { at } => (at, false),
    }
}

#[test]
fn a_disc_stops_before_a_thin_wall() {
    let world = world(8.0, 6.0, &[wall((4.0, 0.0), (4.0, 6.0), 0.001)], Surface::Rough);
    let (at, arrived) = stop(&world, (1.0, 3.0), (7.0, 3.0));
    assert!(!arrived && (at.x - (4.0 - 0.0005 - RADIUS)).abs() < 2e-6, "{at}");
    let (at, _) = stop(&world, (1.0, 1.0), (1.0, -5.0));
    assert!((at.y - RADIUS).abs() < 2e-6);
}

#[test]
fn a_disc_passes_a_door_that_is_wide_enough() {
    let door = |width: f64| {
        let (low, high) = (3.0 - 0.5 * width, 3.0 + 0.5 * width);
        let shapes = [wall((4.0, 0.0), (4.0, low), 0.1), wall((4.0, high), (4.0, 6.0), 0.1)];
        stop(&world(8.0, 6.0, &shapes, Surface::Rough), (2.0, 3.0), (6.0, 3.0)).1
    };
    assert!(door(0.5401) && !door(0.5399));
}

#[test]
fn a_disc_in_contact_can_move_away_and_along_but_not_nearer() {
    let world = world(8.0, 6.0, &[rectangle((4.0, 3.0), (1.0, 6.0), 0.0)], Surface::Rough);
    let touching = (3.5 - RADIUS + 1e-4, 3.0);
    assert!(stop(&world, touching, (2.0, 3.0)).1);
    assert!(stop(&world, touching, (touching.0, 5.0)).1);
    let (at, arrived) = stop(&world, touching, (3.4, 3.0));
    assert!(!arrived && at == Point2::new(touching.0, touching.1));
    assert_eq!(stop(&world, (4.0, 3.0), (2.0, 3.0)), (Point2::new(4.0, 3.0), false));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_drive_tunnels(shapes in any_shapes(), x in 0.0..8.0, y in 0.0..6.0,
                        goals in prop::collection::vec((-1.0..9.0, -1.0..7.0), 1..6)) {
        let world = world(8.0, 6.0, &shapes, Surface::Rough);
        let mut from = Point2::new(x, y);
        if world.clearance(from) < RADIUS {
            return Ok(());
        }
        for (u, v) in goals {
            let goal = Point2::new(u, v);
            let (to, arrived) = match world.drive(from, goal, RADIUS) {
                Drive::Arrived => (goal, true),
                Drive::Bumped { at } | Drive::Stopped { at } => (at, false),
            };
            // The whole way was free …
            for k in 0..=100 {
                let clearance = world.clearance(from + (to - from) * (f64::from(k) / 100.0));
                prop_assert!(clearance >= RADIUS - 1e-6, "{clearance} on the way to {to}");
            }
            // … and a bump had a reason.
            if !arrived {
                let ahead: Vector2<f64> = (goal - from).normalize() * 1e-4;
                prop_assert!(world.clearance(to) < RADIUS + 2e-4);
                prop_assert!(world.clearance(to + ahead) < world.clearance(to));
            }
            from = to;
        }
    }

    #[test]
    fn clearance_is_the_radius_of_the_largest_free_disc(shapes in any_shapes(), x in 0.1..7.9,
                                                        y in 0.1..5.9) {
        let world = world(8.0, 6.0, &shapes, Surface::Rough);
        let (center, clearance) = (Point2::new(x, y), world.clearance(Point2::new(x, y)));
        prop_assert_eq!(clearance == 0.0, world.is_solid(center));
        prop_assume!(clearance > 0.0);
        let mut nearest = f64::INFINITY;
        for k in 0..360 {
            let (sin, cos) = libm::sincos(f64::from(k).to_radians());
            let direction = Vector2::new(cos, sin);
            prop_assert!(!world.is_solid(center + direction * (clearance * 0.999)));
            nearest = nearest.min(world.cast_ray(center, direction, 20.0).unwrap());
        }
        prop_assert!(nearest >= clearance - 1e-9);
    }
}
