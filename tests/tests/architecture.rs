//! Invariants 1, 2 and 5 of the architecture, checked in the manifests: the allowed dependencies of
//! each crate.

use crate::{root, rust_files};
use std::collections::BTreeSet;

/// Every crate, with the crates of covmap that it uses: exactly the arrows of docs/architecture.md.
const ARROWS: [(&str, &[&str]); 18] = [
    ("covmap", &[]),
    ("covmap-sonar", &[]),
    ("covmap-bag", &[]),
    ("covmap-io", &["covmap"]),
    ("covmap-statistics", &["covmap"]),
    ("covmap-draw", &["covmap", "covmap-io"]),
    ("covmap-log", &["covmap-bag", "covmap-io", "covmap-sonar"]),
    ("covmap-model", &["covmap", "covmap-sonar"]),
    ("covmap-world", &["covmap", "covmap-sonar", "covmap-statistics"]),
    ("covmap-survey", &["covmap", "covmap-sonar", "covmap-world"]),
    ("covmap-gain", &["covmap", "covmap-model"]),
    ("covmap-plan", &["covmap", "covmap-gain", "covmap-model", "covmap-sonar"]),
    ("covmap-fit", &["covmap", "covmap-model", "covmap-sonar", "covmap-statistics"]),
    ("covmap-explore", &["covmap", "covmap-model", "covmap-plan", "covmap-sonar"]),
    (
        "covmap-lab",
        &[
            "covmap",
            "covmap-bag",
            "covmap-draw",
            "covmap-explore",
            "covmap-fit",
            "covmap-io",
            "covmap-log",
            "covmap-model",
            "covmap-plan",
            "covmap-sonar",
            "covmap-statistics",
            "covmap-survey",
            "covmap-world",
        ],
    ),
    (
        "covmap-campaign",
        &[
            "covmap-explore",
            "covmap-io",
            "covmap-lab",
            "covmap-plan",
            "covmap-sonar",
            "covmap-statistics",
            "covmap-world",
        ],
    ),
    (
        "covmap-paper",
        &[
            "covmap",
            "covmap-campaign",
            "covmap-draw",
            "covmap-explore",
            "covmap-fit",
            "covmap-gain",
            "covmap-io",
            "covmap-lab",
            "covmap-model",
            "covmap-plan",
            "covmap-sonar",
            "covmap-statistics",
            "covmap-world",
        ],
    ),
    (
        "covmap-cli",
        &[
            "covmap",
            "covmap-bag",
            "covmap-campaign",
            "covmap-draw",
            "covmap-explore",
            "covmap-fit",
            "covmap-io",
            "covmap-lab",
            "covmap-log",
            "covmap-model",
            "covmap-plan",
            "covmap-sonar",
            "covmap-statistics",
            "covmap-survey",
            "covmap-world",
        ],
    ),
];

/// Returns a source file without its test modules, which rustfmt closes with a brace on a line of
/// its own.
pub(crate) fn without_tests(text: &str) -> String {
    let (mut code, mut in_tests) = (String::new(), false);
    for line in text.lines() {
        in_tests |= line.starts_with("#[cfg(test)]");
        if !in_tests {
            code.push_str(line);
            code.push('\n');
        }
        in_tests &= !(line == "}" || (line.ends_with(';') && !line.starts_with(' ')));
    }
    code
}

/// Returns a crate's normal dependencies, or those of its tests.
fn dependencies(package: &str, section: &str) -> BTreeSet<String> {
    let manifest = root().join("crates").join(package).join("Cargo.toml");
    let text = std::fs::read_to_string(&manifest).unwrap();
    let lines = text.lines().map(str::trim);
    let mut found = BTreeSet::new();
    let mut current = "";
    for line in lines {
        if line.starts_with('[') {
            current = line.trim_matches(['[', ']']);
            // `[dependencies.name]` is a dependency, too.
            let name = current.strip_prefix(section).and_then(|rest| rest.strip_prefix('.'));
            found.extend(name.map(str::to_owned));
        } else if current == section && !line.starts_with('#') && line.contains('=') {
            let name: String = line.chars().take_while(|c| !matches!(c, '.' | ' ' | '=')).collect();
            found.insert(name);
        }
    }
    found
}

