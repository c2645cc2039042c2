//! Faithfulness of the simulated sonars to the known behaviour of real ones.

use crate::build::{any_shapes, rectangle, wall, world};
use covmap_sonar::{Beam, Range, SonarRing};
use covmap_statistics::stream;
use covmap_world::{Blanking, Shape, SonarPhysics, Surface, World};
use nalgebra::{Isometry2, Point2, Vector2};
use proptest::prelude::*;

const CONE: f64 = 12.5;

/// Returns one sonar in the middle of a robot, with its cone's half-angle in degrees.
fn sonar(half_angle: f64) -> Beam {
    let half_angle = half_angle.to_radians();
    Beam { pose: Isometry2::identity(), half_angle, min_range: 0.26, max_range: 10.7 }
}

fn exact() -> SonarPhysics {
    SonarPhysics::b21r().without_noise()
}

fn pose(x: f64, y: f64, degrees: f64) -> Isometry2<f64> {
    Isometry2::new(Vector2::new(x, y), degrees.to_radians())
}

/// Returns the largest angle from the normal at which a wall 2 m away still answers with its own
/// distance.
fn region_of_constant_range(surface: Surface, half_angle: f64) -> f64 {
    let world = world(60.0, 60.0, &[wall((40.0, 0.0), (40.0, 60.0), 1.0)], surface);
    let at = |degrees: f64| {
        world
            .echo(&sonar(half_angle), &pose(37.5, 30.0, degrees), &exact())
            .is_some_and(|d| (d - 2.0).abs() < 1e-9)
    };
    (0..900).map(|k| f64::from(k) * 0.1).take_while(|&d| at(d)).last().unwrap()
}

#[test]
fn turning_before_a_wall_gives_a_region_of_constant_range() {
    assert!((region_of_constant_range(Surface::Smooth, CONE) - CONE).abs() < 0.11);
    assert!((region_of_constant_range(Surface::Rough, CONE) - CONE).abs() < 0.11);
    assert!((region_of_constant_range(Surface::Smooth, 7.5) - 7.5).abs() < 0.11);
}

#[test]
fn a_smooth_wall_stops_answering_beyond_cone_and_critical_angle() {
    let world = world(60.0, 60.0, &[wall((40.0, 0.0), (40.0, 60.0), 1.0)], Surface::Smooth);
    let at = |degrees: f64| world.echo(&sonar(CONE), &pose(37.5, 30.0, degrees), &exact());
    let oblique = at(30.0).unwrap();
    assert!((oblique - 2.0 / libm::cos(17.5_f64.to_radians())).abs() < 1e-6);
    assert!(at(32.4).is_some() && at(32.6).is_none());
}

#[test]
fn a_right_corner_reads_its_own_distance() {
    let world = world(10.0, 10.0, &[], Surface::Smooth);
    let reading = world.echo(&sonar(CONE), &pose(6.0, 6.0, 45.0), &exact()).unwrap();
    assert!((reading - 4.0 * std::f64::consts::SQRT_2).abs() < 1e-6, "{reading}");
    // So does the corner between two walls that cross.
    let shapes = [wall((4.0, 0.0), (4.0, 10.0), 0.2), wall((0.0, 5.0), (10.0, 5.0), 0.2)];
    let world = crate::build::world(10.0, 10.0, &shapes, Surface::Smooth);
    let reading = world.echo(&sonar(CONE), &pose(6.1, 7.1, 225.0), &exact()).unwrap();
    assert!((reading - 2.0 * std::f64::consts::SQRT_2).abs() < 1e-6, "{reading}");
}

#[test]
fn a_convex_edge_answers_only_nearby() {
    // A smooth post whose edge points at the sensor.
    let world = world(
        20.0,
        20.0,
        &[rectangle((15.0, 10.0), (1.0, 1.0), 45.0_f64.to_radians())],
        Surface::Smooth,
    );
    let edge = 15.0 - std::f64::consts::FRAC_1_SQRT_2;
    let at = |distance: f64| world.echo(&sonar(5.0), &pose(edge - distance, 10.0, 0.0), &exact());
    assert!((at(1.9).unwrap() - 1.9).abs() < 1e-6);
    assert!(at(2.1).is_none_or(|d| d > 2.2));
}

