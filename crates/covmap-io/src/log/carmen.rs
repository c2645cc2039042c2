//! CARMEN's text logs.

use super::carmen_line::{LaserIdentity, LaserLine, SonarLine};
use super::device::{Clock, Device, Measured, laser_beams};
use super::fields::Fields;
use super::lines::Lines;
use super::poses::{At, Track};
use super::skipped::Damage;
use super::{LogError, LogOptions, Sensor, SkipReason, Skipped, carmen_line};
use covmap_sonar::{Beam, SonarRing};
use nalgebra::{Isometry2, Translation2, UnitComplex, Vector2};
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// So many scans may wait for the odometry after them.
const MOST_WAITING: usize = 256;
/// A laser without `PARAM robot_front_laser_max` sees so far \[m\].
const LASER_MAX_RANGE: f64 = 80.0;
/// A pose of the laser farther than this from the robot's is a corrected one \[m\].
const FARTHEST_MOUNT: f64 = 1.0;

/// The parameters that matter, as the log states them.
#[derive(Debug, Default)]
struct Parameters {
    laser_max_range: Option<f64>,
    /// Degrees.
    laser_resolution: Option<f64>,
    laser_ahead: Option<f64>,
    laser_left: Option<f64>,
    laser_angle: Option<f64>,
    sonar_min_range: Option<f64>,
    sonar_max_range: Option<f64>,
}

/// The frames of a CARMEN log, with the poses that it has for them.
pub(super) struct CarmenLog {
    lines: Lines,
    sensor: Sensor,
    /// What the log does not say of its sonars.
    configured: SonarRing,
    /// Whether poses come from elsewhere.
    posed: bool,
    parameters: Parameters,
    sonar: Device<(f64, Vec<[f64; 3]>)>,
    laser: Device<LaserIdentity>,
    /// `robot_from_laser`.
    mount: Option<Isometry2<f64>>,
    track: Track,
    waiting: VecDeque<Measured>,
    clock: Clock,
    ended: bool,
}

impl CarmenLog {
    pub(super) fn new(lines: Lines, options: &LogOptions) -> Self {
        Self {
            lines,
            sensor: options.sensor,
            configured: options.ring.clone(),
            posed: options.poses.is_some(),
            parameters: Parameters::default(),
            sonar: Device::new(),
            laser: Device::new(),
            mount: None,
            track: Track::default(),
            waiting: VecDeque::new(),
            clock: Clock::default(),
            ended: false,
        }
    }

    pub(super) fn path(&self) -> &Path {
        self.lines.path()
    }

    /// The next good frame. It has its pose unless all poses come from elsewhere.
    pub(super) fn next(&mut self, skipped: &mut Skipped) -> Result<Option<Measured>, LogError> {
        loop {
            if let Some(frame) = self.take_waiting(skipped) {
                return Ok(Some(frame));
            }
            if self.ended {
                return Ok(None);
            }
            if self.lines.advance()? {
                self.read(skipped);
            } else {
                self.ended = true;
            }
        }
    }

    /// The first of the frames that wait for a pose, if its pose is known by now.
    fn take_waiting(&mut self, skipped: &mut Skipped) -> Option<Measured> {
        while let Some(mut frame) = self.waiting.pop_front() {
            if self.posed || frame.pose.is_some() {
                return Some(frame);
            }
            let full = self.waiting.len() >= MOST_WAITING;
            match self.track.at(frame.time) {
                At::Pose(pose) => {
                    frame.pose = Some(pose);
                    return Some(frame);
                }
                At::Later if !self.ended && !full => {
                    self.waiting.push_front(frame);
                    return None;
                }
                At::Later | At::Unknown => {
                    let fault = format!("there is no ODOM around the time {} s", frame.time);
                    let damage = Damage::new(SkipReason::NoPose, fault);
                    skipped.add(self.lines.path(), frame.line, damage);
                }
            }
        }
        None
    }

    /// Takes in the line.
    fn read(&mut self, skipped: &mut Skipped) {
        let text = self.lines.text().into_owned();
        let (tag, rest) = text.trim_start().split_once([' ', '\t']).unwrap_or((text.trim(), ""));
        // A line of another tag is not split: it may have hundreds of words.
        let fields = || Fields::new(rest);
        let frame = match (tag, self.sensor) {
            ("PARAM", _) => {
                if let Err(damage) = self.parameters.read(&mut fields()) {
                    skipped.add_pose(self.lines.path(), self.lines.line(), &damage);
                }
                return;
            }
            ("ODOM", _) => {
                let pose = carmen_line::odometry(&mut fields());
                if let Err(damage) = pose.and_then(|(time, pose)| self.track.push(time, pose)) {
                    skipped.add_pose(self.lines.path(), self.lines.line(), &damage);
                }
                return;
            }
            ("SONAR", Sensor::Sonar) => {
                carmen_line::sonar(&mut fields()).and_then(|sonar| self.sonar(sonar, skipped))
            }
            ("FLASER", Sensor::Laser) => {
                carmen_line::flaser(&mut fields()).and_then(|laser| self.laser(laser, skipped))
            }
            ("ROBOTLASER1", Sensor::Laser) => {
                carmen_line::robot_laser(&mut fields()).and_then(|laser| self.laser(laser, skipped))
            }
            _ => return,
        };
        skipped.add_frame();
        match frame.and_then(|frame| self.clock.check(frame.time).map(|()| frame)) {
            Ok(frame) => self.waiting.push_back(frame),
            Err(damage) => skipped.add(self.lines.path(), self.lines.line(), damage),
        }
    }

