//! Files that are written whole or not at all.

use crate::FileError;
use crate::read::kind_of;
use std::ffi::OsString;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

/// The files and folders that may be replaced. Links, devices, and folders that covmap did not
/// write are never replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replace {
    /// A file only by the same bytes; a folder only by the same run.
    Same,
    /// Any file; any folder that covmap wrote.
    Any,
}

impl Replace {
    /// Returns `Any` if the user asked for it, else `Same`.
    pub fn if_forced(force: bool) -> Self {
        if force { Self::Any } else { Self::Same }
    }
}

/// A file in the making: written beside its place, on the disk before it gets its name, and removed
/// if it is dropped before [`finish`](Self::finish).
///
/// No existing file is opened for writing: no link is followed, and no other name of a file changes with it.
#[derive(Debug)]
pub struct NewFile {
    path: PathBuf,
    replace: Replace,
    partial: PathBuf,
    out: BufWriter<File>,
}

impl NewFile {
    /// Begins a file under an unused name: `FILE.partial`, or with a number behind it.
    ///
    /// # Errors
    /// If the name of the new file belongs to something that is no file, or to a file that must not
    /// be written; if the new file cannot be made.
    pub fn create(path: impl AsRef<Path>, replace: Replace) -> Result<Self, FileError> {
        let path = path.as_ref().to_path_buf();
        if path.file_name().is_none() {
            return Err(refused(&path, "it is not a file name"));
        }
        present(&path)?;
        let (partial, file) = fresh(&path).map_err(FileError::io(&path, "written"))?;
        Ok(Self { path, replace, partial, out: BufWriter::new(file) })
    }

    /// Gives the file its name, once all of it is on the disk.
    ///
    /// # Errors
    /// If the file cannot be written, or must not replace an existing one. Nothing of it is left then.
    pub fn finish(mut self) -> Result<(), FileError> {
        let path = self.path.clone();
        let written = || FileError::io(&path, "written");
        self.out.flush().map_err(written())?;
        self.out.get_ref().sync_all().map_err(written())?;
        if let Some(old) = present(&path)? {
            if self.replace == Replace::Same {
                let same = same(&path, &self.partial).map_err(FileError::io(&path, "read"))?;
                return if same { Ok(()) } else { Err(FileError::Exists { path }) };
            }
            // A user that could not read the old file cannot read the new one.
            let _ = self.out.get_ref().set_permissions(old.permissions());
        }
        fs::rename(&self.partial, &path).map_err(written())?;
        sync_folder(&path);
        Ok(())
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        // After a rename there is no such file; one that cannot be removed stays.
        let _ = fs::remove_file(&self.partial);
    }
}

/// Writes a whole file.
///
/// # Errors
/// As [`NewFile::create`] and [`NewFile::finish`].
pub fn write_file(path: impl AsRef<Path>, bytes: &[u8], replace: Replace) -> Result<(), FileError> {
    let path = path.as_ref();
    let mut file = NewFile::create(path, replace)?;
    file.write_all(bytes).map_err(FileError::io(path, "written"))?;
    file.finish()
}

/// Makes a file under an unused name: not even a link to nowhere has it.
pub(crate) fn create_new(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).create_new(true).open(path)
}

/// Returns the metadata of a file, without following links; `None` if nothing has the name.
fn present(path: &Path) -> Result<Option<Metadata>, FileError> {
    let metadata = match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        metadata => metadata.map_err(FileError::io(path, "written"))?,
    };
    if !metadata.is_file() {
        let kind = kind_of(metadata.file_type());
        return Err(refused(path, &format!("it is {kind}, which is not replaced")));
    }
    if metadata.permissions().readonly() {
        return Err(refused(path, "it exists and must not be written"));
    }
    Ok(Some(metadata))
}

fn refused(path: &Path, reason: &str) -> FileError {
    FileError::Unwritable { path: path.to_path_buf(), message: reason.to_owned() }
}

