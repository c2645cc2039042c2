//! Describes a ring of sonars, and places the echoes of a scan in the world.
//!
//! ```text
//! cargo run -p covmap-sonar --example describe_a_ring
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap_sonar::{Range, RingSpecification, Scan, SonarRing};
use nalgebra::{Isometry2, Point2, Vector2};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    // Eight sonars on a circle of 0.2 m around the robot's centre.
    let ring = SonarRing::from_specification(&RingSpecification::Circle {
        count: 8,
        radius: 0.2,
        half_angle: 0.26,
        min_range: 0.2,
        max_range: 5.0,
    })?;

    // The robot stands at (2, 1) and looks along y. One sonar hears nothing, one is broken.
    let mut ranges = vec![Range::Echo(1.5); 8];
    ranges[3] = Range::NoEcho;
    ranges[6] = Range::Missing;
    let pose = Isometry2::new(Vector2::new(2.0, 1.0), std::f64::consts::FRAC_PI_2);
    let scan = Scan { pose, time: 0.0, ranges };
    if !ring.fits(&scan) {
        return Err("a scan has one reading for each sensor".into());
    }

    println!("{:>8} {:>16}  echo at", "bearing", "sensor at");
    for (beam, range) in ring.beams().iter().zip(&scan.ranges) {
        // The sensor looks along its own x axis.
        let world_from_sensor = scan.pose * beam.pose;
        let sensor = world_from_sensor.translation.vector;
        let echo = match range {
            Range::Echo(distance) => {
                let at = world_from_sensor * Point2::new(*distance, 0.0);
                format!("({:.2}, {:.2})", at.x, at.y)
            }
            Range::NoEcho => format!("nothing within {} m", beam.max_range),
            Range::Missing => "no reading".into(),
        };
        let bearing = beam.pose.rotation.angle().to_degrees();
        println!("{bearing:>7.1}° {:>8.2} {:>7.2}  {echo}", sensor.x, sensor.y);
    }
    Ok(())
}
