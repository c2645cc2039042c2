//! Reading whole files, but never more of them than is sensible.

use crate::FileError;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The largest file that is read as a whole \[bytes\].
pub(crate) const MAX_FILE: u64 = 64 << 20;

/// The bytes of a file of at most `limit` bytes.
///
/// The size is looked at before anything is read; what lies about its size, such as a
/// device, is cut off at the limit.
pub(crate) fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let too_large = || FileError::TooLarge { path: path.to_path_buf(), limit };
    let file = File::open(path).map_err(FileError::io(path, "read"))?;
    let size = file.metadata().map_err(FileError::io(path, "read"))?.len();
    if size > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes).map_err(FileError::io(path, "read"))?;
    if bytes.len() as u64 > limit {
        return Err(too_large());
    }
    Ok(bytes)
}

/// The text of a file of at most `limit` bytes.
pub(crate) fn read_text(path: &Path, limit: u64) -> Result<String, FileError> {
    String::from_utf8(read_bytes(path, limit)?).map_err(|error| FileError::NotText {
        path: path.to_path_buf(),
        at: error.utf8_error().valid_up_to(),
    })
}

/// Writes a whole file.
pub(crate) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    std::fs::write(path, bytes).map_err(FileError::io(path, "written"))
}
