//! The account of a log: its contents, and the sources of every number.

use super::Skipped;
use super::skipped::plural;
use covmap_sonar::Range;
use serde::Serialize;

/// The account of a log, from the frames read so far.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Account {
    /// The frames that were passed over.
    pub skipped: Skipped,
    /// Each sensor that has frames: one ring of sonars, or one or more lasers.
    pub sensors: Vec<SensorAccount>,
    /// The source of the poses.
    pub poses: String,
    /// The number of frames that the order of lines and the logger's time placed, because their own
    /// time is too coarse or of another clock than the odometry's.
    pub placed_by_order: usize,
    /// The number of times that the clock starts anew.
    pub restarts: usize,
    /// The lines of other sensors and poses that were not used: tag and number.
    pub left_out: Vec<(&'static str, usize)>,
    /// What else a user should know, each as a sentence.
    pub notes: Vec<String>,
}

/// The account of one sensor of a log: a ring of sonars, or a laser.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorAccount {
    /// The source of the readings: the tag of their lines, or the name of a file.
    pub lines: &'static str,
    /// The geometry and the ranges, and the source of each.
    pub taken: Vec<Taken>,
    /// The readings of each sonar, or of each beam.
    pub readings: Vec<Readings>,
    /// The shortest echo \[m\].
    pub shortest_echo: f64,
    /// The longest echo \[m\].
    pub longest_echo: f64,
    /// The number of echoes of this longest range.
    pub longest_echoes: usize,
}

/// A number that a map depends on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// The name of the number, with its value.
    pub what: String,
    /// The source of the number.
    pub source: String,
}

/// The numbers of readings of each kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Readings {
    /// Echoes.
    pub echoes: usize,
    /// Readings without an echo.
    pub no_echoes: usize,
    /// Missing readings: 0, or below the shortest range.
    pub missing: usize,
    /// Readings that are NaN or negative, or whose frame was skipped.
    pub skipped: usize,
}

impl Readings {
    /// Returns the number of all readings.
    pub fn total(&self) -> usize {
        self.echoes + self.no_echoes + self.missing + self.skipped
    }
}

impl SensorAccount {
    pub(super) fn new(lines: &'static str) -> Self {
        Self {
            lines,
            taken: Vec::new(),
            readings: Vec::new(),
            shortest_echo: f64::INFINITY,
            longest_echo: 0.0,
            longest_echoes: 0,
        }
    }

    /// Returns the readings of all sonars or beams.
    pub fn total(&self) -> Readings {
        self.readings.iter().fold(Readings::default(), |sum, one| Readings {
            echoes: sum.echoes + one.echoes,
            no_echoes: sum.no_echoes + one.no_echoes,
            missing: sum.missing + one.missing,
            skipped: sum.skipped + one.skipped,
        })
    }

    pub(super) fn take(&mut self, what: String, source: impl Into<String>) {
        let taken = Taken { what, source: source.into() };
        if !self.taken.contains(&taken) {
            self.taken.push(taken);
        }
    }

    /// Counts a frame that is used; the readings of `unusable` sensors are not possible ranges.
    #[allow(clippy::float_cmp, reason = "the same digits")]
    pub(super) fn count(&mut self, ranges: &[Range], unusable: &[usize]) {
        self.make_room(ranges.len());
        for (range, readings) in ranges.iter().zip(&mut self.readings) {
            match *range {
                Range::Echo(range) => {
                    readings.echoes += 1;
                    self.shortest_echo = self.shortest_echo.min(range);
                    if range > self.longest_echo {
                        (self.longest_echo, self.longest_echoes) = (range, 0);
                    }
                    self.longest_echoes += usize::from(range == self.longest_echo);
                }
                Range::NoEcho => readings.no_echoes += 1,
                Range::Missing => readings.missing += 1,
            }
        }
        for sensor in unusable {
            self.readings[*sensor].missing -= 1;
            self.readings[*sensor].skipped += 1;
        }
    }

    /// Counts a frame that is skipped.
    pub(super) fn count_skipped(&mut self, sensors: usize) {
        self.make_room(sensors);
        self.readings.iter_mut().take(sensors).for_each(|readings| readings.skipped += 1);
    }

