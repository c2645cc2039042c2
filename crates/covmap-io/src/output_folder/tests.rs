use super::*;
use crate::write_file;

/// Begins the folder of a run.
fn begin(dir: impl AsRef<Path>) -> Result<OutputFolder, FileError> {
    OutputFolder::create(dir, "lab, seed 1", Replace::Same)
}

/// Writes a folder with one file in it.
fn write(dir: &Path, text: &str) -> Result<PathBuf, FileError> {
    let folder = begin(dir)?;
    write_file(folder.path("a.txt"), text.as_bytes(), Replace::Any)?;
    folder.finish()
}

#[track_caller]
fn refuse(dir: &Path, expected: &str) {
    let error = begin(dir).unwrap_err().to_string();
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
    let folder = begin(dir.join(".")).unwrap();
    write_file(folder.path("a.txt"), b"a", Replace::Any).unwrap();
    assert_eq!(names(dir.parent().unwrap()), ["out.partial"]);
    assert_eq!(folder.finish().unwrap(), dir);
    assert_eq!(names(dir.parent().unwrap()), ["out"]);
    assert_eq!(names(&dir), [".covmap", "a.txt"]);
}

#[test]
fn the_same_run_replaces_its_own_files_and_keeps_those_of_others() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    write(&dir, "old").unwrap();
    fs::write(dir.join("note.txt"), "mine").unwrap();
    for _ in 0..2 {
        write(&dir, "new").unwrap();
        assert_eq!(names(root.path()), ["out"]);
        assert_eq!(names(&dir), [".covmap", "a.txt", "note.txt"]);
        assert_eq!(fs::read_to_string(dir.join("a.txt")).unwrap(), "new");
        assert_eq!(fs::read_to_string(dir.join("note.txt")).unwrap(), "mine");
    }
}

#[test]
fn what_was_changed_in_a_folder_of_the_same_run_is_not_replaced() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    write(&dir, "old").unwrap();
    fs::write(dir.join("a.txt"), "0ld").unwrap();
    refuse(&dir, "out/a.txt: is not as covmap wrote it");
    assert_eq!(names(root.path()), ["out"]);
    fs::remove_file(dir.join("a.txt")).unwrap();
    drop(begin(&dir).unwrap());
    fs::create_dir(dir.join("thesis")).unwrap();
    refuse(&dir, "out/thesis: is not as covmap wrote it");
}

#[test]
fn another_run_is_replaced_only_if_that_is_meant_and_then_whole() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    let other = |replace| OutputFolder::create(&dir, "lab, seed 2", replace);
    write(&dir, "old").unwrap();
    fs::write(dir.join("note.txt"), "").unwrap();
    let error = other(Replace::Same).unwrap_err().to_string();
    assert!(error.contains("out: holds another run (lab, seed 1)"), "{error}");
    assert!(error.contains("--out") && error.contains("--force"), "{error}");
    // Nor is an unfinished folder of another run.
    fs::rename(&dir, beside(&dir, ".partial")).unwrap();
    assert!(other(Replace::Same).unwrap_err().to_string().contains("out.partial: holds another"));
    fs::rename(beside(&dir, ".partial"), &dir).unwrap();
    other(Replace::Any).unwrap().finish().unwrap();
    assert_eq!(names(&dir), [".covmap"]);
    // The folders of earlier versions name no run.
    fs::write(dir.join(MARKER), "covmap wrote this folder, and replaces it whole.\n").unwrap();
    fs::write(dir.join("a.txt"), "").unwrap();
    refuse(&dir, "out: holds a run of an earlier covmap");
    // Where there is no result, none can be lost.
    fs::remove_file(dir.join("a.txt")).unwrap();
    drop(begin(&dir).unwrap());
}

#[test]
fn a_folder_that_covmap_did_not_write_is_not_replaced_even_if_that_is_meant() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("chapter1.txt"), "text").unwrap();
    assert!(OutputFolder::create(root.path(), "run", Replace::Any).is_err());
    assert_eq!(names(root.path()), ["chapter1.txt"]);
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
    let folder = begin(&dir).unwrap();
    write_file(folder.path("a.txt"), b"a", Replace::Any).unwrap();
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
    let first = begin(&dir).unwrap();
    refuse(&dir, "another covmap is writing");
    first.finish().unwrap();
}

#[test]
fn results_are_kept_when_a_stranger_takes_their_place() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    let folder = begin(&dir).unwrap();
    fs::create_dir(&dir).unwrap();
    fs::write(dir.join("mine.txt"), "").unwrap();
    assert!(folder.finish().is_err());
    assert_eq!(names(root.path()), ["out", "out.partial"]);
}

#[test]
fn a_folder_that_somebody_put_aside_stays() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    for _ in 0..2 {
        write(&dir, "new").unwrap();
        if !root.path().join("out.old").exists() {
            fs::rename(&dir, root.path().join("out.old")).unwrap();
        }
    }
    write(&dir, "newer").unwrap();
    assert_eq!(names(root.path()), ["out", "out.old"]);
    assert_eq!(fs::read_to_string(root.path().join("out.old/a.txt")).unwrap(), "new");
}

#[test]
fn old_results_return_when_their_replacement_was_cut_short() {
    let root = tempfile::tempdir().unwrap();
    let dir = root.path().join("out");
    write(&dir, "old").unwrap();
    fs::rename(&dir, beside(&dir, ASIDE)).unwrap();
    drop(begin(&dir).unwrap());
    assert_eq!(fs::read_to_string(dir.join("a.txt")).unwrap(), "old");
}
