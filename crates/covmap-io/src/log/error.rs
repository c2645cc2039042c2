//! What can be wrong with a log as a whole.

use super::Skipped;
use super::lines::{LONGEST_LINE, MOST_RATIO};
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
    /// A folder without one of its files.
    #[error("{}: is a folder without {name}; a log is a CARMEN log, or a folder with od.txt, and sonar.txt or laser.txt", path.display())]
    MissingFile {
        /// The folder.
        path: PathBuf,
        /// The file.
        name: &'static str,
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
    #[error("{}: has no scan that can be used: {}", path.display(), in_words(skipped, wanted))]
    NoScans {
        /// The file.
        path: PathBuf,
        /// What was looked for.
        wanted: &'static str,
        /// What was found instead.
        skipped: Box<Skipped>,
    },
}

fn in_words(skipped: &Skipped, wanted: &str) -> String {
    match skipped.frames() {
        0 => format!("there is no {wanted}"),
        _ => skipped.to_string(),
    }
}
