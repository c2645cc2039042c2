//! The lines `PARAM` of a log, and the geometry that follows from them.

use super::carmen_line::Described;
use super::fields::Fields;
use super::skipped::Damage;
use super::{SkipReason, carmen_writer};
use nalgebra::{Isometry2, Vector2};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// The longest range of a laser whose log does not state it \[m\].
const LASER_MAX_RANGE: f64 = 80.0;
/// A laser's pose farther than this from the robot's is a corrected pose \[m\].
const FARTHEST_MOUNT: f64 = 1.0;
/// The largest number of parameters that are remembered.
const MOST: usize = 4096;
/// The endings of the names that matter.
const ENDINGS: [&str; 9] = [
    "_max",
    "_fov",
    "_resolution",
    "_offset",
    "_max_sonar",
    "_min_sonar",
    "_max_laser",
    "_max_range",
    "_min_range",
];

/// A number, and its source.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stated {
    pub(super) value: f64,
    pub(super) source: String,
}

/// The numbers that a log states.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    values: BTreeMap<String, f64>,
    /// Values from the beginning of the log, used until its lines are reached.
    ahead: BTreeMap<String, f64>,
}

impl Parameters {
    /// Reads `PARAM name value ipc_timestamp host logger_timestamp`.
    pub(super) fn read(&mut self, fields: &mut Fields<'_>) -> Result<(), Damage> {
        insert(&mut self.values, fields)
    }

    /// Reads a line of the beginning, ahead of its turn.
    pub(super) fn look_ahead(&mut self, fields: &mut Fields<'_>) {
        // A fault is reported when the line has its turn.
        let _ = insert(&mut self.ahead, fields);
    }

    fn get(&self, name: &str) -> Option<Stated> {
        let value = *self.values.get(name).or_else(|| self.ahead.get(name))?;
        Some(Stated { value, source: format!("PARAM {name}") })
    }

    fn first(&self, names: impl IntoIterator<Item = String>) -> Option<Stated> {
        names.into_iter().find_map(|name| self.get(&name))
    }

    /// Returns the longest range of sonars.
    ///
    /// Of two, the smaller one counts: from there on, no reading tells an echo from none.
    pub(super) fn sonar_max_range(&self) -> Option<Stated> {
        let names = [carmen_writer::MAX_RANGE, "robot_max_sonar", "robot_sonar_max"];
        smallest(names.into_iter().filter_map(|name| self.get(name)))
    }

    pub(super) fn sonar_min_range(&self) -> Option<Stated> {
        [carmen_writer::MIN_RANGE, "robot_min_sonar"].into_iter().find_map(|name| self.get(name))
    }

    /// Returns the longest range of a laser: the smallest that its line or a parameter states.
    pub(super) fn laser_max_range(&self, laser: Laser, described: Option<&Described>) -> Stated {
        let names = laser
            .words()
            .iter()
            .flat_map(|word| [format!("robot_{word}_max"), format!("laser_{word}_max")]);
        let line = described.map(|line| Stated { value: line.max_range, source: laser.lines() });
        let all = names.chain(["robot_max_laser".to_owned()]).filter_map(|name| self.get(&name));
        let unstated =
            || Stated { value: LASER_MAX_RANGE, source: "the log does not state it".to_owned() };
        smallest(all.chain(line)).unwrap_or_else(unstated)
    }

    /// Returns the angle of the first beam, and the step \[rad\].
    pub(super) fn angles(
        &self,
        laser: Laser,
        described: Option<&Described>,
        count: usize,
    ) -> Result<(f64, Stated), Damage> {
        let stated = |what: &str| {
            self.first(laser.words().iter().map(|word| format!("laser_{word}_{what}")))
        };
        let positive = |stated: &Stated| stated.value > 0.0;
        let (start, field, step) = match described {
            Some(line) => {
                let of_line = |value| Some(Stated { value, source: laser.lines() });
                (Some(line.start), of_line(line.field_of_view), of_line(line.resolution))
            }
            None => {
                let step = stated("resolution").map(Stated::degrees_in_radians);
                (None, stated("fov").map(Stated::in_radians), step)
            }
        };
        spread(count, start, field.filter(positive), step.filter(positive)).ok_or_else(|| {
            let fault = format!("number of ranges: nothing says at which angles {count} are");
            Damage::new(SkipReason::Count, fault)
        })
    }

