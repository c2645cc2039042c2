//! The sensor of a log: that of its first frame.

use super::fields::Written;
use super::lines::Lines;
use super::skipped::Damage;
use super::track::Stamp;
use super::{Account, Passed, SkipReason};
use covmap_sonar::{Beam, Range, SonarRing};
use nalgebra::{Isometry2, Vector2};
use std::path::Path;
use std::sync::Arc;

/// The largest number of changes of a sensor's shortest and longest ranges in a log.
const MOST_LIMITS: usize = 8;

/// A frame before its pose is known.
pub(super) struct Measured {
    pub(super) line: usize,
    pub(super) stamp: Stamp,
    /// The sensor's number in the account.
    pub(super) sensor: usize,
    pub(super) ring: Arc<SonarRing>,
    pub(super) ranges: Vec<Range>,
    /// The sensors whose reading is not a possible range.
    pub(super) unusable: Vec<usize>,
    /// Whether the frame has the time of the frame before it.
    pub(super) tied: bool,
    /// The robot's pose, if known.
    pub(super) pose: Option<Isometry2<f64>>,
    /// The way of the odometry from the frame before.
    pub(super) way: Vec<Passed>,
}

impl Measured {
    /// Returns the frame in the present line of a log, without a pose.
    pub(super) fn new(
        lines: &Lines,
        stamp: Stamp,
        (sensor, ring): (usize, Arc<SonarRing>),
        values: &[Written],
        account: &mut Account,
    ) -> Result<Self, Damage> {
        let line = lines.line();
        let unusable = |(i, range): (usize, &Written)| {
            (range.value.is_nan() || range.value < 0.0).then_some(i)
        };
        let unusable: Vec<usize> = values.iter().enumerate().filter_map(unusable).collect();
        let ranges = readings(values, &ring)?;
        account.skipped.add_readings(lines.path(), line, unusable.len());
        let (tied, pose, way) = (false, None, Vec::new());
        Ok(Self { line, stamp, sensor, ring, ranges, unusable, tied, pose, way })
    }

    /// Counts the frame as skipped.
    pub(super) fn skip(&self, path: &Path, damage: Damage, account: &mut Account) {
        account.sensors[self.sensor].count_skipped(self.ranges.len());
        account.skipped.add(path, self.line, damage);
    }
}

/// The ring that all frames of a sensor share; `I` is the description of the sensor in a line.
pub(super) struct Device<I> {
    first: Option<(I, usize)>,
    /// One ring for each pair of shortest and longest ranges \[m\].
    rings: Vec<((f64, f64), Arc<SonarRing>)>,
}

impl<I: PartialEq> Device<I> {
    pub(super) fn new() -> Self {
        Self { first: None, rings: Vec::new() }
    }

    /// Returns the sensor's number in the account, and its ring.
    ///
    /// The first frame makes the ring; the other frames must come from the same sensor. The account
    /// records the sources that `beams` reports.
    #[allow(clippy::float_cmp, reason = "the same numbers of the same lines")]
    pub(super) fn ring(
        &mut self,
        identity: I,
        limits: (f64, f64),
        (account, lines): (&mut Account, &'static str),
        beams: impl FnOnce(&I, &mut super::SensorAccount) -> Result<Vec<Beam>, Damage>,
    ) -> Result<(usize, Arc<SonarRing>), Damage> {
        let differs =
            |what: &str| Damage::new(SkipReason::Geometry, format!("{what} of the first frame"));
        if self.first.as_ref().is_some_and(|(first, _)| *first != identity) {
            return Err(differs("places, angles or number of sensors differ from those"));
        }
        if let Some((_, ring)) = self.rings.iter().find(|(known, _)| *known == limits) {
            let sensor = self.first.as_ref().map_or(0, |(_, sensor)| *sensor);
            return Ok((sensor, Arc::clone(ring)));
        }
        if self.rings.len() == MOST_LIMITS {
            return Err(differs("shortest and longest ranges changed too often, away from those"));
        }
        let mut told = super::SensorAccount::new(lines);
        let ring = SonarRing::new(beams(&identity, &mut told)?)
            .map_err(|error| Damage::new(SkipReason::Unreadable, format!("geometry: {error}")))?;
        let sensor = match &self.first {
            Some((_, sensor)) => *sensor,
            None => account.add_sensor(lines),
        };
        told.taken.into_iter().for_each(|t| account.sensors[sensor].take(t.what, t.source));
        let ring = Arc::new(ring);
        self.rings.push((limits, Arc::clone(&ring)));
        self.first.get_or_insert((identity, sensor));
        Ok((sensor, ring))
    }
}

/// Returns `count` beams of a laser at `mount` in the frame of the robot.
///
/// The beams start at the angle `start`, counter-clockwise in steps \[rad\], and have a shortest
/// and a longest range \[m\].
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
    // A larger ring is refused anyway.
    (0..u32::try_from(count).unwrap_or(u32::MAX).min(1 << 16)).map(beam).collect()
}

