//! Writing a CARMEN log.

use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::Isometry2;
use std::io::{self, Write};

/// The parameters with which our logs state ranges that the format has no place for \[m\].
pub(super) const MIN_RANGE: &str = "covmap_sonar_min_range";
pub(super) const MAX_RANGE: &str = "covmap_sonar_max_range";

/// Why a scan cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CarmenWriterError {
    /// The operating system refused.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// A CARMEN log has one cone and one pair of ranges for all sensors.
    #[error(
        "sensor {0} has another cone or other ranges than sensor 0, which a CARMEN log cannot express"
    )]
    Unequal(usize),
    /// The scan comes from another ring.
    #[error("scan {scan} has {ranges} ranges, but the ring has {sensors} sensors")]
    Count {
        /// The scan, counted from 0.
        scan: usize,
        /// The number of readings in the scan.
        ranges: usize,
        /// The number of sensors in the ring.
        sensors: usize,
    },
    /// A pose or a time that is not finite, or a time before the last one.
    #[error("scan {0}: pose and time must be finite, and time must not run backwards")]
    PoseOrTime(usize),
    /// An echo that a reader would take for none, or for missing.
    #[error("scan {scan}: an echo at {range} m is out of the sensor's range, {min} to {max} m")]
    Echo {
        /// The scan, counted from 0.
        scan: usize,
        /// The range \[m\].
        range: f64,
        /// The shortest range \[m\].
        min: f64,
        /// The longest range, from which a reading means no echo \[m\].
        max: f64,
    },
}

/// Writes scans of a ring as a CARMEN text log.
///
/// Each scan becomes a line `ODOM` and a line `SONAR` of the same time.
///
/// A [`LogReader`](super::LogReader) reads the same scans from it: ranges, times and positions to
/// the last bit, headings up to rounding (10⁻¹⁵ rad). `NoEcho` is written as the longest range,
/// `Missing` as 0. The format has no place for the shortest and longest ranges; they are in `PARAM
/// covmap_sonar_min_range` and `PARAM covmap_sonar_max_range` \[m\].
#[derive(Debug)]
pub struct CarmenWriter<'a, W: Write> {
    ring: &'a SonarRing,
    out: W,
    scans: usize,
    last: f64,
}

impl<'a, W: Write> CarmenWriter<'a, W> {
    /// Begins a log.
    ///
    /// # Errors
    /// If the sensors have different cones or ranges, or the log cannot be written.
    #[allow(clippy::float_cmp, reason = "equal means equal")]
    pub fn new(ring: &'a SonarRing, mut out: W) -> Result<Self, CarmenWriterError> {
        let shape = |i: usize| {
            let beam = &ring.beams()[i];
            (beam.half_angle, beam.min_range, beam.max_range)
        };
        if let Some(i) = (0..ring.beams().len()).find(|i| shape(*i) != shape(0)) {
            return Err(CarmenWriterError::Unequal(i));
        }
        let (_, min_range, max_range) = shape(0);
        writeln!(out, "# CARMEN text log, by covmap; metres, radians, seconds")?;
        writeln!(out, "# SONAR: at or above {MAX_RANGE} is no echo, 0 is no reading")?;
        writeln!(out, "PARAM {MIN_RANGE} {min_range:?} 0.0 covmap 0.0")?;
        writeln!(out, "PARAM {MAX_RANGE} {max_range:?} 0.0 covmap 0.0")?;
        Ok(Self { ring, out, scans: 0, last: f64::NEG_INFINITY })
    }

    /// Writes the robot's pose at a time between two scans, which keeps its way known.
    ///
    /// # Errors
    /// If pose or time is not finite, the time runs backwards, or the log cannot be written.
    pub fn pass(&mut self, time: f64, pose: &Isometry2<f64>) -> Result<(), CarmenWriterError> {
        let (x, y, theta) = (pose.translation.x, pose.translation.y, pose.rotation.angle());
        let finite = [x, y, theta, time].iter().all(|value| value.is_finite());
        if !finite || time < self.last {
            return Err(CarmenWriterError::PoseOrTime(self.scans));
        }
        writeln!(self.out, "ODOM {x:?} {y:?} {theta:?} 0.0 0.0 0.0 {time:?} covmap {time:?}")?;
        self.last = time;
        Ok(())
    }

    /// Writes a scan.
    ///
    /// # Errors
    /// If the scan does not fit the ring or the scans before it, or cannot be written.
    pub fn write(&mut self, scan: &Scan) -> Result<(), CarmenWriterError> {
        let number = self.scans;
        let Scan { pose, time, ranges } = scan;
        let beams = self.ring.beams();
        if !self.ring.fits(scan) {
            let (ranges, sensors) = (ranges.len(), beams.len());
            return Err(CarmenWriterError::Count { scan: number, ranges, sensors });
        }
        let (min, max) = (beams[0].min_range, beams[0].max_range);
        let value = |range: &Range| match *range {
            Range::Echo(d) if d > 0.0 && d >= min && d < max => Ok(d),
            Range::Echo(range) => Err(CarmenWriterError::Echo { scan: number, range, min, max }),
            Range::NoEcho => Ok(max),
            Range::Missing => Ok(0.0),
        };
        let values = ranges.iter().map(value).collect::<Result<Vec<f64>, _>>()?;
        self.pass(*time, pose)?;
        let (out, places) = (&mut self.out, decimals(max));
        write!(out, "SONAR {:?} {}", 2.0 * beams[0].half_angle, beams.len())?;
        for value in values {
            // With fewer decimals than the longest range, an echo could be the longest range, cut.
            match decimals(value) < places {
                true => write!(out, " {value:.places$}")?,
                false => write!(out, " {value:?}")?,
            }
        }
        for beam in beams {
            let (place, angle) = (beam.pose.translation.vector, beam.pose.rotation.angle());
            write!(out, " {:?} {:?} {angle:?}", place.x, place.y)?;
        }
        writeln!(out, " {time:?} covmap {time:?}")?;
        self.scans = number + 1;
        Ok(())
    }

    /// Flushes the log, and returns the number of scans.
    ///
    /// # Errors
    /// If the log cannot be written.
    pub fn finish(mut self) -> Result<usize, CarmenWriterError> {
        self.out.flush()?;
        Ok(self.scans)
    }
}

/// Returns the number of decimals with which a number is written.
fn decimals(value: f64) -> usize {
    format!("{value:?}").split_once('.').map_or(0, |(_, decimals)| decimals.len())
}
