//! The options of a reader.

use super::BagOptions;
use covmap_sonar::SonarRing;
use std::path::PathBuf;

/// The kind of sensors that are read from a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    /// Sonars: `SONAR`, or `sonar.txt`.
    Sonar,
    /// Lasers: `FLASER`, `RLASER`, `ROBOTLASER1`–`2` or `RAWLASER1`–`5`, or `laser.txt`: rings of
    /// beams without width.
    Laser,
}

/// The wanted parts of a log, and facts that the log does not state.
#[derive(Debug, Clone, PartialEq)]
pub struct LogOptions {
    /// The kind of sensors.
    pub sensor: Sensor,
    /// The sonars as configured. The log's own records take precedence: the ring serves `sonar.txt`
    /// in full, and `SONAR` only with its shortest and longest ranges.
    pub ring: SonarRing,
    /// Poses that replace the log's: a file with `t_ms x_m y_m theta_rad` in each line, in the
    /// order of time.
    pub poses: Option<PathBuf>,
    /// What is read from a bag.
    pub bag: BagOptions,
}
