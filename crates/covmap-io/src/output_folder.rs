//! A folder of results that is written whole or not at all.

use crate::FileError;
use crate::ledger::{Ledger, file_line, run_line};
use crate::new_file::{Replace, create_new, sync_folder};
use crate::read::open_input;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The file that marks a folder as written by covmap, with the list of the files that covmap wrote.
const MARKER: &str = ".covmap";
/// Suffix of the old folder while the new one takes its place. No user gives such a name, so covmap
/// takes a folder of this name for its own.
const ASIDE: &str = ".covmap-old";
const MARKER_TEXT: &str = "covmap wrote this folder; the same run replaces it\n";

/// A folder of results in the making.
///
/// Results are written into `DIR.partial`, which [`finish`](Self::finish) renames to `DIR`. A
/// folder that is dropped before stays as `DIR.partial`.
///
/// ```no_run
/// use covmap_io::{OutputFolder, Replace, write_json};
/// let folder = OutputFolder::create("out/office", "office, seed 1", Replace::Same)?;
/// write_json(folder.path("summary.json"), &("scans", 12))?;
/// let written = folder.finish()?;
/// # Ok::<(), covmap_io::FileError>(())
/// ```
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    partial: PathBuf,
    run: String,
    replace: Replace,
    /// Locked as long as the folder is in the making, so that no second covmap writes into it.
    marker: File,
}

/// The state of the place of a folder.
#[derive(Debug, PartialEq)]
enum Present {
    Nothing,
    /// A folder that may be replaced: one that covmap wrote, or an empty one.
    Replaceable(Ledger),
}

impl OutputFolder {
    /// Begins the folder `dir`: makes `DIR.partial`, and the folders above it.
    ///
    /// `run` names, in one line, everything on which the results depend. A folder of the same run
    /// is replaced, unless a file that covmap wrote was changed; files of others move into the new
    /// folder. A folder of another run is replaced, whole, only by [`Replace::Any`]. A stale
    /// `DIR.partial` is treated alike.
    ///
    /// # Errors
    /// If `dir` is no name for a folder (`/`, `..`); if `dir` or `DIR.partial` exists and must not
    /// be replaced; if another covmap is writing the folder; if the folder cannot be made. Nothing
    /// has changed then.
    pub fn create(dir: impl AsRef<Path>, run: &str, replace: Replace) -> Result<Self, FileError> {
        let given = dir.as_ref();
        // Without `.` and slashes at the end.
        let target: PathBuf = given.components().collect();
        if target.file_name().is_none() {
            let reason = "is no name for an output folder";
            return Err(FileError::Folder { path: given.to_path_buf(), reason });
        }
        let (partial, aside) = (beside(&target, ".partial"), beside(&target, ASIDE));
        let run = crate::escaped(run).to_string();
        if let Ok(marker) = open_input(partial.join(MARKER)) {
            lock(&partial, &marker)?;
        }
        let present = look(&target, &run, replace)?;
        if look(&partial, &run, replace)? != Present::Nothing {
            fs::remove_dir_all(&partial).map_err(FileError::io(&partial, "removed"))?;
        }
        // A `finish` that was cut short between its two renames left the old results aside.
        if present == Present::Nothing && look(&aside, &run, Replace::Any).is_ok_and(is_there) {
            fs::rename(&aside, &target).map_err(FileError::io(&target, "restored"))?;
            look(&target, &run, replace)?;
        }
        fs::create_dir_all(&partial).map_err(FileError::io(&partial, "made"))?;
        let path = partial.join(MARKER);
        let mut marker = create_new(&path).map_err(FileError::io(&path, "written"))?;
        lock(&partial, &marker)?;
        let text = format!("{MARKER_TEXT}{}", run_line(&run));
        marker.write_all(text.as_bytes()).map_err(FileError::io(&path, "written"))?;
        Ok(Self { target, partial, run, replace, marker })
    }

    /// Returns the path of a file of this folder while the folder is in the making.
    pub fn path(&self, name: &str) -> PathBuf {
        self.partial.join(name)
    }

    /// Returns the folder that holds the files while they are made: `DIR.partial`.
    pub fn partial(&self) -> &Path {
        &self.partial
    }

    /// Returns the final name of the folder: `DIR`.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Gives the folder its name, once all of it is on the disk, and returns that name. An old
    /// folder is replaced.
    ///
    /// The old folder is renamed, the new one takes its place, and only then is the old one removed: one of
    /// them is always there whole. An old folder that cannot be removed stays as `DIR.covmap-old`.
    ///
    /// # Errors
    /// If something that must not be replaced has taken the name meanwhile, or a folder cannot be
    /// renamed. All results stay in `DIR.partial` then.
    pub fn finish(mut self) -> Result<PathBuf, FileError> {
        self.list().map_err(FileError::io(&self.partial, "written"))?;
        let aside = beside(&self.target, ASIDE);
        let rename_new = || {
            fs::rename(&self.partial, &self.target).map_err(FileError::io(&self.target, "written"))
        };
        let Present::Replaceable(old) = look(&self.target, &self.run, self.replace)? else {
            rename_new()?;
            sync_folder(&self.target);
            return Ok(self.target);
        };
        if self.replace == Replace::Same {
            self.carry_over(&old)?;
        }
        if is_there(look(&aside, &self.run, Replace::Any)?) {
            fs::remove_dir_all(&aside).map_err(FileError::io(&aside, "removed"))?;
        }
        fs::rename(&self.target, &aside).map_err(FileError::io(&self.target, "replaced"))?;
        if let Err(error) = rename_new() {
            // Restores the old folder; if even that fails, it is still there, aside.
            let _ = fs::rename(&aside, &self.target);
            return Err(error);
        }
        sync_folder(&self.target);
        let _ = fs::remove_dir_all(&aside);
        Ok(self.target)
    }

