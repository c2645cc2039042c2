//! Tables that are written whole or not at all.

use crate::{FileError, NewFile, Replace};
use std::io;
use std::path::Path;

/// Writes a table, and replaces an old one: for covmap's own folders.
///
/// # Errors
/// If the table cannot be written. Nothing of it is left then.
pub fn write(
    path: &Path,
    rows: impl FnOnce(&mut NewFile) -> io::Result<()>,
) -> Result<(), FileError> {
    write_to(path, Replace::Any, rows)
}

/// Writes a table where the user wants it.
///
/// # Errors
/// If the table cannot be written, or must not replace an existing file. Nothing of it is left then.
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

/// Returns a text as a field of a table, in quotes where it would be torn.
pub fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