/// Returns the share of bad readings while driving along 8 m of corridor.
///
/// A reading is bad if it is missing, or too long by more than 10 %, where the nearest point in the
/// cone is within the usable 3 m.
fn bad_share(surface: Surface) -> f64 {
    let world = world(20.0, 2.5, &[], surface);
    let (ring, physics) = (SonarRing::b21r(), SonarPhysics::b21r());
    let all = SonarPhysics {
        critical_angle_rough: 1.57,
        critical_angle_smooth: 1.57,
        ..physics.without_noise()
    };
    let mut rng = stream(1, "corridor", 0);
    let (mut bad, mut count) = (0, 0);
    for k in 0..80 {
        let pose = pose(6.0 + 0.1 * f64::from(k), 1.25, 0.0);
        for (beam, range) in ring.beams().iter().zip(world.fire(&ring, &pose, &physics, &mut rng)) {
            let truth = world.echo(beam, &pose, &all).unwrap().min(3.0);
            let read = match range {
                Range::Echo(d) => d.min(3.0),
                Range::NoEcho | Range::Missing => 3.0,
            };
            bad += u32::from(read > 1.1 * truth);
            count += 1;
        }
    }
    f64::from(bad) / f64::from(count)
}

#[test]
fn in_a_smooth_corridor_half_of_the_readings_are_too_long_or_missing() {
    let (smooth, rough) = (bad_share(Surface::Smooth), bad_share(Surface::Rough));
    assert!(smooth > 0.3 && smooth < 0.7, "smooth: {smooth}");
    assert!(rough < 0.1, "rough: {rough}");
}

#[test]
fn a_door_opens_at_the_distance_that_the_cone_implies() {
    // The wall is seen beside the door until the cone is narrower than the door.
    let shapes = [wall((10.0, 0.0), (10.0, 4.55), 0.1), wall((10.0, 5.45), (10.0, 10.0), 0.1)];
    let world = world(20.0, 10.0, &shapes, Surface::Rough);
    let through = |d: f64| {
        let reading = world.echo(&sonar(CONE), &pose(9.95 - d, 5.0, 0.0), &exact());
        reading.is_none_or(|r| r > d + 1.0)
    };
    let opens = 0.45 / libm::tan(CONE.to_radians());
    assert!(through(opens - 0.02), "closed at {}", opens - 0.02);
    assert!(!through(opens + 0.02), "open at {}", opens + 0.02);
}

#[test]
fn a_chair_leg_of_3_cm_is_seen_at_3_m() {
    for surface in [Surface::Rough, Surface::Smooth] {
        for k in -40..=40 {
            let angle = 12.0_f64.to_radians() * f64::from(k) / 40.0;
            let (sin, cos) = libm::sincos(angle);
            let leg = Shape::Circle { center: (5.0 + 3.0 * cos, 10.0 + 3.0 * sin), radius: 0.015 };
            let world = world(20.0, 20.0, &[leg], surface);
            let reading = world.echo(&sonar(CONE), &pose(5.0, 10.0, 0.0), &exact()).unwrap();
            assert!((reading - 2.985).abs() < 1e-3, "{reading} at {angle}");
        }
    }
}

#[test]
fn a_cone_that_shrinks_passes_what_a_wide_one_sees() {
    let leg = Shape::Circle { center: (8.0, 10.5), radius: 0.015 };
    let world = world(20.0, 20.0, &[leg], Surface::Rough);
    let at = |shrink: f64| {
        let physics = SonarPhysics { cone_shrink_per_metre: shrink.to_radians(), ..exact() };
        world.echo(&sonar(CONE), &pose(5.0, 10.0, 0.0), &physics).unwrap_or(10.7)
    };
    assert!(at(0.0) < 3.1 && at(1.0) < 3.1 && at(1.7) > 3.5);
}

#[test]
fn a_mirror_shows_what_stands_beside_it() {
    // A line at 45° to a smooth wall continues to the rough one, 2 m farther.
    let mut scenario =
        crate::build::scenario(10.0, 10.0, &[wall((8.0, 0.0), (8.0, 10.0), 0.2)], Surface::Smooth);
    scenario.obstacles.push(covmap_world::Obstacle {
        shape: rectangle((5.0, 8.95), (10.0, 0.1), 0.0),
        surface: Surface::Rough,
    });
    let world = World::from_scenario(&scenario, Surface::Rough).unwrap();
    let root = std::f64::consts::SQRT_2;
    let read = |bounces| {
        let physics = SonarPhysics { max_bounces: bounces, ..exact() };
        world.echo(&sonar(0.0), &pose(6.9, 6.9, 45.0), &physics)
    };
    assert_eq!(read(0), None);
    assert!((read(1).unwrap() - 2.0 * root).abs() < 1e-6, "{:?}", read(1));
}

#[test]
fn blanking_reports_the_minimum_or_nothing() {
    let world = world(10.0, 10.0, &[], Surface::Rough);
    let ring = SonarRing::new(vec![sonar(CONE)]).unwrap();
    let read = |x: f64, blanking| {
        let physics = SonarPhysics { blanking, ..exact() };
        world.fire(&ring, &pose(x, 5.0, 0.0), &physics, &mut stream(1, "fire", 0))[0]
    };
    assert_eq!(read(9.9, Blanking::ReportMinimum), Range::Echo(0.26));
    assert_eq!(read(9.9, Blanking::Missing), Range::Missing);
    assert_eq!(read(10.1, Blanking::Missing), Range::Missing);
    assert!(matches!(read(8.0, Blanking::Missing), Range::Echo(d) if (d - 2.0).abs() < 1e-9));
    assert_eq!(
        world.echo(&Beam { max_range: 1.0, ..sonar(CONE) }, &pose(5.0, 5.0, 0.0), &exact()),
        None
    );
}

