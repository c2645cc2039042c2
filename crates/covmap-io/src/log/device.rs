//! The sensor that a log comes from: the one of its first frame.

use super::lines::Lines;
use super::skipped::Damage;
use super::{SkipReason, Skipped};
use covmap_sonar::{Beam, Range, SonarRing};
use nalgebra::{Isometry2, Vector2};
use std::path::Path;
use std::sync::Arc;

/// A frame before its pose is known.
pub(super) struct Measured {
    pub(super) line: usize,
    /// When \[s\].
    pub(super) time: f64,
    pub(super) ring: Arc<SonarRing>,
    pub(super) ranges: Vec<Range>,
    /// Where the robot was, if the frame says so.
    pub(super) pose: Option<Isometry2<f64>>,
}

impl Measured {
    /// The frame in the present line of a log, without a pose, from its readings \[m\].
    pub(super) fn new(
        lines: &Lines,
        time: f64,
        ring: Arc<SonarRing>,
        values: &[f64],
        skipped: &mut Skipped,
    ) -> Result<Self, Damage> {
        let line = lines.line();
        let ranges = readings(values, &ring, skipped, (lines.path(), line))?;
        Ok(Self { line, time, ring, ranges, pose: None })
    }
}

/// The ring that all frames of a log share. `I` is what a line says of its sensor.
pub(super) struct Device<I> {
    first: Option<(I, Arc<SonarRing>)>,
}

impl<I: PartialEq> Device<I> {
    pub(super) fn new() -> Self {
        Self { first: None }
    }

    /// The ring, made by the first frame; the others must come from the same sensor.
    pub(super) fn ring(
        &mut self,
        identity: I,
        beams: impl FnOnce(&I) -> Vec<Beam>,
    ) -> Result<Arc<SonarRing>, Damage> {
        match &self.first {
            Some((first, ring)) if *first == identity => Ok(Arc::clone(ring)),
            Some(_) => Err(Damage::new(
                SkipReason::Geometry,
                "places, angles or number of sensors differ from those of the first frame",
            )),
            None => {
                let ring = SonarRing::new(beams(&identity)).map_err(|error| {
                    Damage::new(SkipReason::Unreadable, format!("geometry: {error}"))
                })?;
                let ring = Arc::new(ring);
                self.first = Some((identity, Arc::clone(&ring)));
                Ok(ring)
            }
        }
    }
}

/// What frames are passed on in: never back in time.
#[derive(Default)]
pub(super) struct Clock {
    last: Option<f64>,
}

impl Clock {
    pub(super) fn check(&mut self, time: f64) -> Result<(), Damage> {
        if let Some(last) = self.last.filter(|last| time < *last) {
            return Err(super::poses::backwards(time, last));
        }
        self.last = Some(time);
        Ok(())
    }
}

/// `count` beams of a laser at `mount` in the frame of the robot, from the angle `start`
/// counter-clockwise in steps \[rad\], with their shortest and longest range \[m\].
pub(super) fn laser_beams(
    mount: &Isometry2<f64>,
    count: usize,
    (start, step): (f64, f64),
    (min_range, max_range): (f64, f64),
) -> Vec<Beam> {
    let beam = |i: u32| Beam {
        pose: mount * Isometry2::new(Vector2::zeros(), start + step * f64::from(i)),
        half_angle: 0.0,
        min_range,
        max_range,
    };
    // A ring of more is refused anyhow.
    (0..u32::try_from(count).unwrap_or(u32::MAX).min(1 << 16)).map(beam).collect()
}

/// What numbers \[m\] mean as readings of a ring.
///
/// From the longest range on there is no echo; below the shortest, and at zero, the reading is
/// missing; so it is if it is NaN or negative, and that is counted.
fn readings(
    values: &[f64],
    ring: &SonarRing,
    skipped: &mut Skipped,
    (path, line): (&Path, usize),
) -> Result<Vec<Range>, Damage> {
    if values.len() != ring.beams().len() {
        let fault =
            format!("ranges: there are {}, but the ring has {}", values.len(), ring.beams().len());
        return Err(Damage::new(SkipReason::Count, fault));
    }
    let bad = values.iter().filter(|value| value.is_nan() || **value < 0.0).count();
    skipped.add_readings(path, line, bad);
    let reading = |(value, beam): (&f64, &Beam)| match *value {
        v if v >= beam.max_range => Range::NoEcho,
        v if v > 0.0 && v >= beam.min_range => Range::Echo(v),
        _ => Range::Missing,
    };
    Ok(values.iter().zip(ring.beams()).map(reading).collect())
}
