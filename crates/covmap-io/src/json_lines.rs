//! JSON lines: a trace that is valid up to the line that was last written.

use crate::FileError;
use crate::json::{parse_json, syntax, unwritable};
use crate::new_file::create_new;
use crate::read::open_input;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Read, Write};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

/// The longest line that is read \[bytes\].
const MAX_LINE: u64 = 64 << 20;
/// The longest file that is read \[bytes\]: the trace of some 600,000 scans.
const MAX_LINES: u64 = 1 << 30;

/// Writer of one value a line.
///
/// All values are in the file after [`flush`](Self::flush), or when the writer is dropped; only
/// `flush` reports a failure.
#[derive(Debug)]
pub struct JsonLines<W: Write> {
    path: PathBuf,
    out: W,
    line: Vec<u8>,
}

impl JsonLines<BufWriter<File>> {
    /// Creates a new file of lines, which can be read up to the last line while it is written.
    ///
    /// # Errors
    /// If the name is taken, or the file cannot be made.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let file = create_new(path).map_err(FileError::io(path, "written"))?;
        Ok(Self::new(path, BufWriter::new(file)))
    }

    /// Flushes all values to the disk.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn sync(&mut self) -> Result<(), FileError> {
        self.flush()?;
        self.out.get_ref().sync_all().map_err(FileError::io(&self.path, "written"))
    }
}

impl<W: Write> JsonLines<W> {
    /// Creates a writer of lines into `out`; `path` names it in errors.
    pub fn new(path: impl Into<PathBuf>, out: W) -> Self {
        Self { path: path.into(), out, line: Vec::new() }
    }

    /// Writes one value as one line.
    ///
    /// # Errors
    /// If the value has no form in JSON (then nothing is written), or the file cannot be
    /// written.
    pub fn write<T: Serialize>(&mut self, value: &T) -> Result<(), FileError> {
        self.line.clear();
        serde_json::to_writer(&mut self.line, value)
            .map_err(|error| unwritable(&self.path, &error))?;
        self.line.push(b'\n');
        self.out.write_all(&self.line).map_err(FileError::io(&self.path, "written"))
    }

    /// Hands all values to the operating system.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn flush(&mut self) -> Result<(), FileError> {
        self.out.flush().map_err(FileError::io(&self.path, "written"))
    }
}

/// Reader of the values of a file of JSON lines, one after the other. Empty lines are skipped.
///
/// A line without a valid value is an error, and the reader goes on after it. A last line that was
/// cut short is [`FileError::Truncated`]: all values before it are whole.
#[derive(Debug)]
pub struct JsonLinesReader<T, R> {
    path: PathBuf,
    input: R,
    line: usize,
    /// Number of bytes that may still be read.
    left: u64,
    bytes: Vec<u8>,
    ended: bool,
    values: PhantomData<fn() -> T>,
}

/// Reads the values of a file of JSON lines.
///
/// # Errors
/// If the file cannot be opened, or has more than 1 GB. Each value that is read has its own error.
pub fn read_json_lines<T: DeserializeOwned>(
    path: impl AsRef<Path>,
) -> Result<JsonLinesReader<T, BufReader<File>>, FileError> {
    let path = path.as_ref();
    let file = open_input(path)?;
    if file.metadata().map_err(FileError::io(path, "read"))?.len() > MAX_LINES {
        return Err(FileError::TooLarge { path: path.to_path_buf(), limit: MAX_LINES });
    }
    Ok(JsonLinesReader::new(path, BufReader::new(file)))
}

impl<T: DeserializeOwned, R: BufRead> JsonLinesReader<T, R> {
    /// Creates a reader of the values in `input`; `path` names it in errors.
    pub fn new(path: impl Into<PathBuf>, input: R) -> Self {
        Self {
            path: path.into(),
            input,
            line: 0,
            left: MAX_LINES,
            bytes: Vec::new(),
            ended: false,
            values: PhantomData,
        }
    }

    /// Reads the next line without its end; `None` after the last. The flag says whether the
    /// line had an end.
    fn next_line(&mut self) -> Result<Option<bool>, FileError> {
        self.bytes.clear();
        let mut input = self.input.by_ref().take(MAX_LINE + 1);
        input.read_until(b'\n', &mut self.bytes).map_err(FileError::io(&self.path, "read"))?;
        let limit = MAX_LINES;
        let too_large = || FileError::TooLarge { path: self.path.clone(), limit };
        self.left = self.left.checked_sub(self.bytes.len() as u64).ok_or_else(too_large)?;
        if self.bytes.is_empty() {
            return Ok(None);
        }
        self.line += 1;
        let whole = self.bytes.pop_if(|last| *last == b'\n').is_some();
        if self.bytes.len() as u64 > MAX_LINE {
            return Err(FileError::LongLine {
                path: self.path.clone(),
                line: self.line,
                limit: MAX_LINE,
            });
        }
        Ok(Some(whole))
    }
}

