//! JSON files: a summary in one piece.

use crate::FileError;
use crate::error::{field_name, one_line};
use crate::new_file::{Replace, write_file};
use crate::read::{MAX_FILE, read_bytes};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// Writes a value as JSON, a field a line.
///
/// JSON has no NaN and no infinity: both are written as `null`.
///
/// # Errors
/// If the value has no form in JSON, or the file cannot be written.
pub fn write_json<T: Serialize>(path: impl AsRef<Path>, value: &T) -> Result<(), FileError> {
    let path = path.as_ref();
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|error| unwritable(path, &error))?;
    bytes.push(b'\n');
    write_file(path, &bytes, Replace::Any)
}

/// Reads the value of a JSON file.
///
/// # Errors
/// If the file cannot be read, has more than 64 MB, or does not hold such a value. The error names
/// file, line, column, and field.
pub fn read_json<T: DeserializeOwned>(path: impl AsRef<Path>) -> Result<T, FileError> {
    let path = path.as_ref();
    let bytes = read_bytes(path, MAX_FILE)?;
    parse_json(&bytes).map_err(|(error, field)| syntax(path, 0, &error, field))
}

pub(crate) fn unwritable(path: &Path, error: &serde_json::Error) -> FileError {
    FileError::Unwritable { path: path.to_path_buf(), message: one_line(&error.to_string()) }
}

/// Returns the value, or the error and the field that it is in.
pub(crate) fn parse_json<T: DeserializeOwned>(
    bytes: &[u8],
) -> Result<T, (serde_json::Error, String)> {
    let mut deserializer = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let field = field_name(error.path());
        (error.into_inner(), field)
    })?;
    deserializer.end().map_err(|error| (error, String::new()))?;
    Ok(value)
}

/// Returns an error in text that begins `lines_before` lines below the beginning of the file.
pub(crate) fn syntax(
    path: &Path,
    lines_before: usize,
    error: &serde_json::Error,
    field: String,
) -> FileError {
    let (line, column) = (error.line(), error.column());
    let message = one_line(&error.to_string());
    // serde_json ends its sentence with a place, which the error already begins with.
    let place = format!(" at line {line} column {column}");
    let message = message.strip_suffix(&place).unwrap_or(&message).to_string();
    let line = lines_before + line.max(1);
    FileError::Syntax { path: path.to_path_buf(), line, column: column.max(1), field, message }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn a_value_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("summary.json");
        let value = BTreeMap::from([("scans".to_string(), 0.1), ("path".to_string(), 1e-300)]);
        write_json(&path, &value).unwrap();
        assert_eq!(read_json::<BTreeMap<String, f64>>(&path).unwrap(), value);
        assert!(std::fs::read_to_string(&path).unwrap().ends_with("}\n"));
    }

    #[test]
    fn an_error_names_file_line_column_and_field() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bad.json");
        std::fs::write(&path, "{\n  \"cells\": [1, true]\n}").unwrap();
        let error = read_json::<BTreeMap<String, Vec<u32>>>(&path).unwrap_err().to_string();
        let expected = "bad.json:2:19: cells[1]: invalid type: boolean `true`, expected u32";
        assert!(error.ends_with(expected), "{error}");
    }
}
