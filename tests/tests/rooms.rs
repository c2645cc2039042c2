//! The structure of the crates: no cycle of modules that use each other, and no file that is too
//! long.

use crate::architecture::{packages, without_tests};
use crate::docs::source::paths_of_tree;
use crate::{root, rust_files};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Upper limit on the length of a file \[lines\].
const LONGEST: usize = 500;
/// Upper limit on the share of a crate in all lines.
const LARGEST_SHARE: f64 = 0.2;

/// Returns the source folders of all packages.
fn sources() -> Vec<PathBuf> {
    let crates = packages().into_iter().map(|name| root().join("crates").join(name));
    let apart = ["bench", "tests", "xtask"].map(|name| root().join(name));
    crates.chain(apart).map(|package| package.join("src")).collect()
}

fn lines(file: &Path) -> usize {
    std::fs::read_to_string(file).unwrap().lines().count()
}

/// Returns the paths of every `use` in a text that begin with `from`.
fn used(code: &str, from: &str) -> Vec<Vec<String>> {
    let begin = format!("use {from}::");
    let trees = code.match_indices(&begin).map(|(at, _)| &code[at + 4..]);
    let trees = trees.filter_map(|rest| rest.split_once(';').map(|(tree, _)| tree));
    trees.flat_map(|tree| paths_of_tree(&tree.replace('\n', " "))).collect()
}

/// Returns, for each module at the top of a crate, the modules that it uses.
fn uses(src: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let code = |file: &Path| without_tests(&std::fs::read_to_string(file).unwrap());
    let top = |file: &Path| {
        let first = file.strip_prefix(src).unwrap().components().next().unwrap();
        Path::new(first.as_os_str()).file_stem().unwrap().to_str().unwrap().to_owned()
    };
    let files: Vec<PathBuf> = rust_files(src);
    let modules: BTreeSet<String> = files.iter().map(|file| top(file)).collect();
    // The module behind each name that the crate exports at its top.
    let mut home: BTreeMap<String, String> =
        modules.iter().map(|m| (m.clone(), m.clone())).collect();
    let lib = code(&src.join("lib.rs"));
    for module in &modules {
        for path in used(&lib, module) {
            home.insert(path.last().unwrap().clone(), module.clone());
        }
    }
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files.iter().filter(|file| !["lib", "main"].contains(&&*top(file))) {
        let (module, code) = (top(file), code(file));
        let mut named = used(&code, "crate");
        if file.parent() == Some(src) {
            named.extend(used(&code, "super"));
        }
        let others =
            named.iter().filter_map(|path| home.get(path.get(1)?)).filter(|m| **m != module);
        uses.entry(module.clone()).or_default().extend(others.cloned());
    }
    uses
}

/// Returns the cycles, and the modules that use them: modules that use nothing are removed
/// repeatedly.
fn circles(mut uses: BTreeMap<String, BTreeSet<String>>) -> BTreeSet<String> {
    loop {
        let before = uses.len();
        let free: BTreeSet<String> =
            uses.iter().filter(|(_, others)| others.is_empty()).map(|(m, _)| m.clone()).collect();
        uses.retain(|module, _| !free.contains(module));
        let there: BTreeSet<String> = uses.keys().cloned().collect();
        uses.values_mut().for_each(|others| others.retain(|other| there.contains(other)));
        if uses.len() == before {
            return there;
        }
    }
}

#[test]
fn no_modules_of_a_crate_use_each_other_in_a_circle() {
    let mut arrows = 0;
    for src in sources().iter().filter(|src| src.join("lib.rs").exists()) {
        let uses = uses(src);
        arrows += uses.values().map(BTreeSet::len).sum::<usize>();
        let found = circles(uses);
        assert!(found.is_empty(), "{}: {found:?}", src.display());
    }
    assert!(arrows > 300, "only {arrows} were found");
}

#[test]
fn a_circle_is_found() {
    let uses = |pairs: &[(&str, &str)]| {
        let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (module, other) in pairs {
            all.entry((*module).to_owned()).or_default().insert((*other).to_owned());
            all.entry((*other).to_owned()).or_default();
        }
        circles(all).len()
    };
    assert_eq!(uses(&[("a", "b"), ("b", "c"), ("a", "c")]), 0);
    assert_eq!(uses(&[("a", "b"), ("b", "c"), ("c", "b")]), 3);
}

#[test]
fn no_file_is_too_long_and_no_crate_too_large() {
    let of_package = |src: &PathBuf| {
        let files = rust_files(src.parent().unwrap());
        files.iter().map(|file| (lines(file), file.clone())).collect::<Vec<_>>()
    };
    let packages: Vec<Vec<(usize, PathBuf)>> = sources().iter().map(of_package).collect();
    for (length, file) in packages.iter().flatten() {
        assert!(*length < LONGEST, "{}: {length} lines", file.display());
    }
    let sizes = packages.iter().map(|files| files.iter().map(|(length, _)| length).sum::<usize>());
    let (largest, all) = (sizes.clone().max().unwrap(), sizes.sum::<usize>());
    assert!((largest as f64) < LARGEST_SHARE * all as f64, "{largest} of {all} lines");
}
