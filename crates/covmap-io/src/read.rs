//! Opening and reading of input files: at once or not at all, and up to a sensible size.

use crate::FileError;
use std::fs::{File, FileType, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// The largest file that is read as a whole \[bytes\].
pub const MAX_FILE: u64 = 64 << 20;

/// Opens a file for reading; a link to a file is followed.
///
/// Pipes, devices, sockets and folders are refused at once: opening or reading them may take for
/// ever. The kind is checked before the file is opened, since opening a device may have effects,
/// and after, since the file may have been exchanged meanwhile.
///
/// # Errors
/// If there is no such file, or it cannot be read.
pub fn open_input(path: impl AsRef<Path>) -> Result<File, FileError> {
    let path = path.as_ref();
    open_file(path).map_err(FileError::io(path, "read"))
}

/// Checks that a file or a folder exists.
///
/// # Errors
/// If there is nothing.
pub fn find(path: impl AsRef<Path>) -> Result<(), FileError> {
    let path = path.as_ref();
    std::fs::metadata(path).map(drop).map_err(FileError::io(path, "read"))
}

/// Opens a file as [`open_input`] does, with the error of the system; [`io::ErrorKind::Other`]
/// means that the path is no file.
///
/// # Errors
/// If there is no such file, or it cannot be read.
pub fn open_file(path: &Path) -> io::Result<File> {
    check(std::fs::metadata(path)?.file_type())?;
    let file = at_once().read(true).open(path)?;
    check(file.metadata()?.file_type())?;
    Ok(file)
}

fn check(kind: FileType) -> io::Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    Err(io::Error::other(format!("it is {}, not a file", kind_of(kind))))
}

/// Returns options that open, and read, without blocking.
fn at_once() -> OpenOptions {
    #[allow(unused_mut, reason = "changed where the flag is known")]
    let mut options = OpenOptions::new();
    /// O_NONBLOCK, for which the standard library has no name.
    #[cfg(all(target_os = "linux", not(any(target_arch = "mips", target_arch = "sparc64"))))]
    const NONBLOCK: i32 = 0o4000;
    #[cfg(any(target_os = "macos", target_os = "freebsd"))]
    const NONBLOCK: i32 = 4;
    #[cfg(any(
        all(target_os = "linux", not(any(target_arch = "mips", target_arch = "sparc64"))),
        target_os = "macos",
        target_os = "freebsd"
    ))]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, NONBLOCK);
    options
}

/// Reads the bytes of a file of at most `limit` bytes.
///
/// The size is checked before anything is read. A file with a false size, such as one of `/proc`,
/// is read no further than the limit.
///
/// # Errors
/// If the file cannot be opened by [`open_input`] or read, or is larger than the limit.
pub fn read_bytes(path: impl AsRef<Path>, limit: u64) -> Result<Vec<u8>, FileError> {
    let path = path.as_ref();
    let too_large = || FileError::TooLarge { path: path.to_path_buf(), limit };
    let file = open_input(path)?;
    let size = file.metadata().map_err(FileError::io(path, "read"))?.len();
    if size > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    file.take(limit + 1).read_to_end(&mut bytes).map_err(FileError::io(path, "read"))?;
    if bytes.len() as u64 > limit {
        return Err(too_large());
    }
    Ok(bytes)
}

/// Reads the first bytes of a file, at most `limit` of them: enough to tell its kind.
///
/// # Errors
/// If the file cannot be read.
pub fn read_beginning(path: impl AsRef<Path>, limit: usize) -> Result<Vec<u8>, FileError> {
    let path = path.as_ref();
    let file = open_input(path)?;
    let mut bytes = Vec::new();
    file.take(limit as u64).read_to_end(&mut bytes).map_err(FileError::io(path, "read"))?;
    Ok(bytes)
}

/// Reads the text of a file of at most `limit` bytes.
///
/// # Errors
/// As [`read_bytes`], and if the file is not UTF-8.
pub fn read_text(path: impl AsRef<Path>, limit: u64) -> Result<String, FileError> {
    let path = path.as_ref();
    String::from_utf8(read_bytes(path, limit)?).map_err(|error| FileError::NotText {
        path: path.to_path_buf(),
        at: error.utf8_error().valid_up_to(),
    })
}

/// Returns the name of a kind that is no file.
pub(crate) fn kind_of(kind: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return "a pipe";
        } else if kind.is_socket() {
            return "a socket";
        } else if kind.is_char_device() || kind.is_block_device() {
            return "a device";
        }
    }
    if kind.is_dir() {
        "a folder"
    } else if kind.is_symlink() {
        "a symbolic link"
    } else {
        "something else"
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;
    use std::os::unix::net::UnixListener;

    #[track_caller]
    fn refuse(path: &Path, expected: &str) {
        let error = open_input(path).unwrap_err().to_string();
        assert_eq!(error, format!("{}: cannot be read: {expected}", path.display()));
    }

    #[test]
    fn what_is_no_file_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let made = std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap();
        assert!(made.success());
        let _listener = UnixListener::bind(path("socket")).unwrap();
        symlink(path("pipe"), path("link")).unwrap();
        symlink(path("loop"), path("loop")).unwrap();
        refuse(folder.path(), "it is a folder, not a file");
        refuse(&path("pipe"), "it is a pipe, not a file");
        refuse(&path("link"), "it is a pipe, not a file");
        refuse(&path("socket"), "it is a socket, not a file");
        refuse(Path::new("/dev/zero"), "it is a device, not a file");
        assert!(open_input(path("none")).unwrap_err().to_string().contains("No such file"));
        assert!(open_input(path("loop")).is_err());
    }

    #[test]
    fn a_pipe_that_takes_the_place_of_a_file_meanwhile_is_not_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        // This would wait for a writer, for ever.
        let opened = at_once().read(true).open(&pipe).unwrap();
        assert!(check(opened.metadata().unwrap().file_type()).is_err());
    }

    #[test]
    fn a_link_to_a_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a"), "text").unwrap();
        symlink("a", folder.path().join("b")).unwrap();
        assert_eq!(read_text(folder.path().join("b"), 4).unwrap(), "text");
    }

    #[test]
    fn the_limit_holds_for_the_size_and_while_reading() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large");
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert!(matches!(read_bytes(&path, 9), Err(FileError::TooLarge { limit: 9, .. })));
        // Its size is said to be 0.
        let proc = Path::new("/proc/self/maps");
        if proc.exists() {
            assert!(matches!(read_bytes(proc, 9), Err(FileError::TooLarge { .. })));
            assert!(!read_text(proc, MAX_FILE).unwrap().is_empty());
        }
    }
}