    /// Returns `robot_from_laser`: from the parameters, or else from the poses of one line.
    pub(super) fn mount(
        &self,
        laser: Laser,
        poses: Option<&[Isometry2<f64>; 2]>,
    ) -> (Isometry2<f64>, String) {
        // The rear laser faces back.
        let turned = if laser.number == 2 { PI } else { 0.0 };
        let stated =
            |what: &str| self.first(laser.words().iter().map(|word| format!("robot_{word}{what}")));
        let found = ["_offset", "_side_offset", "_angular_offset"].map(stated);
        if let Some(first) = found.iter().flatten().next() {
            let source = first.source.clone();
            let [ahead, left, angle] = found.map(|stated| stated.map(|stated| stated.value));
            let place = Vector2::new(ahead.unwrap_or(0.0), left.unwrap_or(0.0));
            return (Isometry2::new(place, angle.unwrap_or(turned)), source);
        }
        let seen = poses.map(|[laser, robot]| robot.inverse() * laser);
        match seen.filter(|seen| seen.translation.vector.norm() <= FARTHEST_MOUNT) {
            Some(seen) => (seen, format!("the poses in the first of the {}", laser.lines())),
            None => (Isometry2::rotation(turned), "the log does not state it".to_owned()),
        }
    }
}

fn insert(values: &mut BTreeMap<String, f64>, fields: &mut Fields<'_>) -> Result<(), Damage> {
    let name = fields.word("name")?;
    let is_switch = name.contains("_use_") || name.len() > 64;
    if is_switch || !ENDINGS.iter().any(|ending| name.ends_with(ending)) {
        return Ok(());
    }
    let value = fields.number(name)?;
    if values.len() < MOST || values.contains_key(name) {
        values.insert(name.to_owned(), value);
    }
    Ok(())
}

fn smallest(stated: impl Iterator<Item = Stated>) -> Option<Stated> {
    let possible = stated.filter(|stated| stated.value > 0.0);
    possible.min_by(|a, b| a.value.total_cmp(&b.value))
}

impl Stated {
    fn degrees_in_radians(self) -> Self {
        Self { value: self.value.to_radians(), ..self }
    }

    /// Converts a field of view, written in radians or in degrees.
    fn in_radians(self) -> Self {
        if self.value > TAU + 1e-3 { self.degrees_in_radians() } else { self }
    }
}

/// A laser of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Laser {
    /// The laser's number: 1 faces ahead, 2 back.
    pub(super) number: u8,
    /// The tag of the laser's lines.
    pub(super) tag: &'static str,
}

impl Laser {
    /// Returns the words by which parameters name the laser.
    fn words(self) -> &'static [&'static str] {
        match self.number {
            1 => &["front_laser", "frontlaser", "laser1"],
            2 => &["rear_laser", "rearlaser", "laser2"],
            3 => &["laser3"],
            4 => &["laser4"],
            _ => &["laser5"],
        }
    }

    fn lines(self) -> String {
        format!("lines {}", self.tag)
    }
}

/// Returns the angle of the first of `count` beams, and the step between beams \[rad\].
///
/// Both come from the field of view or the step, or from the usual ones for the number of beams.
fn spread(
    count: usize,
    start: Option<f64>,
    field: Option<Stated>,
    step: Option<Stated>,
) -> Option<(f64, Stated)> {
    let (beams, gaps) = (count as f64, count.saturating_sub(1).max(1) as f64);
    let step = match (&field, step) {
        (Some(field), Some(step)) if (field.value / step.value - gaps).abs() <= 1.01 => {
            let source = both(&field.source, &step.source);
            Stated { source, ..step }
        }
        (Some(field), _) => {
            // A half-open field has the rounder of the two steps.
            let round =
                |step: f64| (step.to_degrees() * 8.0 - (step.to_degrees() * 8.0).round()).abs();
            let [closed, open] = [field.value / gaps, field.value / beams];
            let value = if round(open) < 1e-4 && round(closed) > 1e-4 { open } else { closed };
            Stated { value, source: field.source.clone() }
        }
        (None, Some(step)) => step,
        (None, None) => {
            let source = format!("as is usual for {count} beams");
            Stated { value: usual_step(count)?.to_radians(), source }
        }
    };
    // An even number of beams leaves out the last one.
    let width = field.map_or_else(
        || step.value * if count.is_multiple_of(2) { beams } else { gaps },
        |field| field.value,
    );
    let possible = gaps * step.value <= TAU + 2.0 * step.value;
    possible.then(|| (start.unwrap_or(-0.5 * width), step))
}

fn both(a: &str, b: &str) -> String {
    if a == b { a.to_owned() } else { format!("{a} and {b}") }
}