#[test]
fn noise_and_false_readings_come_as_often_as_asked() {
    let world = world(10.0, 10.0, &[], Surface::Rough);
    let ring = SonarRing::new(vec![sonar(CONE)]).unwrap();
    let physics = SonarPhysics { p_uniform: 0.05, p_spurious_no_echo: 0.1, ..SonarPhysics::b21r() };
    let mut rng = stream(1, "noise", 0);
    let all: Vec<Range> = (0..20_000)
        .map(|_| world.fire(&ring, &pose(6.0, 5.0, 0.0), &physics, &mut rng)[0])
        .collect();
    let lost = all.iter().filter(|r| **r == Range::NoEcho).count() as f64 / 2e4;
    assert!((lost - 0.1).abs() < 0.01, "{lost}");
    let near: Vec<f64> = all
        .iter()
        .filter_map(|r| match r {
            Range::Echo(d) if (d - 4.0).abs() < 0.2 => Some(d - 4.0),
            _ => None,
        })
        .collect();
    let deviation = (near.iter().map(|e| e * e).sum::<f64>() / near.len() as f64).sqrt();
    assert!((deviation - 0.04).abs() < 0.003, "{deviation}");
    let wrong = 1.0 - lost - near.len() as f64 / 2e4;
    assert!((wrong - 0.048).abs() < 0.01, "{wrong}");
}

#[test]
fn every_sensor_draws_the_same_number_of_variates() {
    let ring = SonarRing::b21r();
    let next = |width: f64, surface| {
        let mut rng = stream(3, "fire", 9);
        let world = world(width, 5.0, &[], surface);
        let _ = world.fire(&ring, &pose(2.0, 2.0, 0.3), &SonarPhysics::b21r(), &mut rng);
        world.fire(&ring, &pose(2.0, 2.0, 0.3), &exact(), &mut rng).len();
        rng
    };
    assert_eq!(next(4.0, Surface::Rough), next(90.0, Surface::Smooth));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn eleven_rays_see_what_101_see(shapes in any_shapes(), x in 0.3..7.7, y in 0.3..5.7, heading in 0.0..360.0) {
        let world = world(8.0, 6.0, &shapes, Surface::Smooth);
        prop_assume!(!world.is_solid(Point2::new(x, y)));
        let read = |cone_rays| {
            let physics = SonarPhysics { cone_rays, max_bounces: 0, ..exact() };
            world.echo(&sonar(CONE), &pose(x, y, heading), &physics)
        };
        match (read(11), read(101)) {
            (Some(few), Some(many)) => prop_assert!((few - many).abs() < 1e-4, "{few} {many}"),
            (few, many) => prop_assert_eq!(few, many),
        }
    }

    #[test]
    fn an_echo_is_never_nearer_than_the_nearest_solid(shapes in any_shapes(), x in 0.3..7.7, y in 0.3..5.7,
                                                      heading in 0.0..360.0, shrink in 0.0..0.05) {
        let world = world(8.0, 6.0, &shapes, Surface::Rough);
        let physics = SonarPhysics { cone_shrink_per_metre: shrink, ..exact() };
        if let Some(echo) = world.echo(&sonar(CONE), &pose(x, y, heading), &physics) {
            prop_assert!(echo >= world.clearance(Point2::new(x, y)) - 1e-6);
        }
    }

    #[test]
    fn a_rough_echo_is_what_many_rays_find(shapes in any_shapes(), x in 0.3..7.7, y in 0.3..5.7,
                                           heading in 0.0..360.0) {
        let world = world(8.0, 6.0, &shapes, Surface::Rough);
        let origin = Point2::new(x, y);
        prop_assume!(!world.is_solid(origin));
        let physics = SonarPhysics { critical_angle_rough: 1.57, ..exact() };
        let first = (-2000_i32..=2000)
            .map(|k| f64::to_radians(heading + CONE * f64::from(k) / 2000.0))
            .map(|angle| Vector2::new(libm::cos(angle), libm::sin(angle)))
            .filter_map(|direction| world.cast_ray(origin, direction, 10.7))
            .fold(f64::INFINITY, f64::min);
        let echo = world.echo(&sonar(CONE), &pose(x, y, heading), &physics).unwrap();
        prop_assert!(echo <= first + 1e-6 && echo > first - 2e-2 * first, "{echo} {first}");
    }
}
