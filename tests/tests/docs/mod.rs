//! The docs name only existing items, files and anchors, and the guide names every shipped file.

pub(crate) mod source;

use crate::{files, root};
use source::{Found, crates, find, paths_of_tree};
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the README and all pages of `docs/`, by their paths in the repository, with their texts.
fn pages() -> Vec<(String, String)> {
    let page = |path: &Path| {
        let name = path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned();
        (name, fs::read_to_string(path).unwrap())
    };
    let docs = files("docs", "md").into_iter().chain(files("docs/report", "html"));
    docs.chain([root().join("README.md")]).map(|path| page(&path)).collect()
}

/// A path that a page names, with its typeface.
#[derive(Debug, Clone, PartialEq)]
struct Named {
    path: Vec<String>,
    italic: bool,
}

/// Returns all paths in a text that begin with a crate: `covmap_plan::Strategy::{Cl, Ig}` is two.
fn named(text: &str) -> Vec<Named> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("covmap") {
        let before = text[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || "_-/.".contains(c)) {
            continue;
        }
        let tree = path_at(&text[at..]);
        let all = paths_of_tree(tree).into_iter().filter(|path| path.len() > 1);
        let italic = text[..at].ends_with("*`");
        found.extend(all.map(|path| Named { path, italic }));
    }
    found
}

/// Returns the path at the beginning of a text: `a::b::{c, d}`.
fn path_at(text: &str) -> &str {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut end = text.find(|c| !is_name(c)).unwrap_or(text.len());
    while let Some(rest) = text[end..].strip_prefix("::") {
        if rest.starts_with('{') {
            return rest.find('}').map_or(&text[..end], |close| &text[..end + 2 + close + 1]);
        }
        let part = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
        if part == 0 {
            break;
        }
        end += 2 + part;
    }
    &text[..end]
}

/// Returns the texts between single backticks, outside of blocks of code.
fn spans(text: &str) -> Vec<&str> {
    let outside = text.split("```").step_by(2);
    outside.flat_map(|part| part.split('`').skip(1).step_by(2)).collect()
}

fn parts(path: &str) -> Vec<String> {
    path.split("::").map(str::to_owned).collect()
}

/// Fails with the complaints about all pages in one message, if there are any.
#[track_caller]
fn expect_none(complaints: &[String]) {
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

#[test]
fn every_item_that_the_docs_name_exists() {
    let mut complaints = Vec::new();
    let mut count = 0;
    for (page, text) in pages() {
        for Named { path, italic } in named(&text) {
            count += 1;
            match find(&path) {
                Err(error) => complaints.push(format!("{page}: {error}")),
                // The index sets private items in italics.
                Ok(found) if page == "docs/paper.md" && italic != (found == Found::Private) => {
                    complaints.push(format!("{page}: {} is {found:?}", path.join("::")));
                }
                Ok(_) => {}
            }
        }
    }
    expect_none(&complaints);
    assert!(count > 150, "only {count} items were found to be named");
}

/// Foreign types that the docs name.
const FOREIGN: [&str; 1] = ["ControlFlow"];

#[test]
fn every_member_that_is_named_without_its_crate_exists() {
    let crates = crates();
    let mut complaints = Vec::new();
    for (page, text) in pages() {
        for span in spans(&text).into_iter().filter(|span| span.starts_with(char::is_uppercase)) {
            for path in paths_of_tree(path_at(span)).into_iter().filter(|path| path.len() > 1) {
                let is_of = |krate: &String| {
                    find(&[std::slice::from_ref(krate), &path[..]].concat()) == Ok(Found::Public)
                };
                if !FOREIGN.contains(&path[0].as_str()) && !crates.iter().any(is_of) {
                    complaints.push(format!("{page}: no crate has {}", path.join("::")));
                }
            }
        }
    }
    expect_none(&complaints);
}

#[test]
fn every_claim_has_the_function_that_the_index_names() {
    let text = fs::read_to_string(root().join("docs/paper.md")).unwrap();
    let claims = (1..=21).filter(|claim| *claim != 18);
    let missing =
        claims.filter(|claim| !text.contains(&format!("`covmap_paper::claims::claim_{claim}`")));
    assert_eq!(
        missing.collect::<Vec<_>>(),
        [0; 0],
        "docs/paper.md names no function of these claims"
    );
}

#[test]
fn every_test_that_is_named_exists() {
    let folders = ["crates", "tests", "xtask"].map(|folder| root().join(folder));
    let sources = folders.iter().flat_map(|folder| crate::rust_files(folder));
    let code: String = sources.map(|file| fs::read_to_string(file).unwrap()).collect();
    let mut complaints = Vec::new();
    for (page, text) in pages() {
        // A function whose name is a sentence is a test.
        let is_name = |c: char| c.is_lowercase() || c.is_ascii_digit() || c == '_';
        let sentences = spans(&text).into_iter().filter(|span| span.matches('_').count() > 4);
        for name in sentences.filter(|span| span.chars().all(is_name)) {
            if !code.contains(&format!("fn {name}(")) {
                complaints.push(format!("{page}: {name}"));
            }
        }
    }
    expect_none(&complaints);
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut complaints = Vec::new();
    for (page, text) in pages().into_iter().filter(|(page, _)| page.ends_with(".md")) {
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for target in targets.filter(|target| !target.contains("://")) {
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let from = root().join(&page);
            let path = if file.is_empty() { from } else { from.parent().unwrap().join(file) };
            let is_there =
                path.exists() && (anchor.is_empty() || anchors(&path).contains(&anchor.to_owned()));
            if !is_there {
                complaints.push(format!("{page}: {target}"));
            }
        }
    }
    expect_none(&complaints);
}

/// Returns the anchors of a page's headings, as GitHub makes them.
fn anchors(page: &PathBuf) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let anchor = |heading: &str| {
        let text = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = text.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    };
    headings.map(anchor).collect()
}

