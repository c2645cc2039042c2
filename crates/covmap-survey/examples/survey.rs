//! Surveys a room from the scans of a laser, and prints the survey as a file holds it.
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap_sonar::{Beam, Range, Scan, SonarRing};
use covmap_survey::{SurveyParameters, survey};
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use nalgebra::{Isometry2, Vector2};
use std::f64::consts::PI;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let shape = Shape::Rectangle { center: (4.0, 3.0), size: (0.8, 0.5), angle: 0.4 };
    let scenario = Scenario {
        name: "room".into(),
        extent: Extent { width: 6.0, height: 4.0 },
        start: None,
        obstacles: vec![Obstacle { shape, surface: Surface::Rough }],
    };
    let world = World::from_scenario(&scenario, Surface::Rough)?;
    // A laser is a ring of beams without width, in order of their direction.
    let beam = |i: i32| Beam {
        pose: Isometry2::new(Vector2::zeros(), PI * f64::from(i - 180) / 360.0),
        half_angle: 0.0,
        min_range: 0.1,
        max_range: 20.0,
    };
    let ring = SonarRing::new((0..361).map(beam).collect())?;
    let scan = |i: i32| {
        let pose = Isometry2::new(Vector2::new(1.0 + 0.1 * f64::from(i), 1.5), 0.2 * f64::from(i));
        let range = |beam: &Beam| {
            let sensor = pose * beam.pose;
            let (eye, axis) = (sensor.translation.vector.into(), sensor.rotation * Vector2::x());
            world.cast_ray(eye, axis, beam.max_range).map_or(Range::NoEcho, Range::Echo)
        };
        Scan { pose, time: f64::from(i), ranges: ring.beams().iter().map(range).collect() }
    };
    let scans: Vec<Scan> = (0..40).map(scan).collect();

    let parameters = SurveyParameters::indoor();
    let found = survey(scans.iter().map(|scan| (&ring, scan)), &parameters)?;
    println!(
        "{}",
        ron::ser::to_string_pretty(&found.survey, ron::ser::PrettyConfig::new().depth_limit(2))?
    );
    for (wall, support) in found.survey.walls.iter().zip(&found.support) {
        let (views, mm) = (support.views, 1e3 * support.residual);
        println!("{:?} – {:?}: {views} views, residual {mm:.1} mm", wall.from, wall.to);
    }
    Ok(())
}
