//! CARMEN's text logs.

use super::carmen_line::{Described, LaserLine, SonarLine};
use super::device::{Device, Measured, laser_beams, short};
use super::fields::Fields;
use super::lines::Lines;
use super::parameters::{Laser, Parameters, Stated};
use super::queue::Queue;
use super::skipped::Damage;
use super::track::Fix;
use super::{Account, LogError, LogOptions, Passed, Sensor, SensorAccount, carmen_line};
use covmap_sonar::{Beam, SonarRing};
use nalgebra::{Isometry2, Translation2, UnitComplex};
use std::collections::BTreeMap;
use std::path::Path;

/// The lasers; if a log has several lines for one scan, the first of these is read.
const LASERS: [Laser; 9] = [
    Laser { number: 1, tag: "FLASER" },
    Laser { number: 2, tag: "RLASER" },
    Laser { number: 1, tag: "ROBOTLASER1" },
    Laser { number: 2, tag: "ROBOTLASER2" },
    Laser { number: 1, tag: "RAWLASER1" },
    Laser { number: 2, tag: "RAWLASER2" },
    Laser { number: 3, tag: "RAWLASER3" },
    Laser { number: 4, tag: "RAWLASER4" },
    Laser { number: 5, tag: "RAWLASER5" },
];

/// The facts about a laser from its first line.
struct LaserDevice {
    laser: Laser,
    device: Device<(usize, Option<Described>)>,
    /// `robot_from_laser`.
    mount: Option<Isometry2<f64>>,
}

/// The frames of a CARMEN log, with the poses that the log gives them.
pub(super) struct CarmenLog {
    lines: Lines,
    sensor: Sensor,
    /// The sonars as configured, for all that the log does not state.
    configured: SonarRing,
    /// Whether poses come from another file.
    posed: bool,
    /// Whether `TRUEPOS` has the poses, not `ODOM` or the lines of lasers.
    true_poses: bool,
    parameters: Parameters,
    sonar: Device<(f64, Vec<[f64; 3]>)>,
    lasers: BTreeMap<u8, LaserDevice>,
    queue: Queue,
    /// The number of lines of each sensor that is not wanted.
    unwanted: BTreeMap<&'static str, usize>,
    ended: bool,
}

impl CarmenLog {
    pub(super) fn new(mut lines: Lines, options: &LogOptions) -> Self {
        let mut parameters = Parameters::default();
        let mut lasers = BTreeMap::new();
        let (mut odometry, mut truths) = (0usize, 0usize);
        for line in lines.head() {
            let text = String::from_utf8_lossy(line);
            let (tag, rest) = split(&text);
            match tag {
                "PARAM" => parameters.look_ahead(&mut Fields::new(rest)),
                "ODOM" => odometry += 1,
                "TRUEPOS" => truths += 1,
                _ => {
                    if let Some(place) = LASERS.iter().position(|laser| laser.tag == tag) {
                        let best = lasers.entry(LASERS[place].number).or_insert(place);
                        *best = place.min(*best);
                    }
                }
            }
        }
        lines.forget_head();
        Self {
            lines,
            sensor: options.sensor,
            configured: options.ring.clone(),
            posed: options.poses.is_some(),
            // A few such lines come from a localisation that reported now and then.
            true_poses: truths > 0 && 4 * truths >= odometry,
            parameters,
            sonar: Device::new(),
            lasers: lasers.into_values().map(|at| (LASERS[at].number, LASERS[at].into())).collect(),
            queue: Queue::default(),
            unwanted: BTreeMap::new(),
            ended: false,
        }
    }

    pub(super) fn path(&self) -> &Path {
        self.lines.path()
    }

    /// Returns the lines of sensors that are not wanted, with their numbers.
    pub(super) fn unwanted(&self) -> Vec<(&'static str, usize)> {
        self.unwanted.iter().map(|(tag, count)| (*tag, *count)).collect()
    }

    /// Returns the poses that the robot passed after the last frame.
    pub(super) fn rest(&mut self) -> Vec<Passed> {
        self.queue.rest()
    }

    /// Returns the next good frame, with its pose unless all poses come from another file.
    pub(super) fn next(&mut self, account: &mut Account) -> Result<Option<Measured>, LogError> {
        loop {
            if let Some(frame) = self.queue.pop(self.ended, self.lines.path(), account) {
                return Ok(Some(frame));
            }
            if self.ended {
                return Ok(None);
            }
            if !self.lines.advance()? {
                self.ended = true;
                account.restarts += self.queue.restarts();
            } else if let Some(frame) = self.read(account) {
                return Ok(Some(frame));
            }
        }
    }

