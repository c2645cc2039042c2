//! The messages of ROS 2 that covmap reads and writes.
//!
//! Fields have the names and the order of the definitions in [`schemas`](crate::schemas). Fields that a
//! distribution added at the end of a message may be missing when a message is read.

mod geometry;
mod map;
mod markers;
mod sensors;

pub use geometry::{Odometry, Path, Pose, PoseStamped, TfMessage, Transform, TransformStamped};
pub use map::{MapMetaData, OccupancyGrid};
pub use markers::{ColorRgba, Marker, MarkerAction, MarkerArray, MarkerShape};
pub use sensors::{LaserScan, RangeMessage};

use crate::{CdrError, CdrReader, CdrWriter};

/// A message with its type.
pub trait RosMessage: Sized {
    /// The name of the type, as `sensor_msgs/msg/Range`.
    const TYPE: &'static str;

    /// Reads the fields.
    ///
    /// # Errors
    /// If the message ends before a field that every distribution has.
    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError>;

    /// Writes the fields.
    fn write(&self, writer: &mut CdrWriter);

    /// Reads a whole message.
    ///
    /// # Errors
    /// If the encoding is not plain CDR, or the message ends early.
    fn from_cdr(message: &[u8]) -> Result<Self, CdrError> {
        Self::read(&mut CdrReader::new(message)?)
    }

    /// Returns the message in CDR.
    fn to_cdr(&self) -> Vec<u8> {
        let mut writer = CdrWriter::default();
        self.write(&mut writer);
        writer.finish()
    }
}

/// A time since an epoch of the robot's clock.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Stamp {
    /// Whole seconds \[s\].
    pub sec: i32,
    /// The rest \[ns\].
    pub nanosec: u32,
}

const NANO: f64 = 1e-9;
const PER_SECOND: i64 = 1_000_000_000;

impl Stamp {
    /// Returns a time in seconds as a stamp, to the nearest nanosecond; what a stamp cannot hold is cut.
    #[allow(clippy::cast_possible_truncation, reason = "in the range of an i64 after `clamp`")]
    pub fn from_seconds(seconds: f64) -> Self {
        let most = f64::from(i32::MAX);
        let seconds = if seconds.is_finite() { seconds.clamp(-most, most) } else { 0.0 };
        let whole = seconds.floor();
        Self::from_nanos(((seconds - whole) / NANO).round() as i64 + whole as i64 * PER_SECOND)
    }

    /// Returns the stamp of a time \[ns\]; what a stamp cannot hold is cut.
    pub fn from_nanos(nanos: i64) -> Self {
        let most = i64::from(i32::MAX) * PER_SECOND;
        let nanos = nanos.clamp(-most, most);
        Self {
            sec: i32::try_from(nanos.div_euclid(PER_SECOND)).unwrap_or(i32::MAX),
            nanosec: u32::try_from(nanos.rem_euclid(PER_SECOND)).unwrap_or(0),
        }
    }

    /// Returns the time \[ns\].
    pub fn nanos(self) -> i64 {
        i64::from(self.sec) * PER_SECOND + i64::from(self.nanosec)
    }

    /// Returns the time \[s\].
    pub fn seconds(self) -> f64 {
        f64::from(self.sec) + f64::from(self.nanosec) * NANO
    }
}

/// When and in which frame a message was made.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Header {
    /// The time.
    pub stamp: Stamp,
    /// The frame, such as `base_link`.
    pub frame_id: String,
}

impl Header {
    pub(crate) fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let stamp = Stamp { sec: reader.i32("stamp.sec")?, nanosec: reader.u32("stamp.nanosec")? };
        Ok(Self { stamp, frame_id: frame(&reader.string("frame_id")?) })
    }

    pub(crate) fn write(&self, writer: &mut CdrWriter) {
        writer.i32(self.stamp.sec);
        writer.u32(self.stamp.nanosec);
        writer.string(&self.frame_id);
    }
}

/// Returns the name of a frame without the slash with which ROS 1 began it.
pub(crate) fn frame(name: &str) -> String {
    name.strip_prefix('/').unwrap_or(name).to_owned()
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are exact")]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_is_the_nearest_nanosecond() {
        let stamp = Stamp::from_seconds(12.25);
        assert_eq!(stamp, Stamp { sec: 12, nanosec: 250_000_000 });
        assert_eq!((stamp.seconds(), stamp.nanos()), (12.25, 12_250_000_000));
        assert_eq!(Stamp::from_seconds(-0.25), Stamp { sec: -1, nanosec: 750_000_000 });
        assert_eq!(Stamp::from_seconds(0.999_999_999_9), Stamp { sec: 1, nanosec: 0 });
        assert_eq!(Stamp::from_seconds(f64::NAN), Stamp::default());
        assert_eq!(Stamp::from_seconds(1e300).sec, i32::MAX);
    }
}
