//! The reader of logs of any kind.

use super::bag_log::BagLog;
use super::carmen::CarmenLog;
use super::device::Measured;
use super::folder::{self, FolderLog};
use super::lines::Lines;
use super::poses::{PoseFile, Units};
use super::skipped::Damage;
use super::way::Way;
use super::{Account, LogError, LogOptions, Passed, Sensor, SkipReason, Skipped, foreign, lines};
use covmap_io::{Signature, signature};
use covmap_sonar::{Scan, SonarRing};
use std::fmt;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// A scan of a log, with the ring that measured it.
#[derive(Debug, Clone, PartialEq)]
pub struct LogFrame {
    /// The scan. Its pose is the robot's, even if the ring is a laser on the robot.
    pub scan: Scan,
    /// The ring. All frames of a log share one, unless the log has several lasers, or its stated
    /// ranges change.
    pub ring: Arc<SonarRing>,
    /// The poses that the odometry passed since the frame before; the last is the robot's pose by
    /// odometry at the scan.
    pub way: Vec<Passed>,
    /// The line of the log with the scan, counted from 1.
    pub line: usize,
}

enum Source {
    Carmen(Box<CarmenLog>),
    Folder(Box<FolderLog>),
    Bag(Box<BagLog>),
}

/// The frames of a log, one after the other, in the order of its lines.
///
/// The reader passes over a wrong frame and counts it, [`LogReader::skipped`]. An error is the end:
/// nothing comes after it. A log without one good frame ends with [`LogError::NoScans`].
///
/// A log is one of
///
/// - a text log of CARMEN, with lines `PARAM`, `ODOM`, `TRUEPOS`, `SONAR`, and those of
///   [`Sensor::Laser`]. The reader passes over other lines, and over comments after `#`. The log
///   may be packed with gzip, whatever its name. `SONAR` and `RAWLASER` have no pose; it is
///   interpolated between the two `ODOM` around their time, if these are no more than 2 s apart. If
///   times are too coarse to tell lines apart, the order of lines and the logger's time place a
///   frame. A clock may start anew; a line for which the clock leapt is passed over. If `TRUEPOS`
///   is (nearly) as frequent as `ODOM`, it has all poses;
/// - a folder with `od.txt` (`t x y theta`: ms, mm, mm, 1/10°), `sonar.txt` (`t s0 s1 …`: ms, mm)
///   and `laser.txt` (`t r0 … r360`: ms, mm, from −90° counter-clockwise in steps of ½°, by a laser
///   0.12 m before the robot's centre).
///
/// - a bag of ROS 2, an MCAP file: [`BagOptions`](super::BagOptions) says what is read of it.
///
/// A range of at least the sensor's longest is `NoEcho`, also if the longest is rounded to, or cut
/// at, the decimal places of the range. A range below the sensor's shortest, 0, a negative one and
/// NaN are `Missing`. The longest range is the one that the log states; of several, the smallest.
///
/// ```no_run
/// use covmap_log::{BagOptions, LogOptions, LogReader, Sensor};
/// use covmap_sonar::SonarRing;
///
/// let (sensor, ring, bag) = (Sensor::Sonar, SonarRing::b21r(), BagOptions::default());
/// let options = LogOptions { sensor, ring, poses: None, bag };
/// let mut log = LogReader::open("corridor.log.gz", &options)?;
/// for frame in &mut log {
///     let frame = frame?;
///     println!("{} s: {:?}", frame.scan.time, frame.scan.ranges);
/// }
/// println!("{}", log.skipped());
/// # Ok::<(), covmap_log::LogError>(())
/// ```
pub struct LogReader {
    source: Source,
    poses: Option<PoseFile>,
    /// Whether line i of the poses is frame i.
    in_step: bool,
    way: Way,
    place: usize,
    account: Account,
    wanted: &'static str,
    frames: usize,
    ended: bool,
}

impl LogReader {
    /// Opens a CARMEN log, or a folder of files.
    ///
    /// # Errors
    /// If a file is missing or cannot be read.
    pub fn open(path: impl AsRef<Path>, options: &LogOptions) -> Result<Self, LogError> {
        let path = path.as_ref();
        if path.is_dir() {
            let source = Source::Folder(Box::new(FolderLog::open(path, options)?));
            let poses = match &options.poses {
                Some(file) => PoseFile::open(file, Units::CORRECTED)?,
                None => folder::odometry(path)?,
            };
            let in_step = options.poses.is_none();
            return Ok(Self { in_step, ..Self::new(source, Some(poses), options) });
        }
        if is_bag(path)? {
            let file = options.poses.as_deref();
            let poses = file.map(|file| PoseFile::open(file, Units::CORRECTED)).transpose()?;
            let source = Source::Bag(Box::new(BagLog::open(path, options)?));
            return Ok(Self::new(source, poses, options));
        }
        Self::of_lines(Lines::open(path)?, options)
    }

    /// Reads a CARMEN log from `input`; errors name it by `path`.
    ///
    /// # Errors
    /// If the log's beginning, or the file of poses, cannot be read.
    pub fn carmen(
        path: impl AsRef<Path>,
        input: impl Read + Send + 'static,
        options: &LogOptions,
    ) -> Result<Self, LogError> {
        Self::of_lines(Lines::new(path.as_ref(), input)?, options)
    }

