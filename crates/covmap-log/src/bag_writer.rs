//! Writing a bag of ROS 2.

use covmap_bag::messages::{
    Header, Odometry, RangeMessage, RosMessage, Stamp, TfMessage, Transform, TransformStamped,
};
use covmap_bag::planar::planar;
use covmap_bag::{BagError, BagWriter};
use covmap_sonar::{Beam, Range, Scan, SonarRing};
use nalgebra::Isometry2;
use std::io::Write;

/// The frames of a bag that covmap writes.
pub const FRAMES: [&str; 3] = ["map", "odom", "base_link"];
/// Time between two scans, or two places, that would have the same time \[ns\].
const NEXT: i64 = 1000;
/// The largest number of sensors that have a topic each.
const MOST_TOPICS: usize = 128;

/// Why a bag cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BagWriterError {
    /// The bag refused.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// There are too many sensors for a topic each.
    #[error(
        "{0} sensors: a bag has a topic for each of at most {MOST_TOPICS}; lasers are not written"
    )]
    Sensors(usize),
    /// The scan comes from another ring.
    #[error("scan {scan} has {ranges} ranges, but the ring has {sensors} sensors")]
    Count {
        /// The scan, counted from 0.
        scan: usize,
        /// The number of readings in the scan.
        ranges: usize,
        /// The number of sensors in the ring.
        sensors: usize,
    },
}

/// Writes scans of a ring of sonars as a bag of ROS 2.
///
/// - `/sonar_00`, `/sonar_01`, …: each sensor's readings as `sensor_msgs/msg/Range`, all of a scan with one
///   stamp. No echo is +∞, a missing reading is −∞ (REP 117).
/// - `/tf` and `/odom`: where the robot was at each scan and in between, `base_link` in `odom`.
/// - `/tf_static`: `odom` in `map`, which is the same, and each sensor on `base_link`.
///
/// A [`LogReader`](super::LogReader) reads the same scans from it: positions to the last bit, headings up to
/// rounding, ranges to the last bit if they have at most six digits, else to single precision, times to the
/// microsecond.
#[derive(Debug)]
pub struct RosBagWriter<'a, W: Write> {
    ring: &'a SonarRing,
    bag: BagWriter<W>,
    scans: usize,
    /// The last stamp, with the pose there.
    last: Option<(Stamp, Isometry2<f64>)>,
    last_scan: Option<Stamp>,
}

impl<'a, W: Write> RosBagWriter<'a, W> {
    /// Begins a bag.
    ///
    /// # Errors
    /// If there are too many sensors, or the bag cannot be written.
    pub fn new(ring: &'a SonarRing, out: W) -> Result<Self, BagWriterError> {
        let sensors = ring.beams().len();
        if sensors > MOST_TOPICS {
            return Err(BagWriterError::Sensors(sensors));
        }
        Ok(Self { ring, bag: BagWriter::new(out)?, scans: 0, last: None, last_scan: None })
    }

    /// Writes that the robot passes a pose between two scans, at this time \[s\].
    ///
    /// # Errors
    /// If the bag cannot be written.
    pub fn pass(&mut self, time: f64, pose: &Isometry2<f64>) -> Result<Stamp, BagWriterError> {
        let stamp = self.stamp(time, pose);
        self.place(stamp, pose)
    }

    fn place(&mut self, stamp: Stamp, pose: &Isometry2<f64>) -> Result<Stamp, BagWriterError> {
        if self.last.is_none() {
            self.begin(stamp)?;
        }
        self.last = Some((stamp, *pose));
        let [_, odom, base] = FRAMES;
        let header = Header { stamp, frame_id: odom.to_owned() };
        let transform = placed(header.clone(), base, planar(pose));
        self.bag.write("/tf", stamp, &TfMessage { transforms: vec![transform.clone()] })?;
        let Transform { translation, rotation } = transform.transform;
        let odometry = Odometry {
            header,
            child_frame_id: base.to_owned(),
            pose: Transform { translation, rotation },
            twist: [0.0; 6],
        };
        self.bag.write("/odom", stamp, &odometry)?;
        Ok(stamp)
    }

