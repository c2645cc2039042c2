//! What a ring measures.

use nalgebra::Isometry2;
use serde::{Deserialize, Serialize};

/// The reading of one sensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Range {
    /// Something answered at this distance from the sensor \[m\].
    Echo(f64),
    /// The sensor listened to its end and nothing answered.
    NoEcho,
    /// There is no reading: blanked, dropped, or nearer than the sensor can measure.
    Missing,
}

/// The readings of all sensors of a ring at one pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scan {
    /// Where the robot stood: `world_from_robot` \[m, rad\].
    pub pose: Isometry2<f64>,
    /// When \[s\].
    pub time: f64,
    /// One reading for each beam of the ring, in its order.
    pub ranges: Vec<Range>,
}
