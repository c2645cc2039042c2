//! A folder of three files, in which line i of each is the same frame.

use super::device::{Clock, Device, Measured, laser_beams};
use super::fields::Fields;
use super::lines::Lines;
use super::poses::{PoseFile, Units};
use super::skipped::Damage;
use super::{LogError, LogOptions, Sensor, SkipReason, Skipped};
use covmap_sonar::SonarRing;
use nalgebra::Isometry2;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Millimetres in a metre.
const PER_METRE: f64 = 1e3;
/// The laser stands so far before the robot's centre \[m\], which was estimated.
const LASER_AHEAD: f64 = 0.12;
/// What the laser can measure \[m\].
const LASER_RANGES: (f64, f64) = (0.3, 81.0);

/// The frames of `sonar.txt` or of `laser.txt`.
pub(super) struct FolderLog {
    lines: Lines,
    sonar: Option<Arc<SonarRing>>,
    laser: Device<usize>,
    clock: Clock,
}

impl FolderLog {
    pub(super) fn open(folder: &Path, options: &LogOptions) -> Result<Self, LogError> {
        let name = match options.sensor {
            Sensor::Sonar => "sonar.txt",
            Sensor::Laser => "laser.txt",
        };
        Ok(Self::new(Lines::open(&file_in(folder, name)?)?, options))
    }

    pub(super) fn new(lines: Lines, options: &LogOptions) -> Self {
        let sonar = match options.sensor {
            Sensor::Sonar => Some(Arc::new(options.ring.clone())),
            Sensor::Laser => None,
        };
        Self { lines, sonar, laser: Device::new(), clock: Clock::default() }
    }

    pub(super) fn path(&self) -> &Path {
        self.lines.path()
    }

    /// The next good frame, which says nothing of poses.
    pub(super) fn next(&mut self, skipped: &mut Skipped) -> Result<Option<Measured>, LogError> {
        while self.lines.advance()? {
            skipped.add_frame();
            match self.parse(skipped) {
                Ok(measured) => return Ok(Some(measured)),
                Err(damage) => skipped.add(self.lines.path(), self.lines.line(), damage),
            }
        }
        Ok(None)
    }

    fn parse(&mut self, skipped: &mut Skipped) -> Result<Measured, Damage> {
        let text = self.lines.text();
        let mut fields = Fields::new(&text);
        let time = fields.time("time", 1e3)?;
        let values = fields.ranges(fields.left(), PER_METRE)?;
        let ring = match &self.sonar {
            Some(ring) => Arc::clone(ring),
            None => self.laser.ring(checked(values.len())?, |count| laser(*count))?,
        };
        let measured = Measured::new(&self.lines, time, ring, &values, skipped)?;
        self.clock.check(time)?;
        Ok(measured)
    }
}

/// The odometry of a folder.
pub(super) fn odometry(folder: &Path) -> Result<PoseFile, LogError> {
    PoseFile::open(&file_in(folder, "od.txt")?, Units::ODOMETRY)
}

fn file_in(folder: &Path, name: &'static str) -> Result<PathBuf, LogError> {
    let file = folder.join(name);
    if file.exists() {
        return Ok(file);
    }
    Err(LogError::MissingFile { path: folder.to_owned(), name })
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
    #[allow(clippy::cast_precision_loss, reason = "at most 361")]
    let step = PI / (beams - 1) as f64;
    let mount = Isometry2::translation(LASER_AHEAD, 0.0);
    laser_beams(&mount, beams, (-FRAC_PI_2, step), LASER_RANGES)
}
