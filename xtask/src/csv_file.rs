//! Tables that are there whole or not at all.

use anyhow::{Result, anyhow};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a table into `FILE.partial`, and gives it its name when it is whole.
///
/// # Errors
/// If it cannot be written; then nothing is left of it.
pub(crate) fn write(
    path: &Path,
    rows: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<()> {
    let fail = |error: io::Error| anyhow!("{}: cannot be written: {error}", path.display());
    if path.file_name().is_none() || fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        return Err(anyhow!("{}: is there and is no file that can be replaced", path.display()));
    }
    let partial = partial(path);
    let file = File::create(&partial).map_err(fail)?;
    let mut out = BufWriter::new(file);
    let written = rows(&mut out).and_then(|()| out.flush()).map(|()| drop(out));
    written.and_then(|()| fs::rename(&partial, path)).map_err(|error| {
        // What cannot be written can hardly be removed; the first error is the one to tell.
        let _ = fs::remove_file(&partial);
        fail(error)
    })
}

fn partial(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".partial");
    PathBuf::from(name)
}
