//! The frames of a bag of ROS 2, with their poses.

use super::bag_survey::{BagSurvey, SensorName, as_transform, decimal};
use super::device::{Device, Measured, laser_beams};
use super::skipped::Damage;
use super::track::{Fix, Stamp};
use super::way::Way;
use super::{Account, LogError, LogOptions, Passed, Sensor, SkipReason, lines};
use covmap_bag::messages::{self, LaserScan, Odometry, RangeMessage, RosMessage, TfMessage};
use covmap_bag::planar::in_plane;
use covmap_bag::{BagMessage, BagReader, TransformError, Transforms, is_static};
use covmap_sonar::{Beam, Range};
use nalgebra::Isometry2;
use std::collections::{BTreeMap, VecDeque};
use std::path::{Path, PathBuf};

/// Ranges of different sensors within this time are one scan \[ns\].
const TOGETHER: i64 = 100_000_000;
/// A transform may come this much later than what it places \[ns\].
const LATEST: i64 = 2_500_000_000;
/// A clock that goes back by more than this starts anew \[ns\].
const ANEW: i64 = 5_000_000_000;
/// The largest number of scans and poses that wait for transforms.
const MOST_WAITING: usize = 16_384;

/// What waits for the transforms around its time.
enum Waiting {
    Scan(Box<Measured>),
    /// The robot moved.
    Step,
}

/// A scan of sensors that report one by one.
struct Gathered {
    stamp: messages::Stamp,
    line: usize,
    ranges: BTreeMap<SensorName, f32>,
}

/// The identity of a laser: its rays, and the bits of its first angle and of its steps.
type Laser = (usize, u32, u32);

/// The frames of a bag.
pub(super) struct BagLog {
    path: PathBuf,
    reader: BagReader,
    survey: BagSurvey,
    sensor: Sensor,
    transforms: Transforms,
    sonar: Device<()>,
    lasers: BTreeMap<SensorName, Device<Laser>>,
    gathered: Option<Gathered>,
    /// What waits, with its time \[ns\], in the order of time.
    waiting: VecDeque<(i64, Waiting)>,
    newest: i64,
    way: Way,
    steps: usize,
    doubled: usize,
    ended: bool,
}

