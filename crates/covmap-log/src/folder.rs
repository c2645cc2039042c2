//! A folder of three files, in which line i of each is the same frame.

use super::device::{Device, Measured, laser_beams, short};
use super::fields::Fields;
use super::lines::Lines;
use super::poses::{PoseFile, Units};
use super::skipped::Damage;
use super::track::{Stamp, Ties};
use super::{Account, LogError, LogOptions, Sensor, SkipReason, foreign};
use covmap_sonar::SonarRing;
use nalgebra::Isometry2;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

/// Millimetres in a metre.
const PER_METRE: f64 = 1e3;
/// The distance of the laser in front of the robot's centre \[m\], an estimate.
const LASER_AHEAD: f64 = 0.12;
/// The shortest and the longest range of the laser \[m\].
const LASER_RANGES: (f64, f64) = (0.3, 81.0);

/// The frames of `sonar.txt` or of `laser.txt`.
pub(super) struct FolderLog {
    lines: Lines,
    /// The sonars as configured, if sonars are wanted.
    sonar: Option<SonarRing>,
    device: Device<usize>,
    ties: Ties,
}

impl FolderLog {
    pub(super) fn open(folder: &Path, options: &LogOptions) -> Result<Self, LogError> {
        let (name, other) = match options.sensor {
            Sensor::Sonar => ("sonar.txt", "laser.txt"),
            Sensor::Laser => ("laser.txt", "sonar.txt"),
        };
        if !folder.join(name).exists() && folder.join(other).exists() {
            let (path, has) = (folder.to_owned(), other);
            return Err(LogError::OtherSensor { path, name, has });
        }
        Ok(Self::new(Lines::open(&file_in(folder, name)?)?, options))
    }

    pub(super) fn new(lines: Lines, options: &LogOptions) -> Self {
        let sonar = match options.sensor {
            Sensor::Sonar => Some(options.ring.clone()),
            Sensor::Laser => None,
        };
        Self { lines, sonar, device: Device::new(), ties: Ties::default() }
    }

    pub(super) fn path(&self) -> &Path {
        self.lines.path()
    }

    /// Returns whether its clock is too coarse to tell its lines apart.
    pub(super) fn is_coarse(&self) -> bool {
        self.ties.is_coarse()
    }

    /// Returns the next good frame, without a pose.
    pub(super) fn next(&mut self, account: &mut Account) -> Result<Option<Measured>, LogError> {
        while self.lines.advance()? {
            account.skipped.add_frame();
            match self.parse(account) {
                Ok(measured) => return Ok(Some(measured)),
                Err(damage) => account.skipped.add(self.lines.path(), self.lines.line(), damage),
            }
        }
        Ok(None)
    }

    fn parse(&mut self, account: &mut Account) -> Result<Measured, Damage> {
        let text = self.lines.text();
        let mut fields = Fields::new(&text);
        let stamp = Stamp { time: fields.time("time", 1e3)?, logger: None };
        let values = fields.ranges(fields.left(), PER_METRE)?;
        let ring = match &self.sonar {
            Some(ring) => self.device.ring(0, (0.0, 0.0), (account, "sonar.txt"), |_, told| {
                let what = format!("{} sonars, their places, cones and ranges", ring.beams().len());
                told.take(what, "the configuration");
                Ok(ring.beams().to_vec())
            })?,
            None => {
                let count = checked(values.len())?;
                self.device.ring(count, (0.0, 0.0), (account, "laser.txt"), |count, told| {
                    let beams = laser(*count);
                    let step = short(180.0 / f64::from(u16::try_from(*count).unwrap_or(361) - 1));
                    told.take(
                        format!("{count} beams from -90° in steps of {step}°, longest range 81 m"),
                        "as is usual in a folder",
                    );
                    Ok(beams)
                })?
            }
        };
        let measured = Measured::new(&self.lines, stamp, ring, &values, account)?;
        Ok(Measured { tied: self.ties.add(stamp.time), ..measured })
    }
}

/// Returns the odometry of a folder.
pub(super) fn odometry(folder: &Path) -> Result<PoseFile, LogError> {
    PoseFile::open(&file_in(folder, "od.txt")?, Units::ODOMETRY)
}

fn file_in(folder: &Path, name: &'static str) -> Result<PathBuf, LogError> {
    let file = folder.join(name);
    if file.exists() {
        return Ok(file);
    }
    let path = folder.to_owned();
    match foreign::folder_kind(folder) {
        Some(kind) => Err(LogError::Foreign { path, kind }),
        None => Err(LogError::MissingFile { path, name }),
    }
}

fn checked(beams: usize) -> Result<usize, Damage> {
    match beams {
        181 | 361 => Ok(beams),
        _ => {
            let fault = format!("ranges: there are {beams}, but a laser has 181 or 361");
            Err(Damage::new(SkipReason::Count, fault))
        }
    }
}

fn laser(beams: usize) -> Vec<covmap_sonar::Beam> {
    let step = PI / (beams - 1) as f64;
    let mount = Isometry2::translation(LASER_AHEAD, 0.0);
    laser_beams(&mount, beams, (-FRAC_PI_2, step), LASER_RANGES)
}
