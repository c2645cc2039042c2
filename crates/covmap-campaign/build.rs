//! Sets the version of the program: `COVMAP_VERSION` is the version of Cargo and the commit. If the
//! sources differ from the commit (`dirty`), or there is none, it also has a hash of the sources.

use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The sources of the program.
const SOURCES: [&str; 6] =
    ["Cargo.toml", "Cargo.lock", "crates", "configs/fit", "scenarios", "xtask"];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
    }
    let version = match commit(&root) {
        Some((commit, true)) => commit,
        Some((commit, false)) => format!("{commit}.dirty.{}", hash(&root)),
        None => format!("sources.{}", hash(&root)),
    };
    println!("cargo::rustc-env=COVMAP_VERSION={}+{version}", env!("CARGO_PKG_VERSION"));
}

/// The commit, and whether the sources are those of the commit; `None` if this is not a repository
/// of its own, as in a released archive.
fn commit(root: &Path) -> Option<(String, bool)> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let top = PathBuf::from(git(&["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    // Every commit and every checkout adds a line to the log of the head.
    for name in ["HEAD", "logs/HEAD"] {
        let file = root.join(git(&["rev-parse", "--git-path", name])?);
        if file.exists() {
            println!("cargo::rerun-if-changed={}", file.display());
        }
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let status = git(&[&["status", "--porcelain", "--"][..], &SOURCES].concat())?;
    Some((commit, status.is_empty()))
}

/// A hash over the names and the contents of all sources.
fn hash(root: &Path) -> String {
    let mut hasher = Sha256::new();
    for source in SOURCES {
        add(&mut hasher, root, Path::new(source));
    }
    hasher.finalize()[..6].iter().map(|byte| format!("{byte:02x}")).collect()
}

fn add(hasher: &mut Sha256, root: &Path, name: &Path) {
    let path = root.join(name);
    if let Ok(entries) = fs::read_dir(&path) {
        let mut names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
        names.sort();
        names.iter().for_each(|inner| add(hasher, root, &name.join(inner)));
    } else if let Ok(content) = fs::read(&path) {
        hasher.update(format!("{} {}\n", name.display(), content.len()));
        hasher.update(content);
    }
}