pub(crate) fn packages() -> BTreeSet<String> {
    let folders = std::fs::read_dir(root().join("crates")).unwrap();
    let folders = folders.map(|entry| entry.unwrap()).filter(|e| e.path().is_dir());
    folders.map(|entry| entry.file_name().into_string().unwrap()).collect()
}

#[test]
fn every_crate_uses_what_its_arrows_say() {
    let known: BTreeSet<&str> = ARROWS.iter().map(|(package, _)| *package).collect();
    for package in packages() {
        assert!(known.contains(package.as_str()), "{package}: give it its arrows here");
    }
    for (package, allowed) in ARROWS {
        let used = dependencies(package, "dependencies");
        assert!(!used.is_empty(), "{package}");
        let own: Vec<&str> =
            used.iter().map(String::as_str).filter(|n| known.contains(n)).collect();
        assert_eq!(own, allowed, "{package}");
    }
}

#[test]
fn the_loop_the_planner_and_the_model_never_depend_on_the_world() {
    for package in ["covmap-explore", "covmap-plan", "covmap-gain", "covmap-model"] {
        for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let used = dependencies(package, section);
            assert!(!used.contains("covmap-world"), "{package}: {section}");
            assert!(!used.contains("covmap-lab"), "{package}: {section}");
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
    let homes: [(&str, &[&str]); 9] = [
        ("mcap", &["covmap-bag"]),
        ("parry2d", &["covmap-world"]),
        ("ron", &["covmap-io"]),
        ("serde-saphyr", &["covmap-io"]),
        ("png", &["covmap-draw", "covmap-io"]),
        ("flate2", &["covmap-io", "covmap-log"]),
        ("clap", &["covmap-cli"]),
        ("indicatif", &["covmap-cli"]),
        ("ctrlc", &["covmap-cli"]),
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
    let homes =
        ["covmap-campaign", "covmap-cli", "covmap-draw", "covmap-io", "covmap-lab", "covmap-log"];
    // A bag is read from and written to what others opened.
    let traits_only = ["use std::io::Read;", "use std::io::Write;", "use std::io;"];
    for package in packages().iter().filter(|package| !homes.contains(&package.as_str())) {
        for source in rust_files(&root().join("crates").join(package).join("src")) {
            let text = std::fs::read_to_string(&source).unwrap();
            let code = without_tests(&text);
            for word in
                ["std::fs", "File::", "println!", "std::io", "std::env::var", "std::env::args"]
            {
                let named = code.lines().any(|l| {
                    let is_trait = package == "covmap-bag" && traits_only.contains(&l);
                    !l.trim().starts_with("//") && !is_trait && l.contains(word)
                });
                assert!(!named, "{} names {word}", source.display());
            }
        }
    }
}

#[test]
fn files_are_opened_and_written_in_one_way() {
    // The homes, and the file that reads the system's table of processes.
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
    for folder in [
        "bench/src",
        "crates/covmap-campaign/src",
        "crates/covmap-cli/src",
        "crates/covmap-draw/src",
        "crates/covmap-io/src",
        "crates/covmap-lab/src",
        "crates/covmap-log/src",
        "crates/covmap-paper/src",
        "xtask/src",
    ] {
        for source in rust_files(&root().join(folder)) {
            let name = source.file_name().unwrap().to_str().unwrap();
            if homes.contains(&name) || name.ends_with("tests.rs") {
                continue;
            }
            looked_at += 1;
            let text = std::fs::read_to_string(&source).unwrap();
            let code = without_tests(&text);
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