    /// Lists all files in the marker, and flushes them to the disk.
    fn list(&mut self) -> io::Result<()> {
        for name in names(&self.partial)?.iter().filter_map(|name| name.to_str()) {
            if name != MARKER {
                File::open(self.partial.join(name))?.sync_all()?;
                self.marker.write_all(file_line(&self.partial, name)?.as_bytes())?;
            }
        }
        self.marker.sync_all()
    }

    /// Links or copies the files of others from the old folder into the new one. They are in both
    /// until the old one is removed.
    fn carry_over(&self, old: &Ledger) -> Result<(), FileError> {
        for name in strangers(&self.target, old)? {
            let (from, to) = (self.target.join(&name), self.partial.join(&name));
            if fs::hard_link(&from, &to).is_err() {
                let copy = create_new(&to).and_then(|mut to| {
                    io::copy(&mut File::open(&from)?, &mut to)?;
                    to.sync_all()
                });
                copy.map_err(FileError::io(&to, "written"))?;
            }
        }
        Ok(())
    }
}

fn is_there(present: Present) -> bool {
    present != Present::Nothing
}

/// Returns the path with something appended to its last name.
fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(suffix);
    PathBuf::from(name)
}

/// Checks whether a folder may be made at `path`, without following links.
fn look(path: &Path, run: &str, replace: Replace) -> Result<Present, FileError> {
    let refuse = |reason| Err(FileError::Folder { path: path.to_path_buf(), reason });
    let kind = match fs::symlink_metadata(path) {
        Ok(metadata) => metadata.file_type(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Present::Nothing),
        Err(error) => return Err(FileError::io(path, "looked at")(error)),
    };
    if kind.is_symlink() {
        return refuse("is a symbolic link, not an output folder");
    }
    if !kind.is_dir() {
        return refuse("is a file, not an output folder");
    }
    let names = names(path).map_err(FileError::io(path, "looked at"))?;
    if names.iter().all(|name| name == MARKER) {
        // Nothing can be lost: a full disk may leave no more than an empty marker.
        return Ok(Present::Replaceable(Ledger::default()));
    }
    let Some(ledger) = Ledger::read(&path.join(MARKER))? else {
        return refuse("was not written by covmap and is not replaced; name another output folder");
    };
    if replace == Replace::Same {
        check(path, &ledger, run)?;
    }
    Ok(Present::Replaceable(ledger))
}

/// Checks that a folder holds the same run, that the files which covmap wrote there are unchanged,
/// and that all else are files, which can be carried over.
fn check(path: &Path, ledger: &Ledger, run: &str) -> Result<(), FileError> {
    if ledger.run != run {
        return Err(FileError::OtherRun { path: path.to_path_buf(), run: ledger.run.clone() });
    }
    if let Some(name) = ledger.changed(path) {
        return Err(FileError::NotOurs { path: path.join(name) });
    }
    for name in strangers(path, ledger)? {
        let file = path.join(name);
        if !fs::symlink_metadata(&file).is_ok_and(|file| file.is_file()) {
            return Err(FileError::NotOurs { path: file });
        }
    }
    Ok(())
}

/// Returns the names that others put into a folder. An unfinished folder has no list; everything in
/// it is taken for covmap's.
fn strangers(folder: &Path, ledger: &Ledger) -> Result<Vec<OsString>, FileError> {
    let mut names = names(folder).map_err(FileError::io(folder, "looked at"))?;
    names.retain(|name| {
        let ours = |name: &str| name == MARKER || ledger.is_empty() || ledger.lists(name);
        !name.to_str().is_some_and(ours)
    });
    Ok(names)
}

fn names(folder: &Path) -> io::Result<Vec<OsString>> {
    let name = |entry: io::Result<fs::DirEntry>| entry.map(|entry| entry.file_name());
    let mut names = fs::read_dir(folder)?.map(name).collect::<io::Result<Vec<_>>>()?;
    names.sort();
    Ok(names)
}

/// Locks a folder by its marker, where the file system has locks.
fn lock(partial: &Path, marker: &File) -> Result<(), FileError> {
    match marker.try_lock() {
        Err(fs::TryLockError::WouldBlock) => Err(FileError::Folder {
            path: partial.to_path_buf(),
            reason: "another covmap is writing into this folder",
        }),
        Ok(()) | Err(fs::TryLockError::Error(_)) => Ok(()),
    }
}

#[cfg(test)]
mod tests;
