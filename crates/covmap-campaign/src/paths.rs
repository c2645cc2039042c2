//! Where a run led, and what was explored along the way.

use covmap_lab::corners;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

/// The paths of a run, in metres, to the millimetre.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paths {
    /// The corners of the driven path.
    pub driven: Vec<(f64, f64)>,
    /// Where it was measured.
    pub scans: Vec<(f64, f64)>,
    /// Length of the path so far, and the share of the observable cells that are known with
    /// an entropy of at most ε; some hundred points.
    pub explored: Vec<(f64, f64)>,
}

/// The corners of a driven path.
pub fn driven(trajectory: &[Point2<f64>]) -> Vec<(f64, f64)> {
    corners(trajectory).into_iter().map(millimetres).collect()
}

/// A point, to the millimetre.
pub(crate) fn millimetres(point: Point2<f64>) -> (f64, f64) {
    (rounded(point.x, 1e3), rounded(point.y, 1e3))
}

/// A number, rounded to this many parts of one.
pub(crate) fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}
