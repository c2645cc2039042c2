//! The first reading of a bag: its sensors, its frames, and what it lacks.

use super::device::short;
use super::{BagOptions, LogError, LogOptions, Sensor, lines};
use covmap_bag::messages::{LaserScan, Odometry, RangeMessage, RosMessage, TransformStamped};
use covmap_bag::planar::in_plane;
use covmap_bag::{BagInfo, BagMessage, BagReader, TransformError};
use covmap_sonar::Beam;
use nalgebra::{Isometry2, Vector3};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The largest number of sensors.
const MOST_SENSORS: usize = 4096;
/// A sensor looks up or down if its axis rises by more than this for a length of 1: by more than 30°.
const STEEPEST: f64 = 0.5;

/// A sensor: its topic and its frame.
pub(super) type SensorName = (String, String);

/// What is known of a bag before its frames are read.
pub(super) struct BagSurvey {
    /// The frame of the map.
    pub(super) map_frame: String,
    /// The frame of the robot.
    pub(super) base_frame: String,
    /// The topics of odometry that are read, since no transforms tell the same.
    pub(super) odometry: Vec<String>,
    /// The frame whose motion is the robot's.
    pub(super) moving: String,
    /// The place of each sensor on the robot, `robot_from_sensor`.
    pub(super) mounts: BTreeMap<SensorName, Isometry2<f64>>,
    /// The beam of each sensor of ranges.
    pub(super) beams: BTreeMap<SensorName, Beam>,
    /// What a user should know.
    pub(super) notes: Vec<String>,
}

/// The number with the fewest digits that a single-precision number stands for: 1.234, not
/// 1.2339999675750732.
pub(super) fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or_else(|_| f64::from(value))
}

/// The bag in the making.
#[derive(Default)]
struct Found {
    info: BagInfo,
    /// The first message of each sensor of ranges.
    ranges: BTreeMap<SensorName, RangeMessage>,
    lasers: BTreeSet<SensorName>,
    /// The first message of each topic of odometry.
    odometry: BTreeMap<String, Odometry>,
}

impl Found {
    fn add(&mut self, message: &BagMessage, options: &BagOptions) {
        self.info.add(message);
        let is_wanted = options.topics.is_empty() || options.topics.contains(&message.topic);
        let name = |frame: String| (message.topic.clone(), frame);
        if is_wanted && message.is::<RangeMessage>() && self.ranges.len() < MOST_SENSORS {
            if let Ok(range) = RangeMessage::from_cdr(&message.data) {
                self.ranges.entry(name(range.header.frame_id.clone())).or_insert(range);
            }
        } else if is_wanted && message.is::<LaserScan>() && self.lasers.len() < MOST_SENSORS {
            if let Ok(scan) = LaserScan::from_cdr(&message.data) {
                self.lasers.insert(name(scan.header.frame_id));
            }
        } else if message.is::<Odometry>()
            && !self.odometry.contains_key(&message.topic)
            && let Ok(odometry) = Odometry::from_cdr(&message.data)
        {
            self.odometry.insert(message.topic.clone(), odometry);
        }
    }

    /// Lets odometry tell of the frames of which no transform does; returns its topics.
    fn use_odometry(&mut self) -> Vec<String> {
        let transforms = &mut self.info.transforms;
        let untold =
            |(_, odometry): &(&String, &Odometry)| !transforms.has_parent(&odometry.child_frame_id);
        let used: Vec<_> = self.odometry.iter().filter(untold).collect();
        for (_, odometry) in &used {
            transforms.add(&as_transform(odometry), false);
        }
        used.into_iter().map(|(topic, _)| topic.clone()).collect()
    }

    fn sensors(&self, kind: Sensor) -> Vec<SensorName> {
        match kind {
            Sensor::Sonar => self.ranges.keys().cloned().collect(),
            Sensor::Laser => self.lasers.iter().cloned().collect(),
        }
    }
}

/// Returns the pose of odometry as a transform.
pub(super) fn as_transform(odometry: &Odometry) -> TransformStamped {
    TransformStamped {
        header: odometry.header.clone(),
        child_frame_id: odometry.child_frame_id.clone(),
        transform: odometry.pose,
    }
}

