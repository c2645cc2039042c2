//! Invariants 1, 2 and 5 of the architecture, held by the manifests: which crate may name
//! which.

use crate::{root, rust_files};
use std::collections::BTreeSet;

/// Every crate, with the crates of covmap that it may use.
const ARROWS: [(&str, &[&str]); 9] = [
    ("covmap", &[]),
    ("covmap-sonar", &["covmap"]),
    ("covmap-io", &["covmap", "covmap-sonar"]),
    ("covmap-model", &["covmap", "covmap-sonar", "covmap-io"]),
    ("covmap-world", &["covmap", "covmap-sonar", "covmap-io"]),
    ("covmap-gain", &["covmap", "covmap-sonar", "covmap-io", "covmap-model"]),
    ("covmap-plan", &["covmap", "covmap-sonar", "covmap-io", "covmap-model", "covmap-gain"]),
    ("covmap-fit", &["covmap", "covmap-sonar", "covmap-io", "covmap-model"]),
    (
        "covmap-explore",
        &[
            "covmap",
            "covmap-sonar",
            "covmap-io",
            "covmap-model",
            "covmap-world",
            "covmap-gain",
            "covmap-plan",
        ],
    ),
];

/// A crate's normal dependencies, or those of its tests.
fn dependencies(package: &str, section: &str) -> BTreeSet<String> {
    let manifest = root().join("crates").join(package).join("Cargo.toml");
    let text = std::fs::read_to_string(&manifest).unwrap();
    let lines = text.lines().map(str::trim);
    let mut found = BTreeSet::new();
    let mut current = "";
    for line in lines {
        if line.starts_with('[') {
            current = line.trim_matches(['[', ']']);
            // `[dependencies.name]` is one, too.
            let name = current.strip_prefix(section).and_then(|rest| rest.strip_prefix('.'));
            found.extend(name.map(str::to_owned));
        } else if current == section && !line.starts_with('#') && line.contains('=') {
            let name: String = line.chars().take_while(|c| !matches!(c, '.' | ' ' | '=')).collect();
            found.insert(name);
        }
    }
    found
}

fn packages() -> BTreeSet<String> {
    let folders = std::fs::read_dir(root().join("crates")).unwrap();
    let folders = folders.map(|entry| entry.unwrap()).filter(|e| e.path().is_dir());
    folders.map(|entry| entry.file_name().into_string().unwrap()).collect()
}

#[test]
fn every_crate_uses_only_what_lies_below_it() {
    let known: BTreeSet<&str> = ARROWS.iter().map(|(package, _)| *package).collect();
    for package in packages() {
        assert!(known.contains(package.as_str()), "{package}: give it its arrows here");
    }
    for (package, allowed) in ARROWS {
        let used = dependencies(package, "dependencies");
        assert!(!used.is_empty(), "{package}");
        for other in used.iter().filter(|name| known.contains(name.as_str())) {
            assert!(allowed.contains(&other.as_str()), "{package} uses {other}");
        }
    }
}

#[test]
fn the_planner_and_the_model_never_depend_on_the_world() {
    for package in ["covmap-plan", "covmap-gain", "covmap-model"] {
        for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let used = dependencies(package, section);
            assert!(!used.contains("covmap-world"), "{package}: {section}");
            assert!(!used.contains("covmap-explore"), "{package}: {section}");
        }
    }
}

#[test]
fn the_world_never_evaluates_the_sensor_model() {
    for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
        assert!(!dependencies("covmap-world", section).contains("covmap-model"), "{section}");
    }
}

#[test]
fn what_is_foreign_has_one_home() {
    let homes: [(&str, &[&str]); 8] = [
        ("parry2d", &["covmap-world"]),
        ("ron", &["covmap-io"]),
        ("serde-saphyr", &["covmap-io"]),
        ("png", &["covmap-io"]),
        ("flate2", &["covmap-io"]),
        ("clap", &[]),
        ("indicatif", &[]),
        ("ctrlc", &[]),
    ];
    for (name, homes) in homes {
        for package in packages() {
            let used = dependencies(&package, "dependencies").contains(name);
            assert!(!used || homes.contains(&package.as_str()), "{package} uses {name}");
        }
    }
    assert!(dependencies("covmap-world", "dependencies").contains("parry2d"));
}

#[test]
fn only_files_and_the_program_touch_the_file_system() {
    for package in packages().iter().filter(|package| *package != "covmap-io") {
        for source in rust_files(&root().join("crates").join(package).join("src")) {
            let text = std::fs::read_to_string(&source).unwrap();
            // What follows are tests.
            let code = text.split("#[cfg(test)]").next().unwrap();
            for word in ["std::fs", "File::", "println!", "std::io", "std::env"] {
                let named = code.lines().any(|l| !l.trim().starts_with("//") && l.contains(word));
                assert!(!named, "{} names {word}", source.display());
            }
        }
    }
}

#[test]
fn files_are_opened_and_written_in_one_way() {
    // The homes, and what reads the system's own table of processes.
    let homes = [
        "new_file.rs",
        "read.rs",
        "ledger.rs",
        "output_folder.rs",
        "shared_folder.rs",
        "lines.rs",
        "growth.rs",
    ];
    let mut looked_at = 0;
    for folder in ["crates/covmap-io/src", "xtask/src"] {
        for source in rust_files(&root().join(folder)) {
            let name = source.file_name().unwrap().to_str().unwrap();
            if homes.contains(&name) || name.ends_with("tests.rs") {
                continue;
            }
            looked_at += 1;
            let text = std::fs::read_to_string(&source).unwrap();
            // What follows are tests.
            let code = text.split("#[cfg(test)]").next().unwrap();
            let reading = ["fs::read(", "fs::read_to", "File::open("];
            let writing = ["fs::write", "fs::copy", "File::create(", "OpenOptions"];
            for word in reading.into_iter().chain(writing) {
                // `NewFile::create(` is not `File::create(`.
                let part = |(at, _)| code[..at].ends_with(char::is_alphanumeric);
                assert!(code.match_indices(word).all(part), "{} names {word}", source.display());
            }
        }
    }
    assert!(looked_at > 100);
}