/// Returns numbers as readings of a ring.
///
/// A number from the longest range on is no echo. A number below the shortest range, zero, a
/// negative one and NaN are missing. The longest range may be rounded to, or cut at, the decimal
/// places of the readings.
fn readings(values: &[Written], ring: &SonarRing) -> Result<Vec<Range>, Damage> {
    if values.len() != ring.beams().len() {
        let fault =
            format!("ranges: there are {}, but the ring has {}", values.len(), ring.beams().len());
        return Err(Damage::new(SkipReason::Count, fault));
    }
    let reading = |(range, beam): (&Written, &Beam)| match range.value {
        _ if is_longest(range, beam.max_range) => Range::NoEcho,
        v if v > 0.0 && v >= beam.min_range => Range::Echo(v),
        _ => Range::Missing,
    };
    Ok(values.iter().zip(ring.beams()).map(reading).collect())
}

/// The coarsest decimal place with which a range may be written \[m\].
const COARSEST_PLACE: f64 = 0.1;

/// Returns whether a range, as written, may be the longest, or is longer.
fn is_longest(range: &Written, max_range: f64) -> bool {
    let place = range.place.min(COARSEST_PLACE);
    range.value >= max_range || range.value - max_range + place > 1e-9
}

/// Returns a number with the digits that the account shows, and no −0.
pub(super) fn short(value: f64) -> f64 {
    (value * 1e4).round() / 1e4 + 0.0
}

#[cfg(test)]
mod tests {
    use super::super::fields::Fields;
    use super::*;

    /// Checks the reading of a written number, for the longest range `max_range` \[m\].
    #[track_caller]
    fn check(word: &str, max_range: f64, expected: Range) {
        let beam = Beam { pose: Isometry2::identity(), half_angle: 0.1, min_range: 0.2, max_range };
        let ring = SonarRing::new(vec![beam]).unwrap();
        let written = Fields::new(word).ranges(1, 1.0).unwrap();
        assert_eq!(readings(&written, &ring).unwrap(), [expected], "{word} of {max_range}");
    }

    #[test]
    fn the_longest_range_is_no_echo_with_as_few_decimals_as_it_is_written() {
        for written in ["2", "2.0", "2.00", "2.000", "2.0000001", "9.9", "inf"] {
            check(written, 2.0, Range::NoEcho);
        }
        // These are rounded, or cut.
        check("5.3", 5.3333, Range::NoEcho);
        check("5.33", 5.3333, Range::NoEcho);
        check("5.333", 5.3333, Range::NoEcho);
        check("5.66", 5.6666, Range::NoEcho);
        check("5.67", 5.6666, Range::NoEcho);
        check("5", 5.04, Range::NoEcho);
    }

    #[test]
    fn one_less_in_the_last_decimal_is_an_echo() {
        check("1.9", 2.0, Range::Echo(1.9));
        check("1.99", 2.0, Range::Echo(1.99));
        check("1.999", 2.0, Range::Echo(1.999));
        check("1.9999999999999998", 2.0, Range::Echo(1.999_999_999_999_999_8));
        check("5.31", 5.3333, Range::Echo(5.31));
        check("1.99e0", 2.0, Range::Echo(1.99));
        check("0.1", 2.0, Range::Missing);
        check("nan", 2.0, Range::Missing);
    }
}
