//! The arrangement of sensors on a robot.

use crate::Scan;
use nalgebra::{Isometry2, Vector2};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// The largest number of sensors on a ring.
const MAX_SENSORS: usize = 4096;
/// Largest distance of a sensor from the robot's centre, and largest range \[m\].
const MAX_LENGTH: f64 = 1000.0;

/// One range sensor: its place, its cone and its ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beam {
    /// `robot_from_sensor`: the sensor looks along its own x axis \[m, rad\].
    pub pose: Isometry2<f64>,
    /// Half of the opening angle of the cone \[rad\]; 0 for a line.
    pub half_angle: f64,
    /// Shortest range that the sensor can measure \[m\].
    pub min_range: f64,
    /// Longest range that the sensor can measure \[m\].
    pub max_range: f64,
}

/// Reason why a ring cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RingError {
    /// The number of sensors is out of range.
    #[error("{0} sensors: a ring has 1 to {MAX_SENSORS}")]
    Count(usize),
    /// A sensor has an impossible place or cone.
    #[error(
        "sensor {0}: position and angle must be finite, the position within {MAX_LENGTH} m, and half_angle in [0, π/2]"
    )]
    Geometry(usize),
    /// A sensor has impossible ranges.
    #[error(
        "sensor {0}: ranges must satisfy 0 ≤ min_range {1:?} < max_range {2:?} ≤ {MAX_LENGTH} m"
    )]
    Ranges(usize, f64, f64),
}

/// A sensor as it is written in a file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorSpecification {
    /// Position in front of the robot's centre \[m\].
    pub x: f64,
    /// Position to the left of the robot's centre \[m\].
    pub y: f64,
    /// Direction of the axis from the robot's heading \[rad\].
    pub angle: f64,
    /// Half of the cone's opening angle \[rad\].
    pub half_angle: f64,
    /// Shortest range \[m\].
    pub min_range: f64,
    /// Longest range \[m\].
    pub max_range: f64,
}

/// A ring as it is written in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum RingSpecification {
    /// The 24 sonars of a B21r's enclosure ring, [`SonarRing::b21r`].
    B21r,
    /// Equal sensors, evenly spaced on a circle round the robot's centre and looking outwards. The
    /// first is half a step left of the heading; the others follow counter-clockwise.
    Circle {
        /// Number of sensors.
        count: usize,
        /// Radius of the circle \[m\].
        radius: f64,
        /// Half of the cone's opening angle \[rad\].
        half_angle: f64,
        /// Shortest range \[m\].
        min_range: f64,
        /// Longest range \[m\].
        max_range: f64,
    },
    /// Any sensors.
    Sensors(Vec<SensorSpecification>),
}

/// Any number of range sensors on a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct SonarRing {
    beams: Vec<Beam>,
}

impl SonarRing {
    /// Creates a ring of given beams.
    ///
    /// # Errors
    /// If there are no beams or too many, or a beam has impossible numbers.
    pub fn new(beams: Vec<Beam>) -> Result<Self, RingError> {
        if !(1..=MAX_SENSORS).contains(&beams.len()) {
            return Err(RingError::Count(beams.len()));
        }
        for (i, beam) in beams.iter().enumerate() {
            let place = beam.pose.translation.vector;
            let placed = place.iter().all(|v| v.is_finite() && v.abs() <= MAX_LENGTH)
                && beam.pose.rotation.angle().is_finite();
            if !(placed && (0.0..=PI / 2.0).contains(&beam.half_angle)) {
                return Err(RingError::Geometry(i));
            }
            let (min, max) = (beam.min_range, beam.max_range);
            if !(0.0 <= min && min < max && max <= MAX_LENGTH) {
                return Err(RingError::Ranges(i, min, max));
            }
        }
        Ok(Self { beams })
    }

    /// Returns the ring that a file describes.
    ///
    /// # Errors
    /// As [`SonarRing::new`].
    pub fn from_specification(specification: &RingSpecification) -> Result<Self, RingError> {
        let sensors = match specification {
            RingSpecification::B21r => return Ok(Self::b21r()),
            RingSpecification::Sensors(sensors) => sensors.clone(),
            &RingSpecification::Circle { count, radius, half_angle, min_range, max_range } => {
                if !(1..=MAX_SENSORS).contains(&count) {
                    return Err(RingError::Count(count));
                }
                let sensor = |i: usize| {
                    let angle = TAU * (i as f64 + 0.5) / count as f64;
                    let (sin, cos) = libm::sincos(angle);
                    let (x, y) = (radius * cos, radius * sin);
                    SensorSpecification { x, y, angle, half_angle, min_range, max_range }
                };
                (0..count).map(sensor).collect()
            }
        };
        let beam = |s: &SensorSpecification| Beam {
            pose: Isometry2::new(Vector2::new(s.x, s.y), s.angle),
            half_angle: s.half_angle,
            min_range: s.min_range,
            max_range: s.max_range,
        };
        Self::new(sensors.iter().map(beam).collect())
    }

    /// Returns the enclosure ring of a B21r: 24 Polaroid 6500 sonars at radius .250 m, axes at
    /// ±7.5°, ±22.5°, …, none straight ahead (Player's `b21r_rflex_lms200.cfg`), cones of
    /// half-angle 12.5°, ranges .26–10.7 m.
    pub fn b21r() -> Self {
        Self::from_specification(&RingSpecification::Circle {
            count: 24,
            radius: 0.25,
            half_angle: 12.5 * PI / 180.0,
            min_range: 0.26,
            max_range: 10.7,
        })
        .unwrap_or_else(|e| unreachable!("the preset is valid: {e}"))
    }

    /// Returns the sensors, in the order of a scan's ranges.
    pub fn beams(&self) -> &[Beam] {
        &self.beams
    }

    /// Returns whether a scan has one reading for each sensor.
    pub fn fits(&self, scan: &Scan) -> bool {
        scan.ranges.len() == self.beams.len()
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;

    #[test]
    fn the_b21r_looks_nowhere_straight_ahead() {
        let ring = SonarRing::b21r();
        let degrees: Vec<f64> =
            ring.beams().iter().map(|b| b.pose.rotation.angle().to_degrees()).collect();
        assert!((degrees[0] - 7.5).abs() < 1e-9 && (degrees[23] + 7.5).abs() < 1e-9);
        assert!(ring.beams().iter().all(|b| {
            let radius = b.pose.translation.vector.norm();
            (radius - 0.25).abs() < 1e-12
                && (libm::atan2(b.pose.translation.y, b.pose.translation.x)
                    - b.pose.rotation.angle())
                .abs()
                    < 1e-9
        }));
    }

    #[test]
    fn an_impossible_ring_is_refused() {
        let good = SonarRing::b21r().beams()[0];
        let refuse = |beam: Beam| SonarRing::new(vec![good, beam]).unwrap_err();
        assert_eq!(SonarRing::new(vec![]), Err(RingError::Count(0)));
        assert_eq!(refuse(Beam { half_angle: f64::NAN, ..good }), RingError::Geometry(1));
        assert_eq!(refuse(Beam { max_range: 0.1, ..good }), RingError::Ranges(1, 0.26, 0.1));
        let far = Isometry2::new(Vector2::new(f64::INFINITY, 0.0), 0.0);
        assert_eq!(refuse(Beam { pose: far, ..good }), RingError::Geometry(1));
    }
}