impl<T: DeserializeOwned, R: BufRead> Iterator for JsonLinesReader<T, R> {
    type Item = Result<T, FileError>;

    fn next(&mut self) -> Option<Self::Item> {
        while !self.ended {
            let whole = match self.next_line() {
                Ok(Some(whole)) => whole,
                Ok(None) => {
                    self.ended = true;
                    return None;
                }
                Err(error) => {
                    self.ended = true;
                    return Some(Err(error));
                }
            };
            if self.bytes.trim_ascii().is_empty() {
                continue;
            }
            return Some(parse_json(&self.bytes).map_err(|(error, field)| {
                if !whole && error.is_eof() {
                    FileError::Truncated { path: self.path.clone(), line: self.line }
                } else {
                    syntax(&self.path, self.line - 1, &error, field)
                }
            }));
        }
        None
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use covmap_sonar::{Range, Scan};
    use nalgebra::Isometry2;
    use proptest::prelude::*;

    fn some_scans() -> Vec<Scan> {
        let scan = |i: u32| Scan {
            pose: Isometry2::new([0.1 * f64::from(i), -1.0 / 3.0].into(), 0.7),
            time: f64::from(i),
            ranges: vec![Range::Echo(1.0 / f64::from(i + 3)), Range::NoEcho, Range::Missing],
        };
        (0..3).map(scan).collect()
    }

    fn written(scans: &[Scan]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut lines = JsonLines::new("log.jsonl", &mut bytes);
        scans.iter().for_each(|scan| lines.write(scan).unwrap());
        bytes
    }

    fn read(bytes: &[u8]) -> Vec<Result<Scan, FileError>> {
        JsonLinesReader::new("log.jsonl", bytes).collect()
    }

    #[test]
    fn a_log_of_scans_comes_back_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.jsonl");
        let scans = some_scans();
        let mut lines = JsonLines::create(&path).unwrap();
        scans.iter().for_each(|scan| lines.write(scan).unwrap());
        lines.sync().unwrap();
        assert!(JsonLines::create(&path).is_err(), "a file that is there stays");
        let back: Result<Vec<Scan>, _> = read_json_lines(&path).unwrap().collect();
        assert_eq!(back.unwrap(), scans);
    }

    #[test]
    fn wherever_a_log_is_cut_a_valid_prefix_is_left() {
        let (scans, bytes) = (some_scans(), written(&some_scans()));
        for cut in 0..bytes.len() {
            let values = read(&bytes[..cut]);
            let whole = values.iter().take_while(|value| value.is_ok()).count();
            for (value, scan) in values.iter().zip(&scans).take(whole) {
                assert_eq!(value.as_ref().unwrap(), scan);
            }
            assert!(values.len() <= whole + 1);
            if let Some(Err(error)) = values.last() {
                assert!(matches!(error, FileError::Truncated { .. }), "{error}");
                assert_eq!(
                    error.to_string(),
                    format!("log.jsonl:{}: the last line is cut short", whole + 1)
                );
            }
        }
    }

    #[test]
    fn a_wrong_line_is_named_and_passed_over() {
        let bytes = b"1\n\n[2]\n3".as_slice();
        let values: Vec<Result<u32, _>> = JsonLinesReader::new("n.jsonl", bytes).collect();
        assert_eq!(values.len(), 3);
        let error = values[1].as_ref().unwrap_err().to_string();
        assert!(error.starts_with("n.jsonl:3:1: invalid type: sequence"), "{error}");
        assert_eq!(*values[2].as_ref().unwrap(), 3);
    }

    #[test]
    fn a_line_without_end_is_refused() {
        let endless = BufReader::new(std::io::repeat(b'7'));
        let mut reader = JsonLinesReader::<u32, _>::new("e.jsonl", endless);
        assert!(matches!(reader.next(), Some(Err(FileError::LongLine { line: 1, .. }))));
        assert!(reader.next().is_none());
    }

    #[test]
    fn lines_without_end_are_refused() {
        let mut reader = JsonLinesReader::<u32, _>::new("e.jsonl", b"\n1\n2\n3\n".as_slice());
        reader.left = 5;
        assert_eq!([reader.next().unwrap().unwrap(), reader.next().unwrap().unwrap()], [1, 2]);
        assert!(matches!(reader.next(), Some(Err(FileError::TooLarge { .. }))));
        assert!(reader.next().is_none());
        let folder = tempfile::tempdir().unwrap();
        let sparse = folder.path().join("sparse.jsonl");
        File::create(&sparse).unwrap().set_len(MAX_LINES + 1).unwrap();
        assert!(matches!(read_json_lines::<u32>(sparse), Err(FileError::TooLarge { .. })));
    }

    proptest! {
        #[test]
        fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200),
                                       at in 0..600usize, byte in any::<u8>()) {
            read(&bytes);
            let mut damaged = written(&some_scans());
            let length = damaged.len();
            damaged[at % length] = byte;
            read(&damaged);
        }
    }
}