#[test]
fn figures_name_their_commit() {
    for page in ["docs/results.md", "docs/fitting.md"] {
        let text = fs::read_to_string(root().join(page)).unwrap();
        let rows: Vec<Vec<&str>> = text
            .lines()
            .filter(|line| line.starts_with("| ["))
            .map(|line| line.split('|').map(str::trim).collect())
            .collect();
        for heading in text.lines().filter_map(|line| line.strip_prefix("## ")) {
            let row = rows.iter().find(|row| row[1].starts_with(&format!("[{heading}](")));
            let commit = row.unwrap_or_else(|| panic!("{page}: no row of {heading}"))[2];
            let is_hash = commit.len() >= 7 && commit.bytes().all(|b| b.is_ascii_hexdigit());
            assert!(is_hash, "{page}: {heading}: {commit}");
        }
    }
}

#[test]
fn every_file_of_the_repository_that_is_named_exists() {
    let folders = ["crates/", "configs/", "scenarios/", "docs/", "tests/", "xtask/"];
    let mut complaints = Vec::new();
    for (page, text) in pages().into_iter().filter(|(page, _)| page.ends_with(".md")) {
        let is_end = |c: char| c.is_whitespace() || "`()|,;:\"'".contains(c);
        for word in text.split(is_end) {
            let word = word.trim_end_matches('.').split('#').next().unwrap();
            let named = folders.iter().any(|folder| word.starts_with(folder));
            if named && !word.contains(['*', '…', '<']) && !root().join(word).exists() {
                complaints.push(format!("{page}: {word}"));
            }
        }
    }
    expect_none(&complaints);
}

#[test]
fn the_guide_names_every_scenario_and_configuration() {
    let guide = fs::read_to_string(root().join("docs/guide.md")).unwrap();
    let mut complaints = Vec::new();
    for folder in ["scenarios", "configs", "configs/fit"] {
        for file in files(folder, "ron") {
            let path = file.strip_prefix(root()).unwrap().to_str().unwrap().to_owned();
            if !spans(&guide).contains(&path.as_str()) {
                complaints.push(path);
            }
        }
    }
    expect_none(&complaints);
}

#[test]
fn what_is_not_there_is_missed() {
    let found = |path: &str| find(&parts(path));
    for path in [
        "covmap_plan::Strategy",
        "covmap_plan::Strategy::IgCl",
        "covmap_plan::Strategy::validate",
        "covmap_plan::StrategyError",
        "covmap_plan::PlannerParameters::scan_spacing",
        "covmap_explore::Robot::drive",
        "covmap_log::LogReader",
        "covmap_model::integrate",
        "covmap::Steps",
    ] {
        assert_eq!(found(path), Ok(Found::Public), "{path}");
    }
    for path in
        ["covmap_plan::strategy", "covmap_gain::product::bound", "covmap_plan::decision::Score"]
    {
        assert_eq!(found(path), Ok(Found::Private), "{path}");
    }
    for path in [
        "covmap_plane::Strategy",
        "covmap_plan::Strategies",
        "covmap_plan::Strategy::IgCL",
        "covmap_plan::Strategy::valid",
        "covmap_plan::Planner::take_over",
        "covmap_gain::product::bounds",
        "covmap_gain::product::bound::NoSuchThing",
        "covmap_log::Fields",
    ] {
        assert!(found(path).is_err(), "{path}");
    }
    let text =
        "`covmap::{Cell, Grid}`, *`covmap_plan::window`* and x_covmap_plan::y, covmap-io, covmap";
    let path = |path: &str, italic| Named { path: parts(path), italic };
    let expected =
        [("covmap::Cell", false), ("covmap::Grid", false), ("covmap_plan::window", true)];
    assert_eq!(named(text), expected.map(|(name, italic)| path(name, italic)));
}
