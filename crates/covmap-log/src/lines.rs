//! The lines of a text file, plain or packed, within bounded memory.

use super::limits::{LONGEST_LINE, MOST_RATIO};
use super::{LogError, foreign};
use covmap_io::open_file;
use flate2::read::MultiGzDecoder;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The number of bytes that a packed file may always unpack to.
const ALWAYS_UNPACKED: u64 = 16 << 20;
/// The number of bytes at the beginning that are available before the first line is read.
const HEAD: u64 = 1 << 20;

type Input = Box<dyn Read + Send>;

/// Opens a file that can be read again and again.
pub(super) fn open(path: &Path) -> Result<File, LogError> {
    open_file(path).map_err(|source| match source.kind() {
        io::ErrorKind::Other => LogError::NotAFile { path: path.to_owned() },
        _ => LogError::Io { path: path.to_owned(), source },
    })
}

/// The lines of a file, one after the other.
pub(super) struct Lines {
    path: PathBuf,
    head: Arc<[u8]>,
    input: BufReader<Input>,
    packed: bool,
    line: usize,
    bytes: Vec<u8>,
}

impl Lines {
    /// Returns the lines of a file.
    pub(super) fn open(path: &Path) -> Result<Self, LogError> {
        Self::new(path, open(path)?)
    }

    /// Returns the lines of `input`, which `path` names in errors.
    pub(super) fn new(
        path: &Path,
        mut input: impl Read + Send + 'static,
    ) -> Result<Self, LogError> {
        let io = |source| LogError::Io { path: path.to_owned(), source };
        let mut magic = Vec::new();
        input.by_ref().take(2).read_to_end(&mut magic).map_err(io)?;
        let packed = magic == [0x1f, 0x8b];
        let whole = Cursor::new(magic).chain(input);
        let mut rest: Input = if packed {
            let packed = Counted { input: BufReader::new(whole), bytes: 0 };
            Box::new(Unpacker { decoder: MultiGzDecoder::new(packed), unpacked: 0 })
        } else {
            Box::new(whole)
        };
        let mut head = Vec::new();
        // The bytes before an error are read again before the error is returned.
        let error = rest.by_ref().take(HEAD).read_to_end(&mut head).err();
        let head: Arc<[u8]> = head.into();
        if let Some(kind) = foreign::kind(&head) {
            return Err(LogError::Foreign { path: path.to_owned(), kind });
        }
        let input: Input = Box::new(Begun { head: Cursor::new(Arc::clone(&head)), error, rest });
        let (path, input) = (path.to_owned(), BufReader::with_capacity(1 << 16, input));
        Ok(Self { path, head, input, packed, line: 0, bytes: Vec::new() })
    }

    /// Returns the first lines, without a last one that may continue.
    pub(super) fn head(&self) -> impl Iterator<Item = &[u8]> {
        let whole = if self.head.len() as u64 == HEAD {
            self.head.iter().rposition(|byte| *byte == b'\n').unwrap_or(0)
        } else {
            self.head.len()
        };
        self.head[..whole].split(|byte| *byte == b'\n')
    }

    /// Frees the memory behind [`Lines::head`].
    pub(super) fn forget_head(&mut self) {
        self.head = Arc::new([]);
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the number of the last line, counted from 1.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// Goes to the next line that is neither empty nor a comment; false after the last.
    pub(super) fn advance(&mut self) -> Result<bool, LogError> {
        loop {
            if !self.read_line()? {
                return Ok(false);
            }
            let first = self.bytes.trim_ascii_start().first();
            if first.is_some_and(|byte| *byte != b'#') {
                return Ok(true);
            }
        }
    }

    /// Returns the text of the line; bytes that are not UTF-8 are replaced.
    pub(super) fn text(&self) -> std::borrow::Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }

    fn read_line(&mut self) -> Result<bool, LogError> {
        self.bytes.clear();
        self.line += 1;
        let mut input = self.input.by_ref().take(LONGEST_LINE as u64 + 1);
        if let Err(source) = input.read_until(b'\n', &mut self.bytes) {
            return Err(self.error(source));
        }
        if self.bytes.len() > LONGEST_LINE {
            return Err(LogError::LongLine { path: self.path.clone(), line: self.line });
        }
        Ok(!self.bytes.is_empty())
    }

    fn error(&self, source: io::Error) -> LogError {
        let (path, line) = (self.path.clone(), self.line);
        match source.kind() {
            io::ErrorKind::FileTooLarge if self.packed => LogError::Unpacked { path, line },
            _ if self.packed => LogError::Gzip { path, line, source },
            _ => LogError::Io { path, source },
        }
    }
}

/// The beginning that was read ahead, and the rest.
struct Begun {
    head: Cursor<Arc<[u8]>>,
    error: Option<io::Error>,
    rest: Input,
}

impl Read for Begun {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        match self.head.read(out)? {
            0 if !out.is_empty() => self.error.take().map_or_else(|| self.rest.read(out), Err),
            count => Ok(count),
        }
    }
}

/// Counts the bytes that are read.
struct Counted<R> {
    input: R,
    bytes: u64,
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(out)?;
        self.bytes += count as u64;
        Ok(count)
    }
}

/// Unpacks up to a limit.
struct Unpacker<R> {
    decoder: MultiGzDecoder<Counted<R>>,
    unpacked: u64,
}

impl<R: Read> Read for Unpacker<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.decoder.read(out)?;
        self.unpacked += count as u64;
        let most = ALWAYS_UNPACKED + MOST_RATIO * self.decoder.get_ref().bytes;
        if self.unpacked > most {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        Ok(count)
    }
}
