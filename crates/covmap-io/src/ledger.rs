//! The list of what covmap wrote into a folder, by which it knows its own files again.

use crate::FileError;
use crate::read::read_text;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// No list of ours comes near \[bytes\].
const MAX_LEDGER: u64 = 4 << 20;
const RUN: &str = "run ";
const FILE: &str = "file ";

/// The size of a file and the checksum of its bytes.
type Sum = (u64, u32);

/// What a list says.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Ledger {
    /// By which run the folder was written; empty if that is not said.
    pub(crate) run: String,
    files: BTreeMap<String, Sum>,
}

impl Ledger {
    /// The list in a file; `None` if there is none. A link is none.
    pub(crate) fn read(path: &Path) -> Result<Option<Self>, FileError> {
        if !fs::symlink_metadata(path).is_ok_and(|list| list.is_file()) {
            return Ok(None);
        }
        let mut ledger = Self::default();
        for line in read_text(path, MAX_LEDGER)?.lines() {
            if let Some(run) = line.strip_prefix(RUN) {
                run.clone_into(&mut ledger.run);
            } else if let Some((sum, name)) = line.strip_prefix(FILE).and_then(parse) {
                // The last line on a file counts.
                ledger.files.insert(name.to_owned(), sum);
            }
        }
        Ok(Some(ledger))
    }

    /// Whether it lists no file.
    pub(crate) fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// The first of its files that somebody changed.
    pub(crate) fn changed(&self, folder: &Path) -> Option<&str> {
        let is_there = |name: &&String| fs::symlink_metadata(folder.join(name)).is_ok();
        let mut names = self.files.keys().filter(is_there);
        names.find(|name| !self.is_as_written(folder, name)).map(String::as_str)
    }

    /// Whether covmap wrote a file of this name.
    pub(crate) fn lists(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Whether a file in `folder` is as covmap wrote it.
    pub(crate) fn is_as_written(&self, folder: &Path, name: &str) -> bool {
        let path = folder.join(name);
        let is_file = fs::symlink_metadata(&path).is_ok_and(|file| file.is_file());
        is_file && self.files.get(name).is_some_and(|sum| self::sum(&path).is_ok_and(|s| s == *sum))
    }
}

/// The line that names the run.
pub(crate) fn run_line(run: &str) -> String {
    format!("{RUN}{}\n", crate::escaped(run))
}

/// The line on a file as it is now.
pub(crate) fn file_line(folder: &Path, name: &str) -> io::Result<String> {
    let (size, sum) = sum(&folder.join(name))?;
    let mut line = FILE.to_owned();
    let _ = writeln!(line, "{size} {sum:08x} {name}");
    Ok(line)
}

fn parse(line: &str) -> Option<(Sum, &str)> {
    let (size, rest) = line.split_once(' ')?;
    let (sum, name) = rest.split_once(' ')?;
    Some(((size.parse().ok()?, u32::from_str_radix(sum, 16).ok()?), name))
}

/// A CRC tells a file that a person changed; nobody forges one.
fn sum(path: &Path) -> io::Result<Sum> {
    let mut file = File::open(path)?;
    let mut sum = flate2::Crc::new();
    let mut size = 0;
    let mut part = vec![0; 1 << 16];
    loop {
        match file.read(&mut part)? {
            0 => return Ok((size, sum.sum())),
            read => {
                sum.update(&part[..read]);
                size += read as u64;
            }
        }
    }
}
