//! Logs of real robots, as scans with poses, one after the other.
//!
//! [`LogReader`] reads CARMEN's text logs, folders of three files, and bags of ROS 2; [`CarmenWriter`] writes
//! the first. The reader holds only a few frames at a time, however long a log is.

mod account;
mod bag_log;
mod bag_options;
mod bag_survey;
#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are exact")]
mod bag_tests;
mod bag_writer;
mod carmen;
mod carmen_line;
mod carmen_writer;
#[cfg(test)]
mod clock_tests;
mod device;
mod error;
mod fields;
mod folder;
mod follower;
mod foreign;
mod limits;
mod lines;
mod options;
mod parameters;
mod poses;
mod queue;
mod reader;
#[cfg(test)]
mod sensor_tests;
mod skipped;
#[cfg(test)]
mod tests;
mod track;
mod way;

pub use account::{Account, Readings, SensorAccount, Taken};
pub use bag_options::BagOptions;
pub use bag_writer::{BagWriterError, FRAMES, RosBagWriter};
pub use carmen_writer::{CarmenWriter, CarmenWriterError};
pub use error::LogError;
pub use follower::{Follower, Leg};
pub use foreign::is_of_a_log;
pub use options::{LogOptions, Sensor};
pub use reader::{LogFrame, LogReader};
pub use skipped::{SkipReason, Skipped};
pub use way::Passed;
