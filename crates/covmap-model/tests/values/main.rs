//! Values worked out by hand, or by a few lines of Python, with their derivation: the fast and the
//! literal formulas share code, and would be wrong alike.
#![allow(clippy::unwrap_used, reason = "tests")]

mod baselines;
mod cause;
mod equations;
mod footprints;

use covmap::{Cell, Grid};
use covmap_model::{
    FootprintRule, Linear, ModelParameters, NoEchoParameters, ProductParameters, SensorModel,
    Update,
};
use covmap_sonar::{Beam, Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};

#[track_caller]
fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} is not {expected}");
}

#[track_caller]
fn all_close(actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len());
    actual.iter().zip(expected).for_each(|(a, e)| close(*a, *e, tolerance));
}

/// Three bins, cells of 1 m, and slopes that all differ:
///
/// ```text
/// σ(d^l, d) = .25 + .01 d^l + .03 d outside, .6 inside    γ(d^l, d) = .1 + .05 d^l + .02 d
/// ```
fn parameters() -> ModelParameters {
    ModelParameters {
        bins: 3,
        usable_range: 5.0,
        footprint: FootprintRule::Cones { half_angle: 0.0 },
        update: Update::Product(ProductParameters {
            sigma_out: Linear { base: 0.25, per_cell_distance: 0.01, per_range: 0.03 },
            sigma_in: 0.6,
            gamma: Linear { base: 0.1, per_cell_distance: 0.05, per_range: 0.02 },
            behind: 2.0,
            no_echo: NoEchoParameters { range: 3.0, gamma: 2.0 },
            tempering: 1.0,
        }),
    }
}

/// A sensor by its place [m] and direction [degrees].
fn beam(x: f64, y: f64, degrees: f64) -> Beam {
    let pose = Isometry2::new([x, y].into(), degrees.to_radians());
    Beam { pose, half_angle: 0.1, min_range: 0.0, max_range: 10.0 }
}

/// A single ray from the robot's centre straight ahead.
fn model(parameters: &ModelParameters) -> SensorModel {
    let ring = SonarRing::new(vec![beam(0.0, 0.0, 0.0)]).unwrap();
    SensorModel::new(parameters, &ring, 1.0).unwrap()
}

/// 21 × 21 cells of 1 m: the point (0, 0) is the centre of cell (10, 10).
fn grid() -> Grid {
    Grid::new(Point2::new(-10.5, -10.5), 1.0, 21, 21).unwrap()
}

/// The cell whose centre is at (x, y).
fn at(x: i32, y: i32) -> Cell {
    Cell::new(10 + x, 10 + y)
}

fn scan(range: Range) -> Scan {
    Scan { pose: Isometry2::identity(), time: 0.0, ranges: vec![range] }
}
