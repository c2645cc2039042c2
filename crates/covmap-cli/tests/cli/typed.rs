//! Commands, typed in a folder of their own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A folder for commands.
pub(crate) struct Shell {
    folder: TempDir,
}

/// The output of a command, and its exit code.
#[derive(Debug)]
pub(crate) struct Typed {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Shell {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// Returns the command of a line; words are separated by blanks.
    pub(crate) fn command(&self, line: &str) -> Command {
        let mut command = Command::new(crate::PROGRAM);
        command.args(line.split_whitespace()).current_dir(self.folder.path());
        command
    }

    pub(crate) fn type_in(&self, line: &str) -> Typed {
        let Output { status, stdout, stderr } = self.command(line).output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Typed { code: status.code(), out: text(stdout), err: text(stderr) }
    }

    /// Types a line that must end with a code.
    #[track_caller]
    pub(crate) fn expect(&self, line: &str, code: i32) -> Typed {
        let typed = self.type_in(line);
        assert_eq!(typed.code, Some(code), "{line}: {typed:?}");
        typed
    }

    /// Types a line that must be refused in one sentence with these parts, and must leave no files.
    #[track_caller]
    pub(crate) fn refuse(&self, line: &str, parts: &[&str]) {
        let before = self.files();
        let Typed { code, out, err } = self.type_in(line);
        assert_eq!(code, Some(2), "{line}: {err}");
        assert!(err.starts_with("error: ") && err.ends_with('\n'), "{line}: {err}");
        assert_eq!(err.lines().count(), 1, "{line}: {err}");
        assert!(!err.contains("panicked") && out.is_empty(), "{line}: {err}{out}");
        for part in parts {
            assert!(err.contains(part), "{line}: no `{part}` in: {err}");
        }
        assert_eq!(self.files(), before, "{line}");
    }

    /// Returns all files and folders, by their paths.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let mut found = Vec::new();
        collect(self.folder.path(), &mut found);
        found.sort();
        found
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(self.path(name)).unwrap()).unwrap()
    }
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        }
        found.push(path);
    }
}

/// Returns a file of the repository.
pub(crate) fn shipped(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let root = root.into_iter().find(|folder| folder.join("configs").exists()).unwrap();
    root.join(name).to_str().unwrap().to_owned()
}

/// Returns a short exploration of the shipped laboratory, into the folder `run`.
pub(crate) fn short_run() -> String {
    format!("explore {} --resolution 0.2 --max-scans 30 --out run", shipped("scenarios/lab.ron"))
}