impl BagSurvey {
    /// Reads a bag once.
    pub(super) fn read(path: &Path, options: &LogOptions) -> Result<Self, LogError> {
        let (mut reader, mut found) = (BagReader::new(path, lines::open(path)?), Found::default());
        for message in &mut reader {
            found.add(&message?, &options.bag);
        }
        let odometry = found.use_odometry();
        let mut notes = Vec::new();
        if let Some(cut_off) = reader.cut_off() {
            notes.push(format!(
                "the bag is cut off or damaged after {} messages ({}); it was read up to there",
                cut_off.messages, cut_off.fault
            ));
        }
        let lacks = |what: String| LogError::BagLacks {
            path: path.to_owned(),
            what,
            topics: found.info.topics_in_words(),
        };
        let wanted = found.sensors(options.sensor);
        if wanted.is_empty() {
            let type_name = match options.sensor {
                Sensor::Sonar => RangeMessage::TYPE,
                Sensor::Laser => LaserScan::TYPE,
            };
            let of = match &options.bag.topics[..] {
                [] => String::new(),
                topics => format!(" of the topics {}", topics.join(", ")),
            };
            return Err(lacks(format!("no message of type {type_name}{of}")));
        }
        let base = options.bag.base_frame.clone();
        let transforms = &found.info.transforms;
        let Some(moving) = transforms.moving(&base).map(str::to_owned) else {
            let frames: Vec<&str> = transforms.frames().map(|(child, ..)| child).collect();
            return Err(lacks(format!(
                "no pose of the frame `{base}`: neither /tf nor nav_msgs/msg/Odometry tells where it is; frames with a \
                 place are {}; name another one with --base-frame",
                if frames.is_empty() { "none".to_owned() } else { frames.join(", ") }
            )));
        };
        let map_frame = match &options.bag.map_frame {
            Some(frame) => frame.clone(),
            None if transforms.is_below(&base, "map") => "map".to_owned(),
            None => transforms.root(&base).to_owned(),
        };
        if !transforms.is_below(&base, &map_frame) {
            return Err(lacks(format!(
                "no transforms that lead from `{map_frame}` to `{base}`; name another frame with --map-frame, such as `{}`",
                transforms.root(&base)
            )));
        }
        let mut mounts = BTreeMap::new();
        for name in wanted {
            match mount(&found.info, &base, &name.1) {
                Ok(mount) => drop(mounts.insert(name, mount)),
                Err(reason) => notes.push(format!("{} is left out: {reason}", name.0)),
            }
        }
        if mounts.is_empty() {
            return Err(lacks(format!(
                "no sensor with a known place on `{base}`: {}",
                notes.join("; ")
            )));
        }
        let beam = |(name, range): (&SensorName, &RangeMessage)| {
            let beam = Beam {
                pose: *mounts.get(name)?,
                half_angle: 0.5 * decimal(range.field_of_view),
                min_range: decimal(range.min_range),
                max_range: decimal(range.max_range),
            };
            Some((name.clone(), beam))
        };
        let beams = found.ranges.iter().filter_map(beam).collect();
        Ok(Self { map_frame, base_frame: base, odometry, moving, mounts, beams, notes })
    }

    /// Whether the sensors of a topic are read.
    pub(super) fn reads(&self, topic: &str) -> bool {
        let first = (topic.to_owned(), String::new());
        self.mounts.range(first..).next().is_some_and(|((known, _), _)| known == topic)
    }

    /// Returns the place of a sensor in words.
    pub(super) fn place(&self, name: &SensorName) -> String {
        let Some(mount) = self.mounts.get(name) else { return String::new() };
        let [x, y] = [mount.translation.x, mount.translation.y].map(short);
        format!("{} at ({x}, {y}) m, {}°", name.1, short(mount.rotation.angle().to_degrees()))
    }
}

fn mount(info: &BagInfo, base: &str, frame: &str) -> Result<Isometry2<f64>, String> {
    let mount =
        info.transforms.fixed(base, frame).map_err(|error: TransformError| error.to_string())?;
    let axis = mount.rotation * Vector3::x();
    if axis.z.abs() > STEEPEST {
        return Err(format!("`{frame}` looks up or down"));
    }
    Ok(in_plane(&mount))
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn a_single_precision_number_is_the_decimal_that_it_stands_for() {
        for millimetres in 0..20_000u16 {
            let metres = f64::from(millimetres) / 1e3;
            #[allow(clippy::cast_possible_truncation, reason = "what a bag does")]
            let read = decimal(metres as f32);
            assert!((read - metres).abs() <= 0.0, "{metres}: {read}");
        }
        assert!(decimal(f32::INFINITY).is_infinite() && decimal(f32::NAN).is_nan());
    }
}
