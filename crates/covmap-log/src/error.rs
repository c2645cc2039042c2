//! Errors of a log as a whole.

use super::limits::{LONGEST_LINE, MOST_POSES, MOST_RATIO};
use super::{Sensor, Skipped};
use std::io;
use std::path::PathBuf;

/// Why a log cannot be read, or not any further: one sentence that names file and line.
///
/// A wrong frame is not an error: the reader passes over it, and [`Skipped`] counts it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The operating system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A pipe, a device, or a folder where a file should be.
    #[error("{}: is no file that can be read twice", path.display())]
    NotAFile {
        /// The pipe, device or folder.
        path: PathBuf,
    },
    /// A file of another kind.
    #[error("{}: is {kind}; a log is a CARMEN text log, or a folder with od.txt, and sonar.txt or laser.txt", path.display())]
    Foreign {
        /// The file or folder.
        path: PathBuf,
        /// The kind of file, and the program that reads it.
        kind: &'static str,
    },
    /// The file has more poses than the reader holds.
    #[error("{}:{line}: has more than {MOST_POSES} poses; cut it, or thin it out", path.display())]
    TooManyPoses {
        /// The file.
        path: PathBuf,
        /// The line with the first pose beyond the limit, counted from 1.
        line: usize,
    },
    /// A folder without one of its files.
    #[error("{}: is a folder without {name}; a log is a CARMEN log, or a folder with od.txt, and sonar.txt or laser.txt", path.display())]
    MissingFile {
        /// The folder.
        path: PathBuf,
        /// The missing file.
        name: &'static str,
    },
    /// A folder with the readings of another sensor alone.
    #[error("{}: is a folder without {name}, but with {has}", path.display())]
    OtherSensor {
        /// The folder.
        path: PathBuf,
        /// The missing file.
        name: &'static str,
        /// The file that is there.
        has: &'static str,
    },
    /// A line longer than any of a log.
    #[error("{}:{line}: the line has more than {LONGEST_LINE} bytes; this is not a log", path.display())]
    LongLine {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
    },
    /// The file is packed, and is damaged or cut short.
    #[error("{}:{line}: the gzip data are damaged or cut short: {source}", path.display())]
    Gzip {
        /// The file.
        path: PathBuf,
        /// The line that could not be unpacked, counted from 1.
        line: usize,
        /// The error of the decoder.
        source: io::Error,
    },
    /// The file is packed, and unpacks to far more than a log.
    #[error("{}:{line}: unpacks to more than {MOST_RATIO} times its size, which no log does", path.display())]
    Unpacked {
        /// The file.
        path: PathBuf,
        /// The line at which the limit was passed, counted from 1.
        line: usize,
    },
    /// A bag cannot be read.
    #[error(transparent)]
    Bag(#[from] covmap_bag::BagError),
    /// A bag has not what a map needs.
    #[error("{}: the bag has {what}. Its topics: {topics}", path.display())]
    BagLacks {
        /// The file.
        path: PathBuf,
        /// What it lacks.
        what: String,
        /// Its topics, with types and numbers of messages.
        topics: String,
    },
    /// No frame of the log can be used.
    #[error("{}: has no scan that can be used: {}", path.display(), in_words(skipped, wanted, others))]
    NoScans {
        /// The file.
        path: PathBuf,
        /// The wanted lines.
        wanted: &'static str,
        /// The number of lines of each other sensor.
        others: Vec<(&'static str, usize)>,
        /// The frames that were passed over.
        skipped: Box<Skipped>,
    },
}

impl LogError {
    /// Returns the sensor that the log has, if it has no lines of the wanted one.
    pub fn other_sensor(&self) -> Option<Sensor> {
        let is_sonar = match self {
            Self::OtherSensor { has, .. } => *has == "sonar.txt",
            Self::NoScans { skipped, others, .. } if skipped.frames() == 0 => {
                others.first()?.0 == "SONAR"
            }
            _ => return None,
        };
        Some(if is_sonar { Sensor::Sonar } else { Sensor::Laser })
    }
}

fn in_words(skipped: &Skipped, wanted: &str, others: &[(&str, usize)]) -> String {
    if skipped.frames() > 0 {
        return skipped.to_string();
    }
    let many = |(tag, count): &(&str, usize)| match count {
        1 => format!("1 line {tag}"),
        _ => format!("{count} lines {tag}"),
    };
    match others.iter().map(many).collect::<Vec<_>>().join(" and ") {
        none if none.is_empty() => format!("there is no {wanted}"),
        some => format!("there is no {wanted}, but {some}"),
    }
}
