//! Fires the sonars of a B21r in a room with a pillar, and compares the ranges with the truth.
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap_sonar::{Range, SonarRing};
use covmap_statistics::stream;
use covmap_world::{Extent, Obstacle, Scenario, Shape, SonarPhysics, Surface, World};
use nalgebra::{Isometry2, Vector2};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = Scenario {
        name: "pillar".into(),
        extent: Extent { width: 6.0, height: 4.0 },
        start: None,
        obstacles: vec![Obstacle {
            shape: Shape::Circle { center: (4.5, 2.0), radius: 0.3 },
            surface: Surface::Rough,
        }],
    };
    let world = World::from_scenario(&scenario, Surface::Smooth)?;
    let pose = Isometry2::new(Vector2::new(2.0, 2.0), 0.0);
    let (ring, physics) = (SonarRing::b21r(), SonarPhysics::b21r());
    let ranges = world.fire(&ring, &pose, &physics, &mut stream(1, "fire", 0));

    println!("{:>8} {:>10} {:>10}", "bearing", "on axis", "measured");
    for (beam, range) in ring.beams().iter().zip(ranges) {
        let sensor = pose * beam.pose;
        let axis = sensor.rotation * Vector2::x();
        let truth = world.cast_ray(sensor.translation.vector.into(), axis, beam.max_range);
        let measured = match range {
            Range::Echo(distance) => format!("{distance:.2} m"),
            Range::NoEcho => "no echo".into(),
            Range::Missing => "missing".into(),
        };
        let truth = truth.map_or("-".into(), |d| format!("{d:.2} m"));
        println!("{:>7.1}° {truth:>10} {measured:>10}", beam.pose.rotation.angle().to_degrees());
    }
    Ok(())
}