/// Makes a new file beside a path.
fn fresh(path: &Path) -> io::Result<(PathBuf, File)> {
    let mut tried = 0;
    loop {
        let mut name = OsString::from(path);
        name.push(".partial");
        if tried > 0 {
            name.push(format!("-{tried}"));
        }
        let partial = PathBuf::from(name);
        match create_new(&partial) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && tried < 100 => tried += 1,
            file => return Ok((partial, file?)),
        }
    }
}

/// Returns whether two files hold the same bytes.
fn same(one: &Path, other: &Path) -> io::Result<bool> {
    let (one, other) = (File::open(one)?, File::open(other)?);
    if one.metadata()?.len() != other.metadata()?.len() {
        return Ok(false);
    }
    let mut others = BufReader::new(other).bytes();
    for byte in BufReader::new(one).bytes() {
        if others.next().transpose()? != Some(byte?) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Flushes the names in the folder of a file to the disk, where the system can do that.
pub(crate) fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[track_caller]
    fn refuse(path: &Path, replace: Replace, expected: &str) {
        let before = names(path.parent().unwrap());
        let error = write_file(path, b"new", replace).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(names(path.parent().unwrap()), before);
    }

    #[test]
    fn a_file_has_its_name_only_when_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let mut file = NewFile::create(&path, Replace::Same).unwrap();
        file.write_all(b"x,y\n").unwrap();
        assert_eq!(names(folder.path()), ["a.csv.partial"]);
        file.finish().unwrap();
        assert_eq!(names(folder.path()), ["a.csv"]);
        let mut file = NewFile::create(&path, Replace::Any).unwrap();
        file.write_all(b"cut").unwrap();
        drop(file);
        assert_eq!(names(folder.path()), ["a.csv"]);
        assert_eq!(fs::read(&path).unwrap(), b"x,y\n");
    }

    #[test]
    fn a_file_that_is_there_stays_unless_it_is_to_be_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("truth.ron");
        fs::write(&path, "corrected by hand").unwrap();
        refuse(&path, Replace::Same, "truth.ron: is there already and holds something else");
        assert_eq!(fs::read(&path).unwrap(), b"corrected by hand");
        write_file(&path, b"corrected by hand", Replace::Same).unwrap();
        write_file(&path, b"new", Replace::Any).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["truth.ron"]);
    }

    #[test]
    fn a_file_of_somebody_that_is_called_partial_stays() {
        let folder = tempfile::tempdir().unwrap();
        let mine = folder.path().join("a.csv.partial");
        fs::write(&mine, "mine").unwrap();
        write_file(folder.path().join("a.csv"), b"new", Replace::Same).unwrap();
        assert_eq!(names(folder.path()), ["a.csv", "a.csv.partial"]);
        assert_eq!(fs::read(mine).unwrap(), b"mine");
    }

    #[test]
    fn what_is_no_file_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("folder")).unwrap();
        refuse(&folder.path().join("folder"), Replace::Any, "it is a folder");
        for name in ["none/a.csv", "folder/.."] {
            let error = write_file(folder.path().join(name), b"", Replace::Any).unwrap_err();
            assert!(error.to_string().contains(&format!("{name}: cannot be written")), "{error}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn no_link_is_followed_and_no_other_name_of_a_file_changes() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("mine"), "mine").unwrap();
        for (link, to) in [("link", "mine"), ("nowhere", "none"), ("a.partial", "mine")] {
            symlink(to, path(link)).unwrap();
        }
        refuse(&path("link"), Replace::Any, "it is a symbolic link");
        refuse(&path("nowhere"), Replace::Any, "it is a symbolic link");
        fs::hard_link(path("mine"), path("a")).unwrap();
        write_file(path("a"), b"new", Replace::Any).unwrap();
        assert_eq!(fs::read(path("mine")).unwrap(), b"mine");
        assert_eq!(fs::read(path("a")).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["a", "a.partial", "link", "mine", "nowhere"]);
    }

    #[cfg(unix)]
    #[test]
    fn the_permissions_of_what_is_replaced_are_kept() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let allow = |mode| fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
        fs::write(&path, "old").unwrap();
        allow(0o444);
        refuse(&path, Replace::Any, "must not be written");
        allow(0o600);
        write_file(&path, b"new", Replace::Any).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
    }
}
