//! What can be wrong with a log as a whole.

use super::limits::{LONGEST_LINE, MOST_POSES, MOST_RATIO};
use super::{Sensor, Skipped};
use std::io;
use std::path::PathBuf;

/// Why a log cannot be read, or not any further: one sentence that names file and line.
///
/// A frame that is wrong is no error: it is passed over and counted by [`Skipped`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The operating system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// A pipe, a device, or a folder where a file should be.
    #[error("{}: is no file that can be read twice", path.display())]
    NotAFile {
        /// What it is.
        path: PathBuf,
    },
    /// A file of another kind.
    #[error("{}: is {kind}; a log is a CARMEN text log, or a folder with od.txt, and sonar.txt or laser.txt", path.display())]
    Foreign {
        /// The file or folder.
        path: PathBuf,
        /// What it is, and what reads it.
        kind: &'static str,
    },
    /// More poses than are held.
    #[error("{}:{line}: has more than {MOST_POSES} poses; cut it, or thin it out", path.display())]
    TooManyPoses {
        /// The file.
        path: PathBuf,
        /// The line with the first pose that is too much, counted from 1.
        line: usize,
    },
    /// A folder without one of its files.
    #[error("{}: is a folder without {name}; a log is a CARMEN log, or a folder with od.txt, and sonar.txt or laser.txt", path.display())]
    MissingFile {
        /// The folder.
        path: PathBuf,
        /// The file.
        name: &'static str,
    },
    /// A folder with the readings of another sensor alone.
    #[error("{}: is a folder without {name}, but with {has}", path.display())]
    OtherSensor {
        /// The folder.
        path: PathBuf,
        /// The file that is not there.
        name: &'static str,
        /// The file that is.
        has: &'static str,
    },
    /// A line longer than any of a log.
    #[error("{}:{line}: the line has more than {LONGEST_LINE} bytes; this is no log", path.display())]
    LongLine {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
    },
    /// The file is packed, and damaged or cut short.
    #[error("{}:{line}: the gzip data are damaged or cut short: {source}", path.display())]
    Gzip {
        /// The file.
        path: PathBuf,
        /// The line that could not be unpacked, counted from 1.
        line: usize,
        /// What is wrong.
        source: io::Error,
    },
    /// The file is packed, and unpacks as if without end.
    #[error("{}:{line}: unpacks to more than {MOST_RATIO} times its size, which no log does", path.display())]
    Unpacked {
        /// The file.
        path: PathBuf,
        /// The line at which it became too much, counted from 1.
        line: usize,
    },
    /// Not one frame of the log can be used.
    #[error("{}: has no scan that can be used: {}", path.display(), in_words(skipped, wanted, others))]
    NoScans {
        /// The file.
        path: PathBuf,
        /// What was looked for.
        wanted: &'static str,
        /// How many lines of the other sensors there are.
        others: Vec<(&'static str, usize)>,
        /// What was found instead.
        skipped: Box<Skipped>,
    },
}

impl LogError {
    /// The sensor that the log has, if it has nothing of the wanted one.
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