    fn make_room(&mut self, sensors: usize) {
        let room = self.readings.len().max(sensors);
        self.readings.resize(room, Readings::default());
    }

    /// Returns what looks wrong with the readings, as a sentence.
    fn suspicion(&self) -> Option<String> {
        let Readings { echoes, no_echoes, missing, .. } = self.total();
        let read = echoes + no_echoes + missing;
        let lines = self.lines;
        if read > 0 && echoes == 0 {
            let most = if no_echoes >= missing {
                "most are not below the longest range"
            } else {
                "most are below the shortest range, or 0"
            };
            return Some(format!(
                "{lines}: not one of {read} readings is an echo, {most}: is there nothing in reach, or \
                 are they not in metres?"
            ));
        }
        // Without an echo, many sensors report the same number again and again.
        let piled = self.longest_echoes >= 20 && 50 * self.longest_echoes >= echoes;
        piled.then(|| {
            format!(
                "{lines}: {} of {echoes} echoes are {} m, the longest of all: if that is no echo, say \
                 so by a line PARAM robot_max_sonar or robot_front_laser_max, or in the configuration",
                self.longest_echoes, self.longest_echo
            )
        })
    }
}

impl Account {
    /// Begins to count a sensor, and returns its number.
    pub(super) fn add_sensor(&mut self, lines: &'static str) -> usize {
        self.sensors.push(SensorAccount::new(lines));
        self.sensors.len() - 1
    }

    pub(super) fn leave_out(&mut self, tag: &'static str) {
        match self.left_out.iter_mut().find(|(other, _)| *other == tag) {
            Some((_, count)) => *count += 1,
            None => self.left_out.push((tag, 1)),
        }
    }

    /// Returns the remarks about the log that a user should read, apart from the skipped frames,
    /// each as a sentence.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.placed_by_order > 0 {
            remarks.push(format!(
                "the times of {} are too coarse, or of another clock than the odometry's, to place \
                 them: the order of the lines did, and the logger's time",
                plural(self.placed_by_order, "frame")
            ));
        }
        if self.restarts > 0 {
            remarks.push(format!("the clock starts anew {}", plural(self.restarts, "time")));
        }
        let left_out: Vec<String> =
            self.left_out.iter().map(|(tag, count)| format!("{count} {tag}")).collect();
        if !left_out.is_empty() {
            remarks.push(format!("lines that were not used: {}", left_out.join(", ")));
        }
        remarks.extend(self.notes.iter().cloned());
        remarks.extend(self.sensors.iter().filter_map(SensorAccount::suspicion));
        remarks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_counted_for_each_sensor() {
        let mut sensor = SensorAccount::new("SONAR");
        sensor.count(&[Range::Echo(1.5), Range::Missing, Range::NoEcho], &[1]);
        sensor.count(&[Range::Echo(0.5), Range::Missing, Range::Echo(1.5)], &[]);
        sensor.count_skipped(3);
        let counts = |readings: &Readings| {
            [readings.echoes, readings.no_echoes, readings.missing, readings.skipped]
        };
        let all: Vec<_> = sensor.readings.iter().map(counts).collect();
        assert_eq!(all, [[2, 0, 0, 1], [0, 0, 1, 2], [1, 1, 0, 1]]);
        assert_eq!(counts(&sensor.total()), [3, 1, 1, 4]);
        assert_eq!(sensor.total().total(), 9);
        assert_eq!((sensor.longest_echoes, sensor.suspicion()), (2, None));
    }

    #[test]
    fn centimetres_and_a_longest_range_that_nobody_stated_look_wrong() {
        let suspicion = |range: Range, times: usize| {
            let mut sensor = SensorAccount::new("SONAR");
            (0..times).for_each(|_| sensor.count(&[range], &[]));
            sensor.suspicion().unwrap_or_default()
        };
        assert!(suspicion(Range::NoEcho, 1).contains("not in metres?"));
        assert!(suspicion(Range::Missing, 1).contains("below the shortest range"));
        assert!(suspicion(Range::Echo(5.0), 20).contains("20 of 20 echoes are 5 m"));
        assert_eq!(suspicion(Range::Echo(5.0), 19), "");
    }
}
