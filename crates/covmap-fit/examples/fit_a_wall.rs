//! Fits two parameters to scans in front of a wall whose place is known.
#![allow(clippy::print_stdout, reason = "an example prints")]

use covmap::Grid;
use covmap_fit::{
    Axis, BodyRecord, Example, FitSettings, Parameter, SearchSettings, Weighting, fit, score,
};
use covmap_model::ModelParameters;
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2, Vector2};
use std::ops::ControlFlow;

/// The wall is solid from here on, in x [m].
const WALL: f64 = 1.53;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ring = SonarRing::b21r();
    let grid = Grid::new(Point2::new(-1.0, -1.5), 0.1, 30, 30)?;
    // Only a sensor that looks at the wall within 30° hears it, 1 cm too near or too far.
    let scan = |i: i32| {
        let pose = Isometry2::new(Vector2::new(0.1 * f64::from(i % 5), 0.0), 0.05 * f64::from(i));
        let error = if i % 2 == 0 { 0.01 } else { -0.01 };
        let range = |beam: &covmap_sonar::Beam| {
            let sensor = pose * beam.pose;
            let along = sensor.rotation.cos_angle();
            if along > 0.86 {
                Range::Echo((WALL - sensor.translation.x) / along + error)
            } else {
                Range::NoEcho
            }
        };
        Scan { pose, time: f64::from(i), ranges: ring.beams().iter().map(range).collect() }
    };
    let scans: Vec<Scan> = (0..20).map(scan).collect();
    let near = |cell| {
        let at = grid.center(cell);
        (0.5..1.9).contains(&at.x) && at.y.abs() < 0.5
    };
    let covered = |cell| ((grid.center(cell).x + 0.05 - WALL) / 0.1).clamp(0.0, 1.0);
    let truth = grid.cells().filter(|cell| near(*cell)).map(|cell| (cell, covered(cell))).collect();
    let body = BodyRecord::default();
    let examples = [Example { name: "wall".into(), ring, scans, body, grid, truth }];

    let begin = ModelParameters::by_hand();
    let settings = FitSettings {
        weighting: Weighting::Cells,
        axes: vec![
            Axis { parameter: Parameter::SigmaIn, from: 0.15, to: 0.5 },
            Axis { parameter: Parameter::Tempering, from: 0.1, to: 1.0 },
        ],
        starts: 1,
        search: SearchSettings::default(),
    };
    // One start needs no random numbers, and nothing ends the search early.
    let fitted = fit(&examples, &begin, &settings, || 0.5, |_| ControlFlow::Continue(()))?;
    let likelihood = |p| score(&examples, p).map(|score| score.all.log_likelihood);
    println!("before: {:.3} nats a cell", likelihood(&begin)?);
    println!("after:  {:.3} nats a cell", likelihood(&fitted.parameters)?);
    for axis in &settings.axes {
        let value = axis.parameter.get(&fitted.parameters).unwrap_or(f64::NAN);
        println!("{:?} = {value:.3}", axis.parameter);
    }
    println!("{} maps", fitted.path.len());
    Ok(())
}
