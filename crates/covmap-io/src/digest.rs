//! Hashes of everything on which a run depends.

use crate::{FileError, open_input};
use sha2::{Digest as _, Sha256};
use std::fmt::Write;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// A hash over parts; it depends on the borders between the parts.
#[derive(Debug, Clone, Default)]
pub struct Digest(Sha256);

impl Digest {
    /// Adds a part.
    #[must_use]
    pub fn with(mut self, part: impl AsRef<[u8]>) -> Self {
        let part = part.as_ref();
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
        self
    }

    /// Adds numbers, to their last bit.
    #[must_use]
    pub fn with_numbers(self, numbers: &[f64]) -> Self {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.with(bytes)
    }

    /// Adds the bytes of a file.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn with_file(mut self, file: impl AsRef<Path>) -> Result<Self, FileError> {
        let file = file.as_ref();
        let cannot_be_read =
            |reason| FileError::Io { path: file.to_owned(), action: "read", reason };
        let mut bytes = BufReader::new(open_input(file)?);
        loop {
            let part = bytes.fill_buf().map_err(cannot_be_read)?;
            if part.is_empty() {
                return Ok(self.with("end of file"));
            }
            let length = part.len();
            self.0.update(part);
            bytes.consume(length);
        }
    }

    /// Returns the hash, as 32 hexadecimal digits.
    pub fn finish(self) -> String {
        let mut text = String::new();
        for byte in &self.0.finalize()[..16] {
            let _ = write!(text, "{byte:02x}");
        }
        text
    }
}

/// Returns the checksum of a line.
pub fn checksum(line: &str) -> String {
    Digest::default().with(line).finish()
}
