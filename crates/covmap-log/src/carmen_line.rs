//! The lines of a CARMEN log.

use super::SkipReason;
use super::fields::{Fields, Written};
use super::skipped::Damage;
use super::track::Stamp;
use nalgebra::Isometry2;

/// The tags of the lines that the reader uses.
pub(super) const TAGS: [&str; 13] = [
    "PARAM",
    "ODOM",
    "TRUEPOS",
    "SONAR",
    "FLASER",
    "RLASER",
    "ROBOTLASER1",
    "ROBOTLASER2",
    "RAWLASER1",
    "RAWLASER2",
    "RAWLASER3",
    "RAWLASER4",
    "RAWLASER5",
];

/// A line `SONAR`: the readings, and the places of the sensors in the frame of the robot.
pub(super) struct SonarLine {
    /// The whole opening angle of each cone \[rad\].
    pub(super) cone_angle: f64,
    pub(super) ranges: Vec<Written>,
    /// x, y \[m\] and theta \[rad\] of each sensor.
    pub(super) places: Vec<[f64; 3]>,
    pub(super) stamp: Stamp,
}

/// The description of a laser in its line; `FLASER` and `RLASER` have none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Described {
    /// The angle of the first beam \[rad\].
    pub(super) start: f64,
    /// The angle from the first beam to the last \[rad\].
    pub(super) field_of_view: f64,
    /// The angle between two beams \[rad\].
    pub(super) resolution: f64,
    /// The largest range \[m\].
    pub(super) max_range: f64,
}

/// A line of a laser.
pub(super) struct LaserLine {
    pub(super) described: Option<Described>,
    pub(super) ranges: Vec<Written>,
    /// `world_from_laser`, and `world_from_robot` by odometry; `RAWLASER` has none.
    pub(super) poses: Option<[Isometry2<f64>; 2]>,
    pub(super) stamp: Stamp,
}

/// Reads `ODOM x y theta tv rv accel ipc_timestamp host logger_timestamp`, or `TRUEPOS x y theta
/// odom_x odom_y odom_theta ipc_timestamp host logger_timestamp`.
pub(super) fn pose(fields: &mut Fields<'_>) -> Result<(Stamp, Isometry2<f64>), Damage> {
    let pose = fields.pose(["x", "y", "theta"], 1.0, 1.0)?;
    fields.skip(3);
    Ok((end(fields)?, pose))
}

/// Reads `SONAR cone_angle n r_1 … r_n (x y theta)·n ipc_timestamp host logger_timestamp`.
pub(super) fn sonar(fields: &mut Fields<'_>) -> Result<SonarLine, Damage> {
    let cone_angle = fields.number("cone_angle")?;
    let count = fields.count("number of ranges")?;
    expect_words(fields, count, count.saturating_mul(4))?;
    let ranges = fields.ranges(count, 1.0)?;
    let place = |i: usize, fields: &mut Fields<'_>| {
        let mut number = |what| fields.number(format_args!("{what} of sensor {i}"));
        Ok([number("x")?, number("y")?, number("theta")?])
    };
    let places = (0..count).map(|i| place(i, fields)).collect::<Result<_, Damage>>()?;
    Ok(SonarLine { cone_angle, ranges, places, stamp: end(fields)? })
}

/// Reads `FLASER n r_1 … r_n x y theta odom_x odom_y odom_theta ipc_timestamp host
/// logger_timestamp`.
pub(super) fn plain_laser(fields: &mut Fields<'_>) -> Result<LaserLine, Damage> {
    let count = fields.count("number of ranges")?;
    expect_words(fields, count, count.saturating_add(6))?;
    let ranges = fields.ranges(count, 1.0)?;
    let laser = fields.pose(["x", "y", "theta"], 1.0, 1.0)?;
    let robot = fields.pose(["odom_x", "odom_y", "odom_theta"], 1.0, 1.0)?;
    Ok(LaserLine { described: None, ranges, poses: Some([laser, robot]), stamp: end(fields)? })
}

/// Reads `ROBOTLASER1 type start fov resolution max accuracy remission_mode n r… m rem… laser_x
/// laser_y laser_theta robot_x robot_y robot_theta tv rv forward_safety side_safety turn_axis
/// ipc_timestamp host logger_timestamp`.
///
/// A line `RAWLASER1` has nothing between the remissions and the time.
pub(super) fn described_laser(fields: &mut Fields<'_>, raw: bool) -> Result<LaserLine, Damage> {
    fields.skip(1);
    let start = fields.number("start angle")?;
    let field_of_view = fields.number("field of view")?;
    let resolution = fields.number("angular resolution")?;
    let max_range = fields.number("maximum range")?;
    fields.skip(2);
    let count = fields.count("number of ranges")?;
    if count > fields.left() {
        return Err(too_few(fields, count));
    }
    let ranges = fields.ranges(count, 1.0)?;
    let remissions = fields.count("number of remissions")?;
    expect_words(fields, count, remissions.saturating_add(if raw { 0 } else { 11 }))?;
    fields.skip(remissions);
    let described = Some(Described { start, field_of_view, resolution, max_range });
    if raw {
        return Ok(LaserLine { described, ranges, poses: None, stamp: end(fields)? });
    }
    let laser = fields.pose(["laser_x", "laser_y", "laser_theta"], 1.0, 1.0)?;
    let robot = fields.pose(["robot_x", "robot_y", "robot_theta"], 1.0, 1.0)?;
    fields.skip(5);
    Ok(LaserLine { described, ranges, poses: Some([laser, robot]), stamp: end(fields)? })
}

/// Reads the time of the measurement, the host, and the logger's time, which may be absent.
///
/// Without a host, the number before it may have been cut.
fn end(fields: &mut Fields<'_>) -> Result<Stamp, Damage> {
    let time = fields.time("ipc_timestamp", 1.0)?;
    fields.word("host")?;
    Ok(Stamp { time, logger: fields.number_if_any() })
}

/// Checks the number of words before the time, the host and the logger's time, which may be absent.
fn expect_words(fields: &Fields<'_>, count: usize, words: usize) -> Result<(), Damage> {
    let there = fields.left();
    let without = there == words.saturating_add(2) && !fields.ends_with_number();
    if there == words.saturating_add(3) || without {
        return Ok(());
    }
    let more = there > words.saturating_add(3);
    Err(if more { wrong_count(count) } else { too_few(fields, count) })
}

/// Returns the fault of a line with too few words; a line that has its end was not cut short.
fn too_few(fields: &Fields<'_>, count: usize) -> Damage {
    if fields.ends_with_host_and_time() {
        return wrong_count(count);
    }
    Damage::new(
        SkipReason::Unreadable,
        format!("the line is cut short: it announces {count} ranges"),
    )
}

fn wrong_count(count: usize) -> Damage {
    let fault = format!("ranges: {count} are announced, but the line is not as long as that");
    Damage::new(SkipReason::Count, fault)
}
