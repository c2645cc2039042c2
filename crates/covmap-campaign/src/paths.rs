//! The paths of a run, and the explored share along the way.

use covmap_lab::corners;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

/// The paths of a run, in metres, to the millimetre.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Paths {
    /// The corners of the driven path.
    pub driven: Vec<(f64, f64)>,
    /// The places of the scans.
    pub scans: Vec<(f64, f64)>,
    /// Some hundred points of the length of the path so far and the share of the observable cells that are
    /// known with an entropy of at most ε.
    pub explored: Vec<(f64, f64)>,
}

/// Returns the corners of a driven path.
pub fn driven(trajectory: &[Point2<f64>]) -> Vec<(f64, f64)> {
    corners(trajectory).into_iter().map(millimetres).collect()
}

/// A point, to the millimetre.
pub(crate) fn millimetres(point: Point2<f64>) -> (f64, f64) {
    (rounded(point.x, 1e3), rounded(point.y, 1e3))
}

/// A number, rounded to a multiple of 1 / `parts`.
pub(crate) fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}