impl BagLog {
    pub(super) fn open(path: &Path, options: &LogOptions) -> Result<Self, LogError> {
        let survey = BagSurvey::read(path, options)?;
        Ok(Self {
            path: path.to_owned(),
            reader: BagReader::new(path, lines::open(path)?),
            survey,
            sensor: options.sensor,
            transforms: Transforms::default(),
            sonar: Device::new(),
            lasers: BTreeMap::new(),
            gathered: None,
            waiting: VecDeque::new(),
            newest: i64::MIN,
            way: Way::default(),
            steps: 0,
            doubled: 0,
            ended: false,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the poses that the robot passed after the last frame.
    pub(super) fn rest(&mut self) -> Vec<Passed> {
        self.way.rest()
    }

    /// Returns the next frame that has a pose.
    pub(super) fn next(&mut self, account: &mut Account) -> Result<Option<Measured>, LogError> {
        loop {
            if let Some(frame) = self.pop(account) {
                return Ok(Some(frame));
            }
            if self.ended {
                return Ok(None);
            }
            match self.reader.next().transpose()? {
                Some(message) => self.take(&message, account),
                None => self.end(account),
            }
        }
    }

    fn end(&mut self, account: &mut Account) {
        self.ended = true;
        self.close(account);
        let BagSurvey { map_frame, base_frame, odometry, notes, .. } = &self.survey;
        let source = if odometry.is_empty() { "/tf".to_owned() } else { odometry.join(", ") };
        account.poses = format!("{source}, {base_frame} in {map_frame}");
        account.notes.clone_from(notes);
        if self.doubled > 0 {
            let doubled = self.doubled;
            account.notes.push(format!("{doubled} readings were recorded twice, and count once"));
        }
    }

    fn take(&mut self, message: &BagMessage, account: &mut Account) {
        let line = self.reader.messages();
        if message.is::<TfMessage>() {
            match TfMessage::from_cdr(&message.data) {
                Ok(tf) => {
                    let fixed = is_static(&message.topic);
                    tf.transforms.iter().for_each(|t| self.moved(t, fixed, account));
                }
                Err(error) => self.lost_pose(line, &error.to_string(), account),
            }
        } else if message.is::<Odometry>() && self.survey.odometry.contains(&message.topic) {
            match Odometry::from_cdr(&message.data) {
                Ok(odometry) => self.moved(&as_transform(&odometry), false, account),
                Err(error) => self.lost_pose(line, &error.to_string(), account),
            }
        } else if self.survey.reads(&message.topic) {
            let done = match self.sensor {
                Sensor::Sonar if message.is::<RangeMessage>() => {
                    RangeMessage::from_cdr(&message.data)
                        .map(|range| self.gather(&message.topic, &range, account))
                }
                Sensor::Laser if message.is::<LaserScan>() => LaserScan::from_cdr(&message.data)
                    .map(|scan| self.laser(&message.topic, &scan, account)),
                Sensor::Sonar | Sensor::Laser => Ok(()),
            };
            if let Err(error) = done {
                self.unreadable(line, &error.to_string(), account);
            }
        }
    }

    fn unreadable(&self, line: usize, fault: &str, account: &mut Account) {
        account.skipped.add_frame();
        account.skipped.add(&self.path, line, Damage::new(SkipReason::Unreadable, fault));
    }

    fn lost_pose(&self, line: usize, fault: &str, account: &mut Account) {
        let damage = Damage::new(SkipReason::Unreadable, fault);
        account.skipped.add_pose(&self.path, line, &damage);
    }

    /// Takes over a transform.
    fn moved(
        &mut self,
        transform: &messages::TransformStamped,
        is_static: bool,
        account: &mut Account,
    ) {
        let time = transform.header.stamp.nanos();
        if !is_static && transform.child_frame_id == self.survey.moving {
            if time < self.newest.saturating_sub(ANEW) {
                self.start_anew(account);
            }
            self.newest = self.newest.max(time);
            self.wait(time, Waiting::Step);
        }
        if !self.transforms.add(transform, is_static) {
            let fault = format!("the transform of `{}` is no motion", transform.child_frame_id);
            self.lost_pose(self.reader.messages(), &fault, account);
        }
    }

    fn start_anew(&mut self, account: &mut Account) {
        account.restarts += 1;
        self.close(account);
        while let Some((_, waiting)) = self.waiting.pop_front() {
            if let Waiting::Scan(frame) = waiting {
                let fault = "the clock starts anew before there is a pose";
                frame.skip(&self.path, Damage::new(SkipReason::NoPose, fault), account);
            }
        }
        self.transforms.start_anew();
        self.newest = i64::MIN;
    }

    /// Takes over one range, as a part of a scan.
    fn gather(&mut self, topic: &str, message: &RangeMessage, account: &mut Account) {
        let name = (topic.to_owned(), message.header.frame_id.clone());
        let stamp = message.header.stamp;
        if !self.survey.beams.contains_key(&name) {
            return;
        }
        if let Some(scan) = &self.gathered {
            let is_in_it = scan.ranges.contains_key(&name);
            if is_in_it && scan.stamp == stamp {
                self.doubled += 1;
                return;
            }
            if is_in_it || (stamp.nanos() - scan.stamp.nanos()).abs() > TOGETHER {
                self.close(account);
            }
        }
        let line = self.reader.messages();
        let fresh = || Gathered { stamp, line, ranges: BTreeMap::new() };
        self.gathered.get_or_insert_with(fresh).ranges.insert(name, message.range);
    }

    /// Ends the scan that is being gathered.
    fn close(&mut self, account: &mut Account) {
        let Some(Gathered { stamp, line, ranges }) = self.gathered.take() else { return };
        account.skipped.add_frame();
        let survey = &self.survey;
        let value = |name| ranges.get(name).copied().unwrap_or(f32::NEG_INFINITY);
        let values: Vec<f32> = survey.beams.keys().map(value).collect();
        let ring = self.sonar.ring((), (0.0, 0.0), (account, RangeMessage::TYPE), |(), told| {
            for name in survey.beams.keys() {
                told.take(survey.place(name), "/tf_static");
            }
            Ok(survey.beams.values().copied().collect())
        });
        self.measured((stamp, line), ring, &values, account);
    }

    fn laser(&mut self, topic: &str, scan: &LaserScan, account: &mut Account) {
        account.skipped.add_frame();
        let name = (topic.to_owned(), scan.header.frame_id.clone());
        let Some(mount) = self.survey.mounts.get(&name).copied() else { return };
        let identity =
            (scan.ranges.len(), scan.angle_min.to_bits(), scan.angle_increment.to_bits());
        let limits = (decimal(scan.range_min), decimal(scan.range_max));
        let place = self.survey.place(&name);
        let device = self.lasers.entry(name).or_insert_with(Device::new);
        let ring = device.ring(identity, limits, (account, LaserScan::TYPE), |_, told| {
            told.take(place, "/tf_static");
            let angles = (decimal(scan.angle_min), decimal(scan.angle_increment));
            Ok(laser_beams(&mount, scan.ranges.len(), angles, limits))
        });
        let line = self.reader.messages();
        self.measured((scan.header.stamp, line), ring, &scan.ranges, account);
    }

    /// Lets a scan wait for its pose.
    fn measured(
        &mut self,
        (stamp, line): (messages::Stamp, usize),
        ring: Result<(usize, std::sync::Arc<covmap_sonar::SonarRing>), Damage>,
        values: &[f32],
        account: &mut Account,
    ) {
        let (sensor, ring) = match ring {
            Ok(ring) => ring,
            Err(damage) => return account.skipped.add(&self.path, line, damage),
        };
        let wrong = |range: &f32| range.is_nan() || (range.is_finite() && *range < 0.0);
        let unusable = values.iter().enumerate().filter(|(_, v)| wrong(v)).map(|(i, _)| i);
        let unusable: Vec<usize> = unusable.collect();
        account.skipped.add_readings(&self.path, line, unusable.len());
        let ranges = values.iter().zip(ring.beams()).map(|(v, beam)| reading(*v, beam)).collect();
        let time = stamp.nanos();
        let stamp = Stamp { time: stamp.seconds(), logger: None };
        let (tied, pose, way) = (false, None, Vec::new());
        let frame = Measured { line, stamp, sensor, ring, ranges, unusable, tied, pose, way };
        self.newest = self.newest.max(time);
        self.wait(time, Waiting::Scan(Box::new(frame)));
    }

    fn wait(&mut self, time: i64, waiting: Waiting) {
        let later = self.waiting.iter().rev().take_while(|(other, _)| *other > time).count();
        self.waiting.insert(self.waiting.len() - later, (time, waiting));
    }

    /// Returns the first scan that waits, if its pose is known.
    fn pop(&mut self, account: &mut Account) -> Option<Measured> {
        loop {
            let (time, _) = self.waiting.front()?;
            let time = *time;
            let found = self.pose(time);
            let may_come =
                matches!(found, Err(TransformError::TooLate { .. } | TransformError::Unknown(_)))
                    && !self.ended
                    && self.newest.saturating_sub(time) <= LATEST
                    && self.waiting.len() <= MOST_WAITING;
            if may_come {
                return None;
            }
            let (_, waiting) = self.waiting.pop_front()?;
            match (waiting, found) {
                (Waiting::Step, Ok(pose)) => {
                    let stamp = Stamp { time: seconds(time), logger: None };
                    self.way.push(self.steps, &Fix { stamp, line: 0, pose });
                    self.steps += 1;
                }
                (Waiting::Step, Err(_)) => {}
                (Waiting::Scan(mut frame), Ok(pose)) => {
                    frame.pose = Some(pose);
                    frame.way = self.way.to(self.steps, frame.stamp, pose);
                    return Some(*frame);
                }
                (Waiting::Scan(frame), Err(error)) => {
                    let damage = Damage::new(SkipReason::NoPose, error.to_string());
                    frame.skip(&self.path, damage, account);
                }
            }
        }
    }

    fn pose(&self, time: i64) -> Result<Isometry2<f64>, TransformError> {
        let BagSurvey { map_frame, base_frame, .. } = &self.survey;
        let place =
            self.transforms.lookup(map_frame, base_frame, messages::Stamp::from_nanos(time))?;
        Ok(in_plane(&place))
    }
}

fn seconds(nanos: i64) -> f64 {
    messages::Stamp::from_nanos(nanos).seconds()
}

/// Returns a range as a reading: +∞ and the longest range are no echo; −∞, NaN and ranges below the
/// shortest are missing (REP 117).
fn reading(value: f32, beam: &Beam) -> Range {
    let range = decimal(value);
    if range >= beam.max_range {
        Range::NoEcho
    } else if range > 0.0 && range >= beam.min_range {
        Range::Echo(range)
    } else {
        Range::Missing
    }
}
