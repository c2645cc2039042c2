//! Tables that are there whole or not at all.

use crate::{FileError, NewFile, Replace};
use std::io;
use std::path::Path;

/// Writes a table, replacing an old one: for folders that are covmap's own.
///
/// # Errors
/// If it cannot be written; then nothing is left of it.
pub fn write(
    path: &Path,
    rows: impl FnOnce(&mut NewFile) -> io::Result<()>,
) -> Result<(), FileError> {
    write_to(path, Replace::Any, rows)
}

/// Writes a table where the user wants it.
///
/// # Errors
/// If it cannot be written, or must not replace what is there; then nothing is left of it.
pub fn write_to(
    path: &Path,
    replace: Replace,
    rows: impl FnOnce(&mut NewFile) -> io::Result<()>,
) -> Result<(), FileError> {
    let mut file = NewFile::create(path, replace)?;
    let fail = |reason| FileError::Io { path: path.to_owned(), action: "written", reason };
    rows(&mut file).map_err(fail)?;
    file.finish()
}

/// A text as a field of a table: in quotes where it would be torn.
pub fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