    fn of_lines(lines: Lines, options: &LogOptions) -> Result<Self, LogError> {
        if let Some(kind) = foreign::named(lines.path(), lines.head()) {
            return Err(LogError::Foreign { path: lines.path().to_owned(), kind });
        }
        let source = Source::Carmen(Box::new(CarmenLog::new(lines, options)));
        let file = options.poses.as_deref();
        let poses = file.map(|file| PoseFile::open(file, Units::CORRECTED)).transpose()?;
        Ok(Self::new(source, poses, options))
    }

    /// Reads a folder whose files are open.
    #[cfg(test)]
    pub(super) fn of_files(frames: Lines, poses: PoseFile, options: &LogOptions) -> Self {
        let source = Source::Folder(Box::new(FolderLog::new(frames, options)));
        Self { in_step: true, ..Self::new(source, Some(poses), options) }
    }

    fn new(source: Source, poses: Option<PoseFile>, options: &LogOptions) -> Self {
        let wanted = match (&source, options.sensor) {
            (Source::Carmen(_), Sensor::Sonar) => "line SONAR",
            (Source::Carmen(_), Sensor::Laser) => "line FLASER, ROBOTLASER or RAWLASER",
            (Source::Folder(_), _) => "line",
            (Source::Bag(_), _) => "message",
        };
        let (in_step, way, place, account) = (false, Way::default(), 0, Account::default());
        let (frames, ended) = (0, false);
        Self { source, poses, in_step, way, place, account, wanted, frames, ended }
    }

    /// Returns the frames passed over so far, with the reasons.
    pub fn skipped(&self) -> &Skipped {
        &self.account.skipped
    }

    /// Returns the account of the log so far: its contents, and the sources of its numbers.
    pub fn account(&self) -> &Account {
        &self.account
    }

    /// Returns the poses that the odometry of a CARMEN log passed after its last frame.
    pub fn rest(&mut self) -> Vec<Passed> {
        match &mut self.source {
            Source::Carmen(log) => log.rest(),
            Source::Folder(_) => Vec::new(),
            Source::Bag(log) => log.rest(),
        }
    }

    fn path(&self) -> &Path {
        match &self.source {
            Source::Carmen(log) => log.path(),
            Source::Folder(log) => log.path(),
            Source::Bag(log) => log.path(),
        }
    }

    fn measured(&mut self) -> Result<Option<Measured>, LogError> {
        match &mut self.source {
            Source::Carmen(log) => log.next(&mut self.account),
            Source::Folder(log) => log.next(&mut self.account),
            Source::Bag(log) => log.next(&mut self.account),
        }
    }

    /// Finds the pose of a frame in the file of poses.
    fn find_pose(&mut self, frame: &mut Measured) -> Result<(), LogError> {
        let Some(poses) = &mut self.poses else { return Ok(()) };
        if self.account.poses.is_empty() || self.frames == 0 {
            poses.read(&mut self.account.skipped)?;
            self.account.poses = poses.path().display().to_string();
            self.account.restarts = poses.restarts();
        }
        let coarse = match &self.source {
            Source::Folder(log) if self.in_step => {
                frame.tied || log.is_coarse() || poses.is_coarse()
            }
            Source::Folder(_) | Source::Carmen(_) | Source::Bag(_) => false,
        };
        let in_line = if coarse { poses.at_line(frame.line) } else { None };
        let Some((pose, place)) = in_line.or_else(|| poses.at(frame.stamp.time)) else {
            return Ok(());
        };
        self.account.placed_by_order += usize::from(in_line.is_some());
        // Fixes long before the first frame are not part of the log.
        let first = if self.frames == 0 { place } else { self.place };
        for (i, fix) in poses.part(first, place).iter().enumerate() {
            self.way.push(first + i, fix);
        }
        self.place = place;
        frame.pose = Some(pose);
        frame.way = self.way.to(place, frame.stamp, pose);
        Ok(())
    }

    fn advance(&mut self) -> Result<Option<LogFrame>, LogError> {
        while let Some(mut measured) = self.measured()? {
            self.find_pose(&mut measured)?;
            let time = measured.stamp.time;
            let Some(pose) = measured.pose else {
                let fault = format!("there is no pose at {time} s");
                let path = self.path().to_owned();
                measured.skip(&path, Damage::new(SkipReason::NoPose, fault), &mut self.account);
                continue;
            };
            let Measured { line, sensor, ring, ranges, unusable, way, .. } = measured;
            self.account.sensors[sensor].count(&ranges, &unusable);
            self.frames += 1;
            return Ok(Some(LogFrame { scan: Scan { pose, time, ranges }, ring, way, line }));
        }
        if self.frames > 0 {
            return Ok(None);
        }
        let (path, wanted) = (self.path().to_owned(), self.wanted);
        let others = match &self.source {
            Source::Carmen(log) => log.unwanted(),
            Source::Folder(_) | Source::Bag(_) => Vec::new(),
        };
        let skipped = Box::new(self.account.skipped.clone());
        Err(LogError::NoScans { path, wanted, others, skipped })
    }
}

/// Whether a file is a bag, by its beginning.
fn is_bag(path: &Path) -> Result<bool, LogError> {
    let mut head = Vec::new();
    let read = lines::open(path)?.take(16).read_to_end(&mut head);
    read.map_err(|source| LogError::Io { path: path.to_owned(), source })?;
    Ok(signature(&head) == Some(Signature::Mcap))
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
        let Self { account, frames, ended, .. } = self;
        f.debug_struct("LogReader")
            .field("path", &self.path())
            .field("frames", frames)
            .field("account", account)
            .field("ended", ended)
            .finish_non_exhaustive()
    }
}
