//! Errors of files and folders.

use crate::escaped::{escaped, shown};
use crate::map_error::{ImageError, MapServerError};
use std::io;
use std::path::{Path, PathBuf};

/// Reason why a file or a folder cannot be used: one sentence that names it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system refused.
    #[error("{}: cannot be {action}: {reason}", shown(path))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The action that was tried: "read", "written", …
        action: &'static str,
        /// Error of the operating system.
        reason: io::Error,
    },
    /// The file is larger than any of its kind.
    #[error(
        "{}: has more than {limit} bytes, which is too large for a file of this kind",
        shown(path)
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Largest size that is read \[bytes\].
        limit: u64,
    },
    /// The file is not UTF-8.
    #[error("{}: is not a text file: byte {at} is not UTF-8", shown(path))]
    NotText {
        /// The file.
        path: PathBuf,
        /// Position of the first byte that is not UTF-8 \[bytes from the beginning\].
        at: usize,
    },
    /// RON, JSON or YAML text does not hold the expected value.
    #[error("{}:{line}:{column}: {}{}", shown(path), in_field(field), escaped(message))]
    Syntax {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The column, counted from 1.
        column: usize,
        /// The field with the error, such as `obstacles[3].shape`; empty at the top.
        field: String,
        /// Description of the error.
        message: String,
    },
    /// The last line of a file of JSON lines was cut short, as when its writer was stopped.
    /// All lines before it are whole.
    #[error("{}:{line}: the last line is cut short", shown(path))]
    Truncated {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
    },
    /// A line is longer than any that covmap writes.
    #[error("{}:{line}: the line has more than {limit} bytes", shown(path))]
    LongLine {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The longest line that is read \[bytes\].
        limit: u64,
    },
    /// A value cannot be written in the format of the file.
    #[error("{}: cannot be written: {}", shown(path), escaped(message))]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Reason.
        message: String,
    },
    /// The image of a map is no image, or not what its header says.
    #[error("{}: {reason}", shown(path))]
    Image {
        /// The image.
        path: PathBuf,
        /// Error of the image.
        reason: ImageError,
    },
    /// The image that a map_server map names cannot be used.
    #[error("{}: image: {reason}{}", shown(path), nor_beside(*missing))]
    MapImage {
        /// The YAML file.
        path: PathBuf,
        /// Error of the image, with its name.
        reason: Box<FileError>,
        /// Whether the image is not beside the YAML file either.
        missing: bool,
    },
    /// The description of a map_server map says something impossible.
    #[error("{}: {}", shown(path), escaped(reason))]
    MapServer {
        /// The YAML file.
        path: PathBuf,
        /// Error of the description.
        reason: MapServerError,
    },
    /// A file exists, and is replaced only on request.
    #[error(
        "{}: is there already and holds something else; name another file, or replace it with --force",
        shown(path)
    )]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The results of another run are in the folder.
    #[error(
        "{}: holds {}; name another folder with --out, or replace it with --force",
        shown(path),
        other_run(run)
    )]
    OtherRun {
        /// The folder.
        path: PathBuf,
        /// The run that the folder holds; empty for a run of an earlier covmap.
        run: String,
    },
    /// A file in an output folder is not as covmap wrote it, so the folder is not replaced.
    #[error(
        "{}: is not as covmap wrote it; move it away, or replace all of the folder with --force",
        shown(path)
    )]
    NotOurs {
        /// The file.
        path: PathBuf,
    },
    /// The output folder must not be replaced.
    #[error("{}: {reason}", shown(path))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Reason.
        reason: &'static str,
    },
}

fn nor_beside(missing: bool) -> &'static str {
    if missing { "; an image of that name is not beside the YAML file either" } else { "" }
}

fn in_field(field: &str) -> String {
    if field.is_empty() { String::new() } else { format!("{}: ", escaped(&field)) }
}

fn other_run(run: &str) -> String {
    match run {
        "" => "a run of an earlier covmap".to_owned(),
        _ => format!("another run ({})", escaped(run)),
    }
}

impl FileError {
    /// Returns the file or folder of the error.
    pub fn path(&self) -> &Path {
        match self {
            Self::Io { path, .. }
            | Self::TooLarge { path, .. }
            | Self::NotText { path, .. }
            | Self::Syntax { path, .. }
            | Self::Truncated { path, .. }
            | Self::LongLine { path, .. }
            | Self::Unwritable { path, .. }
            | Self::Image { path, .. }
            | Self::MapImage { path, .. }
            | Self::MapServer { path, .. }
            | Self::Exists { path }
            | Self::OtherRun { path, .. }
            | Self::NotOurs { path }
            | Self::Folder { path, .. } => path,
        }
    }

    /// Turns the refusal of the operating system into an error that names the file.
    pub fn io(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |reason| Self::Io { path, action, reason }
    }
}

/// Returns the path of a field as `serde_path_to_error` found it; empty at the top, and where a key
/// itself is wrong.
pub(crate) fn field_name(path: &serde_path_to_error::Path) -> String {
    let name = path.to_string();
    if name == "." || name == "?" { String::new() } else { name }
}

/// Returns a message of another library as part of one sentence: on one line, without a capital or
/// a full stop.
pub(crate) fn one_line(message: &str) -> String {
    let words: Vec<&str> = message.split_whitespace().collect();
    let line = words.join(" ");
    let line = line.trim_end_matches('.');
    let mut chars = line.chars();
    match (chars.next(), chars.clone().next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain(chars).collect()
        }
        _ => line.to_string(),
    }
}
