//! Readings and scans of a ring.

use nalgebra::Isometry2;
use serde::{Deserialize, Serialize};

/// The reading of one sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Range {
    /// An echo from this distance to the sensor \[m\].
    Echo(f64),
    /// The sensor listened up to its longest range and heard no echo.
    NoEcho,
    /// No reading: blanked, dropped, or nearer than the sensor can measure.
    Missing,
}

/// The readings of all sensors of a ring at one pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scan {
    /// Pose of the robot: `world_from_robot` \[m, rad\].
    pub pose: Isometry2<f64>,
    /// Time of the scan \[s\].
    pub time: f64,
    /// One reading for each beam of the ring, in its order.
    pub ranges: Vec<Range>,
}
