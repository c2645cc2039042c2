//! The list of the files that covmap wrote into a folder, by which covmap recognises them.

use crate::FileError;
use crate::read::read_text;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The largest list that is read \[bytes\]; no list of covmap comes near.
const MAX_LEDGER: u64 = 4 << 20;
const RUN: &str = "run ";
const FILE: &str = "file ";

/// The size of a file and the checksum of its bytes.
type Sum = (u64, u32);

/// The content of a list.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Ledger {
    /// The run that wrote the folder; empty if the list does not name it.
    pub(crate) run: String,
    files: BTreeMap<String, Sum>,
}

impl Ledger {
    /// Reads the list in a file; `None` if there is no file, or a link.
    pub(crate) fn read(path: &Path) -> Result<Option<Self>, FileError> {
        if !fs::symlink_metadata(path).is_ok_and(|list| list.is_file()) {
            return Ok(None);
        }
        let mut ledger = Self::default();
        for line in read_text(path, MAX_LEDGER)?.lines() {
            if let Some(run) = line.strip_prefix(RUN) {
                run.clone_into(&mut ledger.run);
            } else if let Some((sum, name)) = line.strip_prefix(FILE).and_then(parse) {
                // The last line about a file counts.
                ledger.files.insert(name.to_owned(), sum);
            }
        }
        Ok(Some(ledger))
    }

    /// Returns whether the list names no file.
    pub(crate) fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Returns the first listed file that was changed.
    pub(crate) fn changed(&self, folder: &Path) -> Option<&str> {
        let is_there = |name: &&String| fs::symlink_metadata(folder.join(name)).is_ok();
        let mut names = self.files.keys().filter(is_there);
        names.find(|name| !self.is_as_written(folder, name)).map(String::as_str)
    }

    /// Returns whether covmap wrote a file of this name.
    pub(crate) fn lists(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// Returns whether a file in `folder` is as covmap wrote it.
    pub(crate) fn is_as_written(&self, folder: &Path, name: &str) -> bool {
        let path = folder.join(name);
        let is_file = fs::symlink_metadata(&path).is_ok_and(|file| file.is_file());
        is_file && self.files.get(name).is_some_and(|sum| self::sum(&path).is_ok_and(|s| s == *sum))
    }
}

/// Returns the line that names the run.
pub(crate) fn run_line(run: &str) -> String {
    format!("{RUN}{}\n", crate::escaped(run))
}

/// Returns the line about a file as it is now.
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

/// Returns the size and the CRC of a file. A CRC detects the changes of users, who do not forge one.
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