    /// Reads the line, and returns its frame if the frame need not wait for a pose.
    fn read(&mut self, account: &mut Account) -> Option<Measured> {
        let text = self.lines.text().into_owned();
        let (tag, rest) = split(&text);
        // A line of another tag is not split, because it may have hundreds of words.
        let fields = || Fields::new(rest);
        let laser = LASERS.iter().find(|laser| laser.tag == tag);
        match (tag, laser, self.sensor) {
            ("PARAM", ..) => {
                let damage = self.parameters.read(&mut fields()).err();
                self.say_pose(account, damage.map(|damage| (self.lines.line(), damage)));
                None
            }
            ("ODOM" | "TRUEPOS", ..) => {
                self.fix(tag, &mut fields(), account);
                None
            }
            ("SONAR", _, Sensor::Sonar) => {
                let sonar = carmen_line::sonar(&mut fields());
                let frame = sonar.and_then(|sonar| self.sonar(sonar, account));
                self.take(frame.map(|frame| (frame, None)), account)
            }
            (_, Some(laser), Sensor::Laser) => {
                let device = self.lasers.entry(laser.number).or_insert_with(|| (*laser).into());
                if device.laser != *laser {
                    account.leave_out(laser.tag);
                    return None;
                }
                let line = match laser.tag {
                    "FLASER" | "RLASER" => carmen_line::plain_laser(&mut fields()),
                    tag => carmen_line::described_laser(&mut fields(), tag.starts_with("RAW")),
                };
                let frame = line.and_then(|line| self.laser(laser.number, line, account));
                self.take(frame, account)
            }
            ("SONAR", ..) => {
                *self.unwanted.entry("SONAR").or_default() += 1;
                None
            }
            (_, Some(laser), _) => {
                *self.unwanted.entry(laser.tag).or_default() += 1;
                None
            }
            _ => None,
        }
    }

    /// Reads a pose of the robot.
    fn fix(&mut self, tag: &str, fields: &mut Fields<'_>, account: &mut Account) {
        let tag = if tag == "ODOM" { "ODOM" } else { "TRUEPOS" };
        if self.posed || self.true_poses != (tag == "TRUEPOS") {
            account.leave_out(tag);
            return;
        }
        let line = self.lines.line();
        let wrong = match carmen_line::pose(fields) {
            Ok((stamp, pose)) => self.queue.push_fix(Fix { stamp, line, pose }),
            Err(damage) => Some((line, damage)),
        };
        self.say_pose(account, wrong);
    }

    fn say_pose(&self, account: &mut Account, wrong: Option<(usize, Damage)>) {
        if let Some((line, damage)) = wrong {
            account.skipped.add_pose(self.lines.path(), line, &damage);
        }
    }

    /// Adds a frame, with its pose by odometry if it has a pose of its own.
    fn take(
        &mut self,
        frame: Result<(Measured, Option<Isometry2<f64>>), Damage>,
        account: &mut Account,
    ) -> Option<Measured> {
        account.skipped.add_frame();
        match frame {
            Ok((frame, _)) if self.posed => return Some(frame),
            Ok((frame, Some(odometry))) => self.queue.push_posed(frame, odometry),
            Ok((frame, None)) => self.queue.push(frame),
            Err(damage) => account.skipped.add(self.lines.path(), self.lines.line(), damage),
        }
        None
    }

    fn sonar(&mut self, sonar: SonarLine, account: &mut Account) -> Result<Measured, Damage> {
        let SonarLine { cone_angle, ranges, places, stamp } = sonar;
        let limits = [self.parameters.sonar_min_range(), self.parameters.sonar_max_range()];
        let [min, max] = &limits;
        let key = |limit: &Option<Stated>| limit.as_ref().map_or(-1.0, |limit| limit.value);
        let configured = &self.configured;
        let ring = self.sonar.ring(
            (cone_angle, places),
            (key(min), key(max)),
            (account, "SONAR"),
            |(cone_angle, places), told| {
                let beams = sonar_beams(*cone_angle, places, configured, &limits);
                tell_sonars(&beams, &limits, told);
                Ok(beams)
            },
        )?;
        self.say_poses(None, account);
        Measured::new(&self.lines, stamp, ring, &ranges, account)
    }

