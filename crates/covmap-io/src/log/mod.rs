//! Logs of real robots, as scans with poses, one after the other.
//!
//! [`LogReader`] reads CARMEN's text logs and folders of three files, and [`CarmenWriter`]
//! writes the former. However long a log is, only a few of its frames are held at a time.

mod carmen;
mod carmen_line;
mod carmen_writer;
mod device;
mod error;
mod fields;
mod folder;
mod lines;
mod poses;
mod reader;
mod skipped;
#[cfg(test)]
mod tests;

pub use carmen_writer::{CarmenWriter, CarmenWriterError};
pub use error::LogError;
pub use reader::{LogFrame, LogOptions, LogReader, Sensor};
pub use skipped::{SkipReason, Skipped};