    /// Writes a scan, and where the robot was; returns its stamp.
    ///
    /// # Errors
    /// If the scan does not have one reading for each sensor, or the bag cannot be written.
    pub fn write(&mut self, scan: &Scan) -> Result<Stamp, BagWriterError> {
        let (sensors, ranges) = (self.ring.beams().len(), scan.ranges.len());
        if sensors != ranges {
            return Err(BagWriterError::Count { scan: self.scans, ranges, sensors });
        }
        let mut stamp = self.stamp(scan.time, &scan.pose);
        if self.last_scan == Some(stamp) {
            stamp = after(stamp);
        }
        self.place(stamp, &scan.pose)?;
        self.last_scan = Some(stamp);
        for (sensor, (beam, range)) in self.ring.beams().iter().zip(&scan.ranges).enumerate() {
            let header = Header { stamp, frame_id: frame_of(sensor) };
            self.bag.write(&topic_of(sensor), stamp, &message(header, beam, range))?;
        }
        self.scans += 1;
        Ok(stamp)
    }

    /// Writes any other message at this time.
    ///
    /// # Errors
    /// If the bag cannot be written.
    pub fn add<M: RosMessage>(
        &mut self,
        topic: &str,
        stamp: Stamp,
        message: &M,
    ) -> Result<(), BagWriterError> {
        Ok(self.bag.write(topic, stamp, message)?)
    }

    /// Ends the bag; returns the number of scans.
    ///
    /// # Errors
    /// If the bag cannot be written.
    pub fn finish(self) -> Result<usize, BagWriterError> {
        self.bag.finish()?;
        Ok(self.scans)
    }

    /// Writes what holds for all times.
    fn begin(&mut self, stamp: Stamp) -> Result<(), BagWriterError> {
        let [map, odom, base] = FRAMES;
        let in_frame = |frame: &str| Header { stamp, frame_id: frame.to_owned() };
        let mut transforms = vec![placed(in_frame(map), odom, Transform::default())];
        for (sensor, beam) in self.ring.beams().iter().enumerate() {
            transforms.push(placed(in_frame(base), &frame_of(sensor), planar(&beam.pose)));
        }
        Ok(self.bag.write("/tf_static", stamp, &TfMessage { transforms })?)
    }

    /// Returns the stamp of a time \[s\]: later than the last one, unless the robot stands where it was.
    fn stamp(&self, time: f64, pose: &Isometry2<f64>) -> Stamp {
        let stamp = Stamp::from_seconds(time.max(0.0));
        match self.last {
            Some((last, at)) if at != *pose && stamp <= last => after(last),
            Some((last, _)) => stamp.max(last),
            None => stamp,
        }
    }
}

/// Returns the next stamp.
fn after(stamp: Stamp) -> Stamp {
    Stamp::from_nanos(stamp.nanos() + NEXT)
}

/// The frame of a sensor.
fn frame_of(sensor: usize) -> String {
    format!("sonar_{sensor:02}")
}

/// The topic of a sensor.
fn topic_of(sensor: usize) -> String {
    format!("/{}", frame_of(sensor))
}

fn placed(header: Header, child: &str, transform: Transform) -> TransformStamped {
    TransformStamped { header, child_frame_id: child.to_owned(), transform }
}

#[allow(clippy::cast_possible_truncation, reason = "messages have single precision")]
fn message(header: Header, beam: &Beam, range: &Range) -> RangeMessage {
    RangeMessage {
        header,
        radiation_type: 0,
        field_of_view: 2.0 * beam.half_angle as f32,
        min_range: beam.min_range as f32,
        max_range: beam.max_range as f32,
        range: match *range {
            Range::Echo(range) => range as f32,
            Range::NoEcho => f32::INFINITY,
            Range::Missing => f32::NEG_INFINITY,
        },
        variance: 0.0,
    }
}
