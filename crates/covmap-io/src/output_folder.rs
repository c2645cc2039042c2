//! A folder of results that is there whole or not at all.

use crate::FileError;
use crate::new_file::{Replace, write_file};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// The file by which a folder that covmap wrote is known.
const MARKER: &str = ".covmap";
const MARKER_TEXT: &str = "covmap wrote this folder, and replaces it whole.\n";

/// A folder of results in the making.
///
/// Results are written into `DIR.partial`, which [`finish`](Self::finish) renames to `DIR`.
/// If this is dropped before, `DIR.partial` stays with what was written.
///
/// ```no_run
/// let folder = covmap_io::OutputFolder::create("out/office")?;
/// covmap_io::write_json(folder.path("summary.json"), &("scans", 12))?;
/// let written = folder.finish()?;
/// # Ok::<(), covmap_io::FileError>(())
/// ```
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    partial: PathBuf,
    /// Locked as long as this lives, so that no second covmap writes into the same folder.
    _marker: Option<File>,
}

/// What stands where a folder is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Present {
    Nothing,
    /// A folder that may be replaced: one that covmap wrote, or an empty one.
    Replaceable,
}

impl OutputFolder {
    /// Begins the folder `dir`: makes `DIR.partial`, and the folders above it.
    ///
    /// A stale `DIR.partial` that covmap left is removed.
    ///
    /// # Errors
    /// If `dir` is no name for a folder (`/`, `..`); if it, or `DIR.partial`, is there and is
    /// anything but an empty folder or one that covmap wrote; if another covmap is writing it;
    /// if it cannot be made. Then nothing has changed.
    pub fn create(dir: impl AsRef<Path>) -> Result<Self, FileError> {
        let given = dir.as_ref();
        // Without `.` and slashes at the end.
        let target: PathBuf = given.components().collect();
        if target.file_name().is_none() {
            let reason = "is no name for an output folder";
            return Err(FileError::Folder { path: given.to_path_buf(), reason });
        }
        let (partial, aside) = (beside(&target, ".partial"), beside(&target, ".old"));
        let present = look(&target)?;
        if look(&partial)? == Present::Replaceable {
            drop(lock(&partial)?);
            fs::remove_dir_all(&partial).map_err(FileError::io(&partial, "removed"))?;
        }
        // A `finish` that was cut short between its two renames left the old results aside.
        if present == Present::Nothing && matches!(look(&aside), Ok(Present::Replaceable)) {
            fs::rename(&aside, &target).map_err(FileError::io(&target, "restored"))?;
        }
        fs::create_dir_all(&partial).map_err(FileError::io(&partial, "made"))?;
        write_file(partial.join(MARKER), MARKER_TEXT.as_bytes(), Replace::File)?;
        let marker = lock(&partial)?;
        Ok(Self { target, partial, _marker: marker })
    }

    /// The path of a file of this folder while it is being made.
    pub fn path(&self, name: &str) -> PathBuf {
        self.partial.join(name)
    }

    /// The folder in which files are while it is being made: `DIR.partial`.
    pub fn partial(&self) -> &Path {
        &self.partial
    }

    /// The folder as it will be called: `DIR`.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Gives the folder its name, replacing an old one whole, and returns that name.
    ///
    /// The old folder is renamed, the new one takes its place, and only then the old one is
    /// removed: whatever happens, one of them is there whole. If the old one cannot be
    /// removed, it stays as `DIR.old`.
    ///
    /// # Errors
    /// If something that covmap did not write has come to stand there meanwhile, or a folder
    /// cannot be renamed. Then all results stay in `DIR.partial`.
    pub fn finish(self) -> Result<PathBuf, FileError> {
        let aside = beside(&self.target, ".old");
        let rename_new = || {
            fs::rename(&self.partial, &self.target).map_err(FileError::io(&self.target, "written"))
        };
        if look(&self.target)? == Present::Nothing {
            rename_new()?;
            return Ok(self.target);
        }
        if look(&aside)? == Present::Replaceable {
            fs::remove_dir_all(&aside).map_err(FileError::io(&aside, "removed"))?;
        }
        fs::rename(&self.target, &aside).map_err(FileError::io(&self.target, "replaced"))?;
        if let Err(error) = rename_new() {
            // Back to what was; if even that fails, the old folder is still there, aside.
            let _ = fs::rename(&aside, &self.target);
            return Err(error);
        }
        let _ = fs::remove_dir_all(&aside);
        Ok(self.target)
    }
}

/// The path with something appended to its last name.
fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(suffix);
    PathBuf::from(name)
}

/// Looks whether a folder may be made at `path`, without following links.
fn look(path: &Path) -> Result<Present, FileError> {
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
    let written = fs::symlink_metadata(path.join(MARKER)).is_ok_and(|marker| marker.is_file());
    let mut entries = fs::read_dir(path).map_err(FileError::io(path, "looked at"))?;
    if written || entries.next().is_none() {
        Ok(Present::Replaceable)
    } else {
        refuse("was not written by covmap and is not replaced; name another output folder")
    }
}

