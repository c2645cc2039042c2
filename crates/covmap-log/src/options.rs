//! What is read of a log.

use covmap_sonar::SonarRing;
use std::path::PathBuf;

/// Which sensors of a log are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    /// `SONAR`, or `sonar.txt`.
    Sonar,
    /// `FLASER`, `RLASER`, `ROBOTLASER1`–`2` or `RAWLASER1`–`5`, or `laser.txt`: rings of beams
    /// without width.
    Laser,
}

/// What is read of a log, and what it does not say itself.
#[derive(Debug, Clone, PartialEq)]
pub struct LogOptions {
    /// Which sensors.
    pub sensor: Sensor,
    /// The sonars as they are configured. What the log records goes before; so this is the
    /// ring of `sonar.txt`, and of `SONAR` the shortest and longest ranges alone.
    pub ring: SonarRing,
    /// Poses to be used instead of the log's: a file with `t_ms x_m y_m theta_rad` in each
    /// line, in the order of time.
    pub poses: Option<PathBuf>,
}