    /// Returns the frame of a laser line, with the robot's pose and its pose by odometry.
    ///
    /// The pose puts the laser where the line says it was: a corrected log corrects the poses of
    /// the laser, not those of the robot.
    fn laser(
        &mut self,
        number: u8,
        line: LaserLine,
        account: &mut Account,
    ) -> Result<(Measured, Option<Isometry2<f64>>), Damage> {
        let LaserLine { described, ranges, poses, stamp } = line;
        let Some(LaserDevice { laser, device, mount }) = self.lasers.get_mut(&number) else {
            unreachable!("the laser was entered")
        };
        let parameters = &self.parameters;
        let (seen, mounting) = parameters.mount(*laser, poses.as_ref());
        let mount = *mount.get_or_insert(seen);
        let max = parameters.laser_max_range(*laser, described.as_ref());
        let ring = device.ring(
            (ranges.len(), described),
            (0.0, max.value),
            (account, laser.tag),
            |(count, described), told| {
                let (start, step) = parameters.angles(*laser, described.as_ref(), *count)?;
                tell_laser((start, &step), *count, (&mount, mounting), &max, told);
                Ok(laser_beams(&mount, *count, (start, step.value), (0.0, max.value)))
            },
        )?;
        let tag = laser.tag;
        let own = poses.filter(|_| !self.true_poses && !self.posed);
        self.say_poses(own.map(|_| tag), account);
        let measured = Measured::new(&self.lines, stamp, ring, &ranges, account)?;
        let pose = own.map(|[laser, _]| laser * mount.inverse());
        Ok((Measured { pose, ..measured }, own.map(|[_, robot]| robot)))
    }

    fn say_poses(&self, own: Option<&str>, account: &mut Account) {
        if account.poses.is_empty() {
            let tag = own.unwrap_or(if self.true_poses { "TRUEPOS" } else { "ODOM" });
            account.poses = format!("lines {tag}");
        }
    }
}

impl From<Laser> for LaserDevice {
    fn from(laser: Laser) -> Self {
        Self { laser, device: Device::new(), mount: None }
    }
}

/// Returns the tag of a line, and the rest of the line.
fn split(line: &str) -> (&str, &str) {
    let line = line.trim();
    line.split_once([' ', '\t']).unwrap_or((line, ""))
}

/// Returns the beams of a ring as a line describes it.
///
/// The line does not state the shortest and the longest range; these come from parameters, or else
/// from the configuration.
fn sonar_beams(
    cone_angle: f64,
    places: &[[f64; 3]],
    configured: &SonarRing,
    [min, max]: &[Option<Stated>; 2],
) -> Vec<Beam> {
    let known = configured.beams();
    let same = known.len() == places.len();
    let beam = |(i, &[x, y, theta]): (usize, &[f64; 3])| {
        let like = known[if same { i } else { 0 }];
        Beam {
            pose: Isometry2::from_parts(Translation2::new(x, y), UnitComplex::new(theta)),
            half_angle: 0.5 * cone_angle,
            min_range: min.as_ref().map_or(like.min_range, |min| min.value),
            max_range: max.as_ref().map_or(like.max_range, |max| max.value),
        }
    };
    places.iter().enumerate().map(beam).collect()
}

fn tell_sonars(beams: &[Beam], limits: &[Option<Stated>; 2], told: &mut SensorAccount) {
    let Some(first) = beams.first() else { return };
    let cone = (2.0 * first.half_angle).to_degrees();
    told.take(format!("{} sonars with cones of {cone:.1}°", beams.len()), "lines SONAR");
    let ranges = [("shortest", first.min_range), ("longest", first.max_range)];
    for ((name, range), stated) in ranges.into_iter().zip(limits) {
        let source = stated.as_ref().map_or("the configuration", |stated| stated.source.as_str());
        told.take(format!("{name} range {} m", short(range)), source);
    }
}

fn tell_laser(
    (start, step): (f64, &Stated),
    count: usize,
    (mount, mounting): (&Isometry2<f64>, String),
    max: &Stated,
    told: &mut SensorAccount,
) {
    let [start, degrees] = [start, step.value].map(f64::to_degrees);
    told.take(
        format!("{count} beams from {}° in steps of {}°", short(start), short(degrees)),
        step.source.clone(),
    );
    told.take(format!("longest range {} m", short(max.value)), max.source.clone());
    let place = mount.translation.vector;
    let angle = mount.rotation.angle().to_degrees();
    told.take(
        format!("mounted at ({}, {}) m, {}°", short(place.x), short(place.y), short(angle)),
        mounting,
    );
}
