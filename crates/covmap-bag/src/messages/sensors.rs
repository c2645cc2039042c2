//! Range sensors.

use super::{Header, RosMessage};
use crate::{CdrError, CdrReader, CdrWriter};

/// `sensor_msgs/msg/Range`: one reading of a sonar, or of an infrared sensor.
///
/// A range of +∞ is no echo, −∞ is an echo that is too near (REP 117).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RangeMessage {
    /// Time, and the frame of the sensor, which looks along its x axis.
    pub header: Header,
    /// 0 for ultrasound, 1 for infrared.
    pub radiation_type: u8,
    /// The opening angle of the cone \[rad\].
    pub field_of_view: f32,
    /// The shortest range \[m\].
    pub min_range: f32,
    /// The longest range \[m\].
    pub max_range: f32,
    /// The range \[m\].
    pub range: f32,
    /// The variance of the range \[m²\]; 0 if it is not known, or the distribution does not have it.
    pub variance: f32,
}

impl RosMessage for RangeMessage {
    const TYPE: &'static str = "sensor_msgs/msg/Range";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self {
            header: Header::read(reader)?,
            radiation_type: reader.u8("radiation_type")?,
            field_of_view: reader.f32("field_of_view")?,
            min_range: reader.f32("min_range")?,
            max_range: reader.f32("max_range")?,
            range: reader.f32("range")?,
            variance: if reader.is_at_end() { 0.0 } else { reader.f32("variance")? },
        })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        writer.u8(self.radiation_type);
        let Self { field_of_view, min_range, max_range, range, variance, .. } = *self;
        writer.f32s(&[field_of_view, min_range, max_range, range, variance]);
    }
}

/// `sensor_msgs/msg/LaserScan`: the readings of a laser scanner, counter-clockwise.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LaserScan {
    /// Time of the first ray, and the frame of the scanner.
    pub header: Header,
    /// Angle of the first ray \[rad\].
    pub angle_min: f32,
    /// Angle of the last ray \[rad\].
    pub angle_max: f32,
    /// Angle between two rays \[rad\].
    pub angle_increment: f32,
    /// Time between two rays \[s\].
    pub time_increment: f32,
    /// Time between two scans \[s\].
    pub scan_time: f32,
    /// The shortest range \[m\].
    pub range_min: f32,
    /// The longest range \[m\].
    pub range_max: f32,
    /// The ranges \[m\].
    pub ranges: Vec<f32>,
    /// The strength of each echo, in the device's own unit, if it is known.
    pub intensities: Vec<f32>,
}

impl RosMessage for LaserScan {
    const TYPE: &'static str = "sensor_msgs/msg/LaserScan";

    fn read(reader: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self {
            header: Header::read(reader)?,
            angle_min: reader.f32("angle_min")?,
            angle_max: reader.f32("angle_max")?,
            angle_increment: reader.f32("angle_increment")?,
            time_increment: reader.f32("time_increment")?,
            scan_time: reader.f32("scan_time")?,
            range_min: reader.f32("range_min")?,
            range_max: reader.f32("range_max")?,
            ranges: reader.list("ranges", 4, |r| r.f32("ranges"))?,
            intensities: reader.list("intensities", 4, |r| r.f32("intensities"))?,
        })
    }

    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        let Self { angle_min, angle_max, angle_increment, time_increment, .. } = *self;
        writer.f32s(&[angle_min, angle_max, angle_increment, time_increment]);
        writer.f32s(&[self.scan_time, self.range_min, self.range_max]);
        writer.list(&self.ranges, |w, range| w.f32(*range));
        writer.list(&self.intensities, |w, intensity| w.f32(*intensity));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::Stamp;

    #[test]
    fn a_range_is_read_with_and_without_its_variance() {
        let header = Header { stamp: Stamp { sec: 3, nanosec: 4 }, frame_id: "sonar_0".into() };
        let message = RangeMessage {
            header,
            field_of_view: 0.4,
            min_range: 0.25,
            max_range: 5.0,
            range: 1.234,
            variance: 0.5,
            ..RangeMessage::default()
        };
        let cdr = message.to_cdr();
        // 4 of the encoding, 8 of the stamp, 12 of the frame, 1 and 3 to align, 5 × 4.
        assert_eq!(cdr.len(), 4 + 8 + 12 + 4 + 20);
        assert_eq!(RangeMessage::from_cdr(&cdr), Ok(message.clone()));
        let earlier = RangeMessage::from_cdr(&cdr[..cdr.len() - 4]).unwrap();
        assert_eq!(earlier, RangeMessage { variance: 0.0, ..message });
        let cut = RangeMessage::from_cdr(&cdr[..cdr.len() - 8]);
        assert_eq!(cut, Err(CdrError::End("range")));
    }

    #[test]
    fn a_laser_scan_is_read_as_it_is_written() {
        let scan = LaserScan {
            angle_min: -1.0,
            angle_increment: 0.5,
            ranges: vec![1.0, f32::INFINITY, 2.5],
            intensities: vec![7.0],
            ..LaserScan::default()
        };
        assert_eq!(LaserScan::from_cdr(&scan.to_cdr()), Ok(scan));
    }
}
