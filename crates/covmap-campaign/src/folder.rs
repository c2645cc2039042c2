//! The folder of a campaign: a list of its runs, and a file for each run that is done.
//!
//! The file of a run is there whole or not at all. Each of its three lines has its own
//! checksum: the outcome, the times, and the paths or `null`.

use crate::error::{FolderFault, Result, of_folder};
use crate::paths::Paths;
use crate::record::{RunKey, RunRecord, Value};
use crate::tables;
use covmap_io::{Digest, checksum};
use covmap_io::{FileError, Replace, open_input, read_bytes, read_json, write_file, write_json};
use indexmap::IndexMap;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::io::{BufRead, BufReader, Read, Take};
use std::path::{Path, PathBuf};

const FORMAT: u32 = 1;
const LIST: &str = "campaign.json";
const RUNS: &str = "runs";
const LOCK: &str = "lock";
/// The number of digits of a run's name.
const ID_DIGITS: usize = 32;
/// Largest file of a run, with its paths, that is read \[bytes\].
const LONGEST_RECORD: u64 = 64 << 20;

/// A planned run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Planned {
    /// Key of the run.
    pub key: RunKey,
    /// Hash of everything that the run is a function of; it names the run's file.
    pub id: String,
}

/// List of a campaign's runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of this format.
    covmap_campaign: u32,
    /// Name of the campaign.
    pub name: String,
    /// Hash of all runs, without the version of the program.
    campaign: String,
    /// Version of the program.
    pub version: String,
    /// The metrics of the summary.
    pub metrics: Vec<String>,
    /// All runs, in order.
    pub runs: Vec<Planned>,
}

impl Manifest {
    /// Returns the list of a campaign. Names in `runs` do not depend on the program; those in the list do.
    pub fn new(name: &str, metrics: &[String], runs: Vec<Planned>, version: &str) -> Self {
        let mut all = metrics.iter().fold(Digest::default().with(name), Digest::with);
        for Planned { key, id } in &runs {
            all = all.with(key.to_string()).with(id);
        }
        let named = |Planned { key, id }| {
            let id = Digest::default().with(FORMAT.to_le_bytes()).with(version).with(id).finish();
            Planned { key, id }
        };
        Self {
            covmap_campaign: FORMAT,
            name: name.to_owned(),
            campaign: all.finish(),
            version: version.to_owned(),
            metrics: metrics.to_vec(),
            runs: runs.into_iter().map(named).collect(),
        }
    }

    /// Reads the list in a folder; `None` if the folder has no list.
    ///
    /// # Errors
    /// If the list cannot be read, or is of another format.
    pub fn read(dir: &Path) -> Result<Option<Self>> {
        let file = dir.join(LIST);
        if !file.exists() {
            return Ok(None);
        }
        let manifest: Self = read_json(&file)?;
        let format = manifest.covmap_campaign;
        if format != FORMAT {
            return Err(of_folder(&file, FolderFault::Format { found: format, known: FORMAT }));
        }
        Ok(Some(manifest))
    }

    /// Whether both lists are of the same campaign, with any version of the program.
    pub fn is_campaign(&self, other: &Self) -> bool {
        self.campaign == other.campaign
    }
}

/// A folder that only this process writes.
#[derive(Debug)]
pub(crate) struct Folder {
    dir: PathBuf,
    _lock: File,
}

/// The outcome of a run, with the name of its file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Outcome {
    id: String,
    key: RunKey,
    values: IndexMap<String, Value>,
}

impl Folder {
    /// Makes a folder for a campaign, or opens one of the same campaign.
    ///
    /// # Errors
    /// If something else is there, or another process writes the folder. Then nothing has changed.
    pub(crate) fn open(dir: &Path, manifest: &Manifest) -> Result<Self> {
        Self::check(dir, manifest)?;
        let runs = dir.join(RUNS);
        if fs::symlink_metadata(&runs).is_ok_and(|runs| runs.is_symlink()) {
            return Err(of_folder(&runs, FolderFault::Link));
        }
        fs::create_dir_all(dir).map_err(FileError::io(dir, "made"))?;
        let lock = lock(dir)?;
        fs::create_dir_all(&runs).map_err(FileError::io(&runs, "made"))?;
        for entry in fs::read_dir(&runs).map_err(FileError::io(&runs, "read"))?.flatten() {
            if is_in_flight(&entry.file_name().to_string_lossy()) {
                // If the entry is a link, only the link is removed.
                let _ = fs::remove_file(entry.path());
            }
        }
        let folder = Self { dir: dir.to_owned(), _lock: lock };
        if Manifest::read(dir)?.as_ref() != Some(manifest) {
            tables::remove(dir)?;
            let list = dir.join(LIST);
            write_json(&list, manifest)?;
        }
        Ok(folder)
    }

