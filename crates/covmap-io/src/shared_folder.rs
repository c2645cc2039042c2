//! A folder into which covmap writes file by file, beside the files of others.

use crate::FileError;
use crate::ledger::{Ledger, file_line};
use crate::new_file::{Replace, create_new, write_file};
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The list of the files that covmap wrote. A folder with this list is not replaced whole.
const LIST: &str = ".covmap-files";

/// A folder that holds figures and tables, and perhaps other files.
///
/// An unchanged file of covmap is replaced by a new one of the same name; any other file only by
/// [`Replace::Any`].
#[derive(Debug, Clone)]
pub struct SharedFolder {
    dir: PathBuf,
    replace: Replace,
}

impl SharedFolder {
    /// Opens a folder, and makes it if it is not there.
    ///
    /// # Errors
    /// If the folder cannot be made.
    pub fn open(dir: impl AsRef<Path>, replace: Replace) -> Result<Self, FileError> {
        let dir = dir.as_ref().to_path_buf();
        fs::create_dir_all(&dir).map_err(FileError::io(&dir, "made"))?;
        Ok(Self { dir, replace })
    }

    /// Returns the folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Returns the path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// If the file cannot be written, or must not replace an existing one.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        let replace = if self.is_ours(name)? { Replace::Any } else { self.replace };
        write_file(self.path(name), bytes, replace)?;
        self.list(name).map_err(FileError::io(&self.path(LIST), "written"))
    }

    /// Removes an unchanged file of covmap; any other file only if it may be replaced.
    ///
    /// # Errors
    /// If the file cannot be removed.
    pub fn remove(&self, name: &str) -> Result<(), FileError> {
        let path = self.path(name);
        if fs::symlink_metadata(&path).is_err() {
            return Ok(());
        }
        if !self.is_ours(name)? && self.replace == Replace::Same {
            return Err(FileError::Exists { path });
        }
        fs::remove_file(&path).map_err(FileError::io(&path, "removed"))
    }

    fn is_ours(&self, name: &str) -> Result<bool, FileError> {
        let ledger = Ledger::read(&self.path(LIST))?;
        Ok(ledger.is_some_and(|ledger| ledger.is_as_written(&self.dir, name)))
    }

    /// Appends a line to the list; several processes may do so at once.
    fn list(&self, name: &str) -> io::Result<()> {
        let path = self.path(LIST);
        let mut list = match create_new(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                if !fs::symlink_metadata(&path)?.is_file() {
                    return Err(io::Error::other("it is not a file of covmap"));
                }
                OpenOptions::new().append(true).open(&path)?
            }
            list => list?,
        };
        list.write_all(file_line(&self.dir, name)?.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_replace_those_of_covmap_and_no_others() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("figure1.svg"), "mine").unwrap();
        let folder = SharedFolder::open(root.path(), Replace::Same).unwrap();
        let read = |name: &str| fs::read_to_string(folder.path(name)).unwrap();
        assert!(matches!(folder.write("figure1.svg", b"new"), Err(FileError::Exists { .. })));
        assert!(matches!(folder.remove("figure1.svg"), Err(FileError::Exists { .. })));
        assert_eq!(read("figure1.svg"), "mine");
        folder.write("figure2.svg", b"old").unwrap();
        folder.write("figure2.svg", b"new").unwrap();
        assert_eq!(read("figure2.svg"), "new");
        fs::write(folder.path("figure2.svg"), "corrected").unwrap();
        assert!(folder.write("figure2.svg", b"newer").is_err());
        let forced = SharedFolder::open(root.path(), Replace::Any).unwrap();
        forced.write("figure2.svg", b"newer").unwrap();
        assert_eq!(read("figure2.svg"), "newer");
        folder.remove("figure2.svg").unwrap();
        folder.remove("figure2.svg").unwrap();
        assert!(!folder.path("figure2.svg").exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_list_that_is_a_link_is_not_followed() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("mine"), "mine").unwrap();
        std::os::unix::fs::symlink("mine", root.path().join(LIST)).unwrap();
        let folder = SharedFolder::open(root.path(), Replace::Any).unwrap();
        assert!(folder.write("a.csv", b"").is_err());
        assert_eq!(fs::read_to_string(root.path().join("mine")).unwrap(), "mine");
    }
}