    fn sonar(&mut self, sonar: SonarLine, skipped: &mut Skipped) -> Result<Measured, Damage> {
        let SonarLine { cone_angle, ranges, places, time } = sonar;
        let (parameters, configured) = (&self.parameters, &self.configured);
        let ring = self.sonar.ring((cone_angle, places), |(cone_angle, places)| {
            sonar_beams(*cone_angle, places, parameters, configured)
        })?;
        Measured::new(&self.lines, time, ring, &ranges, skipped)
    }

    /// The pose is the one that puts the laser where the line says it was: in a corrected log
    /// the poses of the laser are corrected, and those of the robot are not.
    fn laser(&mut self, laser: LaserLine, skipped: &mut Skipped) -> Result<Measured, Damage> {
        let LaserLine { identity, ranges, laser, robot, time } = laser;
        let angles = self.parameters.angles(&identity)?;
        let mount = self.mount.unwrap_or_else(|| self.parameters.mount(&laser, &robot));
        let max_range = identity.described.map(|(.., max_range)| max_range);
        let max_range = max_range.or(self.parameters.laser_max_range).unwrap_or(LASER_MAX_RANGE);
        let ring = self.laser.ring(identity, |identity| {
            laser_beams(&mount, identity.count, angles, (0.0, max_range))
        })?;
        self.mount = Some(mount);
        let measured = Measured::new(&self.lines, time, ring, &ranges, skipped)?;
        Ok(Measured { pose: Some(laser * mount.inverse()), ..measured })
    }
}

impl Parameters {
    /// `PARAM name value ipc_timestamp host logger_timestamp`
    fn read(&mut self, fields: &mut Fields<'_>) -> Result<(), Damage> {
        let name = fields.word("name")?;
        let value = match name {
            "robot_front_laser_max" => &mut self.laser_max_range,
            "laser_front_laser_resolution" => &mut self.laser_resolution,
            "robot_frontlaser_offset" => &mut self.laser_ahead,
            "robot_frontlaser_side_offset" => &mut self.laser_left,
            "robot_frontlaser_angular_offset" => &mut self.laser_angle,
            super::carmen_writer::MIN_RANGE => &mut self.sonar_min_range,
            super::carmen_writer::MAX_RANGE => &mut self.sonar_max_range,
            _ => return Ok(()),
        };
        *value = Some(fields.number(name)?);
        Ok(())
    }

    /// The angle of the first beam, and the step \[rad\].
    fn angles(&self, laser: &LaserIdentity) -> Result<(f64, f64), Damage> {
        let degrees = match (laser.described, laser.count, self.laser_resolution) {
            (Some((start, step, _)), ..) => return Ok((start, step)),
            (None, 180 | 181, _) => 1.0,
            (None, 360 | 361, _) => 0.5,
            (None, _, Some(degrees)) => degrees,
            (None, count, None) => {
                let fault = format!("number of ranges: nothing says at which angles {count} are");
                return Err(Damage::new(SkipReason::Count, fault));
            }
        };
        Ok((-FRAC_PI_2, f64::to_radians(degrees)))
    }

    /// `robot_from_laser`: as the parameters say it, or else as the poses of one frame do.
    fn mount(&self, laser: &Isometry2<f64>, robot: &Isometry2<f64>) -> Isometry2<f64> {
        let stated = [self.laser_ahead, self.laser_left, self.laser_angle];
        if stated.iter().any(Option::is_some) {
            let [ahead, left, angle] = stated.map(|value| value.unwrap_or(0.0));
            return Isometry2::new(Vector2::new(ahead, left), angle);
        }
        let seen = robot.inverse() * laser;
        let near = seen.translation.vector.norm() <= FARTHEST_MOUNT;
        if near { seen } else { Isometry2::identity() }
    }
}

/// The beams of a ring as a line describes it. What it does not say, the shortest and the
/// longest range, is in parameters of our own, or else as configured.
fn sonar_beams(
    cone_angle: f64,
    places: &[[f64; 3]],
    parameters: &Parameters,
    configured: &SonarRing,
) -> Vec<Beam> {
    let known = configured.beams();
    let same = known.len() == places.len();
    let beam = |(i, &[x, y, theta]): (usize, &[f64; 3])| {
        let like = known[if same { i } else { 0 }];
        Beam {
            pose: Isometry2::from_parts(Translation2::new(x, y), UnitComplex::new(theta)),
            half_angle: 0.5 * cone_angle,
            min_range: parameters.sonar_min_range.unwrap_or(like.min_range),
            max_range: parameters.sonar_max_range.unwrap_or(like.max_range),
        }
    };
    places.iter().enumerate().map(beam).collect()
}