    /// Checks that a folder may be made or opened for a campaign, without changing anything.
    ///
    /// # Errors
    /// If something else is there.
    pub(crate) fn check(dir: &Path, manifest: &Manifest) -> Result<()> {
        match Manifest::read(dir)? {
            Some(present) if !present.is_campaign(manifest) => {
                Err(of_folder(dir, FolderFault::OtherCampaign(present.name)))
            }
            None if is_foreign(dir)? => Err(of_folder(dir, FolderFault::Foreign)),
            _ => Ok(()),
        }
    }

    /// The number of files that other versions of the program wrote.
    pub(crate) fn strangers(&self, manifest: &Manifest) -> Result<usize> {
        let ids: std::collections::BTreeSet<&str> =
            manifest.runs.iter().map(|run| run.id.as_str()).collect();
        let runs = self.dir.join(RUNS);
        let entries = fs::read_dir(&runs).map_err(FileError::io(&runs, "read"))?;
        let known = |entry: &fs::DirEntry| {
            entry.path().file_stem().and_then(|id| id.to_str()).is_some_and(|id| ids.contains(id))
        };
        Ok(entries.flatten().filter(|entry| !known(entry)).count())
    }

    /// Writes the file of a run; when this returns, the file is on the disk.
    pub(crate) fn write(&self, id: &str, record: &RunRecord, paths: Option<&Paths>) -> Result<()> {
        let RunRecord { key, values, times } = record.clone();
        let outcome = Outcome { id: id.to_owned(), key, values };
        let lines = [
            serde_json::to_string(&outcome)?,
            serde_json::to_string(&times)?,
            serde_json::to_string(&paths)?,
        ];
        let text: String =
            lines.iter().map(|line| format!("{} {line}\n", checksum(line))).collect();
        let file = file(&self.dir, id);
        replace(&file, text.as_bytes())
    }
}

/// The record of a run in a folder.
#[derive(Debug)]
pub(crate) enum Recorded {
    Whole(Box<RunRecord>),
    Missing,
    /// The run's file is damaged.
    Damaged(PathBuf),
}

impl Recorded {
    /// The run, if it is whole.
    pub(crate) fn whole(self) -> Option<RunRecord> {
        match self {
            Self::Whole(record) => Some(*record),
            Self::Missing | Self::Damaged(_) => None,
        }
    }
}

/// Reads the record of a run; checks its paths only if `with_paths`.
pub(crate) fn read(dir: &Path, planned: &Planned, with_paths: bool) -> Recorded {
    let file = file(dir, &planned.id);
    if fs::symlink_metadata(&file).is_err() {
        return Recorded::Missing;
    }
    let record = (|| {
        let mut lines = Lines::open(&file)?;
        let outcome: Outcome = lines.next()?;
        let times = lines.next()?;
        if with_paths {
            lines.skip()?;
        }
        let same = outcome.id == planned.id && outcome.key == planned.key;
        same.then_some(RunRecord { key: outcome.key, values: outcome.values, times })
    })();
    record.map_or(Recorded::Damaged(file), |record| Recorded::Whole(Box::new(record)))
}

/// Reads the records of some runs in parallel, in their order.
pub(crate) fn read_all(dir: &Path, runs: &[&Planned], with_paths: bool) -> Vec<Recorded> {
    runs.par_iter().map(|planned| read(dir, planned, with_paths)).collect()
}