/// Returns the step of lasers with a number of beams \[degrees\].
fn usual_step(count: usize) -> Option<f64> {
    match count {
        101 | 180 | 181 => Some(1.0),
        201 | 360 | 361 | 540 | 541 => Some(0.5),
        401 | 720 | 721 | 1080 | 1081 => Some(0.25),
        682 | 683 | 726 | 769 => Some(360.0 / 1024.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRONT: Laser = Laser { number: 1, tag: "FLASER" };
    const REAR: Laser = Laser { number: 2, tag: "RAWLASER2" };

    fn parameters(lines: &[&str]) -> Parameters {
        let mut parameters = Parameters::default();
        lines.iter().for_each(|line| parameters.read(&mut Fields::new(line)).unwrap());
        parameters
    }

    /// Checks the first angle and the step \[degrees\].
    #[track_caller]
    fn check_angles(lines: &[&str], count: usize, expected: (f64, f64)) {
        let (start, step) = parameters(lines).angles(FRONT, None, count).unwrap();
        let found = (start.to_degrees(), step.value.to_degrees());
        let near = (found.0 - expected.0).abs() < 1e-3 && (found.1 - expected.1).abs() < 1e-5;
        assert!(near, "{count} beams, {lines:?}: {found:?}");
    }

    #[test]
    fn the_number_of_beams_says_how_they_are_spread() {
        check_angles(&[], 180, (-90.0, 1.0));
        check_angles(&[], 181, (-90.0, 1.0));
        check_angles(&[], 360, (-90.0, 0.5));
        check_angles(&[], 361, (-90.0, 0.5));
        check_angles(&[], 541, (-135.0, 0.5));
        check_angles(&[], 1081, (-135.0, 0.25));
        assert!(parameters(&[]).angles(FRONT, None, 77).is_err());
    }

    #[test]
    fn the_field_of_view_and_the_resolution_of_the_log_win() {
        let field = "laser_front_laser_fov 1.745329 0 h 0";
        check_angles(&[field, "laser_front_laser_resolution 1.0 0 h 0"], 101, (-50.0, 1.0));
        check_angles(&[field], 201, (-50.0, 0.5));
        check_angles(&["laser_front_laser_fov 100 0 h 0"], 101, (-50.0, 1.0));
        check_angles(&["laser_front_laser_fov 180 0 h 0"], 360, (-90.0, 0.5));
        check_angles(&["laser_front_laser_fov 3.1415927 0 h 0"], 181, (-90.0, 1.0));
        check_angles(&["laser_front_laser_resolution 0.5 0 h 0"], 181, (-45.0, 0.5));
        // The two contradict each other: the field of view wins.
        let wrong = "laser_front_laser_resolution 0.25 0 h 0";
        check_angles(&["laser_front_laser_fov 180 0 h 0", wrong], 361, (-90.0, 0.5));
    }

    #[test]
    fn a_line_that_describes_its_laser_wins() {
        let line = Described { start: -1.0, field_of_view: 2.0, resolution: 0.0, max_range: 30.0 };
        let (start, step) = parameters(&[]).angles(FRONT, Some(&line), 5).unwrap();
        assert!((start + 1.0).abs() < 1e-12 && (step.value - 0.5).abs() < 1e-12);
        assert_eq!(step.source, "lines FLASER");
    }

    #[test]
    fn of_several_longest_ranges_the_smallest_is_the_limit() {
        let parameters = parameters(&[
            "covmap_sonar_max_range 9.5 0 h 0",
            "robot_max_sonar 5.0 0 h 0",
            "robot_front_laser_max 20.0 0 h 0",
            "robot_use_sonar on 0 h 0",
        ]);
        let sonar = parameters.sonar_max_range().unwrap();
        assert_eq!(
            (sonar.value.to_bits(), sonar.source.as_str()),
            (5f64.to_bits(), "PARAM robot_max_sonar")
        );
        let line = Described { start: 0.0, field_of_view: 1.0, resolution: 0.1, max_range: 81.92 };
        let laser = parameters.laser_max_range(FRONT, Some(&line));
        assert_eq!(laser.source, "PARAM robot_front_laser_max");
        let rear = parameters.laser_max_range(REAR, None);
        assert!((rear.value - LASER_MAX_RANGE).abs() < 1e-12, "{rear:?}");
    }

    #[test]
    fn the_rear_laser_looks_back() {
        let (mount, _) = parameters(&["robot_rearlaser_offset -0.2 0 h 0"]).mount(REAR, None);
        assert!((mount.translation.x + 0.2).abs() < 1e-12);
        assert!((mount.rotation.angle().abs() - PI).abs() < 1e-12);
    }
}