/// Locks a folder by its marker, if it has one and the file system has locks.
fn lock(partial: &Path) -> Result<Option<File>, FileError> {
    let Ok(marker) = File::open(partial.join(MARKER)) else {
        return Ok(None);
    };
    match marker.try_lock() {
        Err(fs::TryLockError::WouldBlock) => Err(FileError::Folder {
            path: partial.to_path_buf(),
            reason: "another covmap is writing into this folder",
        }),
        Ok(()) | Err(fs::TryLockError::Error(_)) => Ok(Some(marker)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writes a folder with one file in it.
    fn write(dir: &Path, text: &str) -> Result<PathBuf, FileError> {
        let folder = OutputFolder::create(dir)?;
        write_file(folder.path("a.txt"), text.as_bytes(), Replace::File)?;
        folder.finish()
    }

    #[track_caller]
    fn refuse(dir: &Path, expected: &str) {
        let error = OutputFolder::create(dir).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }

    fn names(folder: &Path) -> Vec<String> {
        let entry = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(entry).map(|n| n.into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_has_its_name_only_when_it_is_finished() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("deep/out");
        let folder = OutputFolder::create(dir.join(".")).unwrap();
        write_file(folder.path("a.txt"), b"a", Replace::File).unwrap();
        assert_eq!(names(dir.parent().unwrap()), ["out.partial"]);
        assert_eq!(folder.finish().unwrap(), dir);
        assert_eq!(names(dir.parent().unwrap()), ["out"]);
        assert_eq!(names(&dir), [".covmap", "a.txt"]);
    }

    #[test]
    fn a_folder_that_covmap_wrote_is_replaced_whole() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        write(&dir, "old").unwrap();
        fs::write(dir.join("b.txt"), "b").unwrap();
        write(&dir, "new").unwrap();
        assert_eq!(names(root.path()), ["out"]);
        assert_eq!(names(&dir), [".covmap", "a.txt"]);
        assert_eq!(fs::read_to_string(dir.join("a.txt")).unwrap(), "new");
    }

    #[test]
    fn what_covmap_did_not_write_is_refused_and_untouched() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("thesis");
        fs::create_dir(&dir).unwrap();
        fs::write(dir.join("chapter1.txt"), "text").unwrap();
        refuse(&dir, "thesis: was not written by covmap and is not replaced");
        refuse(&dir.join("chapter1.txt"), "is a file");
        refuse(&dir.join("chapter1.txt/out"), "chapter1.txt/out");
        assert_eq!(names(root.path()), ["thesis"]);
        assert_eq!(names(&dir), ["chapter1.txt"]);
    }

    #[test]
    fn names_that_are_none_are_refused() {
        for name in ["", ".", "..", "/", "./", "a/..", "a/../.."] {
            refuse(Path::new(name), "is no name for an output folder");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_refused() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("real");
        write(&dir, "kept").unwrap();
        std::os::unix::fs::symlink(&dir, root.path().join("link")).unwrap();
        refuse(&root.path().join("link"), "symbolic link");
        refuse(&root.path().join("link/"), "symbolic link");
        std::os::unix::fs::symlink("nowhere", root.path().join("out.partial")).unwrap();
        refuse(&root.path().join("out"), "symbolic link");
    }

    #[test]
    fn an_empty_folder_may_be_replaced() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        fs::create_dir(&dir).unwrap();
        write(&dir, "new").unwrap();
        assert_eq!(names(root.path()), ["out"]);
    }

    #[test]
    fn what_was_left_unfinished_stays_until_the_next_run() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        let folder = OutputFolder::create(&dir).unwrap();
        write_file(folder.path("a.txt"), b"a", Replace::File).unwrap();
        drop(folder);
        assert_eq!(names(&beside(&dir, ".partial")), [".covmap", "a.txt"]);
        write(&dir, "new").unwrap();
        assert_eq!(names(root.path()), ["out"]);
    }

    #[test]
    fn a_foreign_partial_folder_is_refused() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir(root.path().join("out.partial")).unwrap();
        fs::write(root.path().join("out.partial/mine.txt"), "").unwrap();
        refuse(&root.path().join("out"), "out.partial: was not written by covmap");
    }

    #[test]
    fn two_runs_do_not_write_into_one_folder() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        let first = OutputFolder::create(&dir).unwrap();
        refuse(&dir, "another covmap is writing");
        first.finish().unwrap();
    }

    #[test]
    fn results_are_kept_when_a_stranger_takes_their_place() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        let folder = OutputFolder::create(&dir).unwrap();
        fs::create_dir(&dir).unwrap();
        fs::write(dir.join("mine.txt"), "").unwrap();
        assert!(folder.finish().is_err());
        assert_eq!(names(root.path()), ["out", "out.partial"]);
    }

    #[test]
    fn old_results_return_when_their_replacement_was_cut_short() {
        let root = tempfile::tempdir().unwrap();
        let dir = root.path().join("out");
        write(&dir, "old").unwrap();
        fs::rename(&dir, beside(&dir, ".old")).unwrap();
        drop(OutputFolder::create(&dir).unwrap());
        assert_eq!(fs::read_to_string(dir.join("a.txt")).unwrap(), "old");
    }
}