/// Reads the paths of a run in the folder of a campaign that keeps them.
///
/// # Errors
/// If there is no such run, if it has no paths, or if its file is damaged.
pub fn load_paths(dir: &Path, key: &RunKey) -> Result<Paths> {
    let none = || of_folder(dir, FolderFault::NoPaths(Box::new(key.clone())));
    let manifest = Manifest::read(dir)?.ok_or_else(none)?;
    let planned = manifest.runs.iter().find(|run| run.key == *key).ok_or_else(none)?;
    let paths = Lines::open(&file(dir, &planned.id)).and_then(|mut lines| {
        lines.next::<Outcome>()?;
        lines.next::<IndexMap<String, f64>>()?;
        lines.next::<Option<Paths>>()
    });
    let damaged = || of_folder(dir, FolderFault::Damaged(Box::new(key.clone())));
    paths.ok_or_else(damaged)?.ok_or_else(none)
}

/// The lines of a file of at most [`LONGEST_RECORD`] bytes, each checked.
struct Lines(BufReader<Take<File>>);

impl Lines {
    fn open(file: &Path) -> Option<Self> {
        let file = open_input(file).ok()?;
        let length = file.metadata().ok()?.len();
        (length <= LONGEST_RECORD).then(|| Self(BufReader::new(file.take(LONGEST_RECORD))))
    }

    fn next<T: serde::de::DeserializeOwned>(&mut self) -> Option<T> {
        self.checked(|line| serde_json::from_str(line).ok())
    }

    /// Checks a line without parsing it.
    fn skip(&mut self) -> Option<()> {
        self.checked(|_| Some(()))
    }

    fn checked<T>(&mut self, of: impl FnOnce(&str) -> Option<T>) -> Option<T> {
        let mut text = String::new();
        self.0.read_line(&mut text).ok()?;
        let (sum, line) = text.strip_suffix('\n')?.split_once(' ')?;
        if sum == checksum(line) { of(line) } else { None }
    }
}

fn file(dir: &Path, id: &str) -> PathBuf {
    dir.join(RUNS).join(format!("{id}.run"))
}

/// Copies the file of a run from one folder into another.
pub(crate) fn copy(from: &Path, to: &Folder, id: &str) -> Result<()> {
    let (from, to) = (file(from, id), file(&to.dir, id));
    replace(&to, &read_bytes(from, LONGEST_RECORD)?)
}

/// Writes the file of a run; replaces a damaged one. A link in the file's place is removed, and the
/// target of the link stays.
fn replace(file: &Path, bytes: &[u8]) -> Result<()> {
    if fs::symlink_metadata(file).is_ok_and(|there| there.is_symlink()) {
        fs::remove_file(file).map_err(FileError::io(file, "removed"))?;
    }
    Ok(write_file(file, bytes, Replace::Any)?)
}

/// Whether a name is that of a run's file that was not finished when the process was killed, as this
/// version or an earlier one named it.
fn is_in_flight(name: &str) -> bool {
    let Some((id, _)) = name.split_once(".run.partial").or(name.split_once(".partial")) else {
        return false;
    };
    id.len() == ID_DIGITS && id.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// Whether a folder holds something that no campaign wrote.
fn is_foreign(dir: &Path) -> Result<bool> {
    match fs::read_dir(dir) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(FileError::io(dir, "read")(error).into()),
        // A process that was killed early leaves only these.
        Ok(entries) => {
            let ours = [RUNS, LOCK, "campaign.partial", "campaign.json.partial"];
            Ok(entries.flatten().any(|e| !ours.iter().any(|name| e.file_name() == *name)))
        }
    }
}

fn lock(dir: &Path) -> Result<File> {
    let path = dir.join(LOCK);
    let lock = match File::create_new(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
            // The file is only locked, not written, but a link may lead to anything.
            if !fs::symlink_metadata(&path).is_ok_and(|lock| lock.is_file()) {
                return Err(of_folder(&path, FolderFault::Lock));
            }
            open_input(&path)?
        }
        lock => lock.map_err(FileError::io(&path, "written"))?,
    };
    match lock.try_lock() {
        Err(TryLockError::WouldBlock) => Err(of_folder(dir, FolderFault::Busy)),
        // There are file systems without locks.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(lock),
    }
}
