//! The one way to read any log.

use super::carmen::CarmenLog;
use super::device::Measured;
use super::folder::{self, FolderLog};
use super::lines::Lines;
use super::poses::{PoseFile, Units};
use super::skipped::Damage;
use super::{LogError, SkipReason, Skipped};
use covmap_sonar::{Scan, SonarRing};
use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Which sensors of a log are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    /// `SONAR`, or `sonar.txt`.
    Sonar,
    /// `FLASER` or `ROBOTLASER1`, or `laser.txt`: a ring of beams without width.
    Laser,
}

/// What is read of a log, and what it does not say itself.
#[derive(Debug, Clone, PartialEq)]
pub struct LogOptions {
    /// Which sensors.
    pub sensor: Sensor,
    /// The sonars as they are configured. What the log records goes before; so this is the
    /// ring of `sonar.txt`, and of `SONAR` the shortest and longest ranges alone.
    pub ring: SonarRing,
    /// Poses to be used instead of the log's: a file with `t_ms x_m y_m theta_rad` in each
    /// line, in the order of time.
    pub poses: Option<PathBuf>,
}

/// A scan of a log, with the ring that measured it.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFrame {
    /// The scan. Its pose is the robot's, also if the ring is a laser on it.
    pub scan: Scan,
    /// The ring, the same for all frames of a log.
    pub ring: Arc<SonarRing>,
    /// The line of the log that has it, counted from 1.
    pub line: usize,
}

enum Source {
    Carmen(Box<CarmenLog>),
    Folder(FolderLog),
}

/// The frames of a log, one after the other, in the order of time.
///
/// A frame that is wrong is passed over and counted, [`LogReader::skipped`]. An error is the
/// end: nothing comes after it. A log in which not one frame is good ends with
/// [`LogError::NoScans`].
///
/// A log is one of
/// - a text log of CARMEN, with lines `PARAM`, `ODOM`, `SONAR`, `FLASER`, `ROBOTLASER1`; others
///   are passed over, as are comments after `#`. It may be packed with gzip, whatever its
///   name. `SONAR` has no pose: it is taken between the two `ODOM` around its time, if they are
///   no more than 2 s apart;
/// - a folder with `od.txt` (`t x y theta`: ms, mm, mm, 1/10°), `sonar.txt` (`t s0 s1 …`: ms,
///   mm) and `laser.txt` (`t r0 … r360`: ms, mm, from −90° counter-clockwise in steps of ½°, by
///   a laser 0.12 m before the robot's centre).
///
/// A range of at least the sensor's longest is `NoEcho`. One below its shortest, 0, a
/// negative one and NaN are `Missing`.
///
/// ```no_run
/// use covmap_io::log::{LogOptions, LogReader, Sensor};
/// use covmap_sonar::SonarRing;
///
/// let options = LogOptions { sensor: Sensor::Sonar, ring: SonarRing::b21r(), poses: None };
/// let mut log = LogReader::open("corridor.log.gz", &options)?;
/// for frame in &mut log {
///     let frame = frame?;
///     println!("{} s: {:?}", frame.scan.time, frame.scan.ranges);
/// }
/// println!("{}", log.skipped());
/// # Ok::<(), covmap_io::log::LogError>(())
/// ```
pub struct LogReader {
    source: Source,
    poses: Option<PoseFile>,
    skipped: Skipped,
    wanted: &'static str,
    frames: usize,
    ended: bool,
}

impl LogReader {
    /// The frames of a CARMEN log, or of a folder of files.
    ///
    /// # Errors
    /// If a file is not there or cannot be read.
    pub fn open(path: impl AsRef<Path>, options: &LogOptions) -> Result<Self, LogError> {
        let path = path.as_ref();
        if path.is_dir() {
            let source = Source::Folder(FolderLog::open(path, options)?);
            let poses = match &options.poses {
                Some(file) => PoseFile::open(file, Units::CORRECTED)?,
                None => folder::odometry(path)?,
            };
            return Ok(Self::new(source, Some(poses), options));
        }
        Self::of_lines(Lines::open(path)?, options)
    }

    /// The frames of a CARMEN log in `input`; `path` names it in errors.
    ///
    /// # Errors
    /// If its beginning, or the file of poses, cannot be read.
    pub fn carmen(
        path: impl AsRef<Path>,
        input: impl Read + Send + 'static,
        options: &LogOptions,
    ) -> Result<Self, LogError> {
        Self::of_lines(Lines::new(path.as_ref(), input)?, options)
    }

    fn of_lines(lines: Lines, options: &LogOptions) -> Result<Self, LogError> {
        let source = Source::Carmen(Box::new(CarmenLog::new(lines, options)));
        let file = options.poses.as_deref();
        let poses = file.map(|file| PoseFile::open(file, Units::CORRECTED)).transpose()?;
        Ok(Self::new(source, poses, options))
    }

    /// The frames of a folder whose files were opened.
    #[cfg(test)]
    pub(super) fn of_files(frames: Lines, poses: PoseFile, options: &LogOptions) -> Self {
        Self::new(Source::Folder(FolderLog::new(frames, options)), Some(poses), options)
    }

    fn new(source: Source, poses: Option<PoseFile>, options: &LogOptions) -> Self {
        let wanted = match (&source, options.sensor) {
            (Source::Carmen(_), Sensor::Sonar) => "line SONAR",
            (Source::Carmen(_), Sensor::Laser) => "line FLASER or ROBOTLASER1",
            (Source::Folder(_), _) => "line",
        };
        Self { source, poses, skipped: Skipped::default(), wanted, frames: 0, ended: false }
    }

    /// What was passed over so far, and why.
    pub fn skipped(&self) -> &Skipped {
        &self.skipped
    }

    fn path(&self) -> &Path {
        match &self.source {
            Source::Carmen(log) => log.path(),
            Source::Folder(log) => log.path(),
        }
    }

    fn measured(&mut self) -> Result<Option<Measured>, LogError> {
        match &mut self.source {
            Source::Carmen(log) => log.next(&mut self.skipped),
            Source::Folder(log) => log.next(&mut self.skipped),
        }
    }

    fn advance(&mut self) -> Result<Option<LogFrame>, LogError> {
        while let Some(measured) = self.measured()? {
            let Measured { line, time, ring, ranges, pose } = measured;
            let pose = match &mut self.poses {
                Some(poses) => poses.at(time, &mut self.skipped)?,
                None => pose,
            };
            if let Some(pose) = pose {
                self.frames += 1;
                return Ok(Some(LogFrame { scan: Scan { pose, time, ranges }, ring, line }));
            }
            let damage = Damage::new(SkipReason::NoPose, format!("there is no pose at {time} s"));
            let path = self.path().to_owned();
            self.skipped.add(&path, line, damage);
        }
        if self.frames > 0 {
            return Ok(None);
        }
        let skipped = Box::new(self.skipped.clone());
        Err(LogError::NoScans { path: self.path().to_owned(), wanted: self.wanted, skipped })
    }
}

impl Iterator for LogReader {
    type Item = Result<LogFrame, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let next = self.advance().transpose();
        self.ended = !matches!(next, Some(Ok(_)));
        next
    }
}

impl fmt::Debug for LogReader {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { skipped, frames, ended, .. } = self;
        f.debug_struct("LogReader")
            .field("path", &self.path())
            .field("frames", frames)
            .field("skipped", skipped)
            .field("ended", ended)
            .finish_non_exhaustive()
    }
}
