//! The items of a crate, read from sources in rustfmt's layout: an item of a module begins at the
//! margin, and its members are indented by four.

use crate::root;
use std::fs;
use std::path::{Path, PathBuf};

/// An item at the margin of a file, with its lines.
#[derive(Debug, Clone)]
struct Item {
    public: bool,
    kind: String,
    /// The name; for an `impl`, that of the type.
    name: String,
    body: Vec<String>,
}

/// The declarations and imports of a file.
#[derive(Debug, Clone, Default)]
struct Source {
    items: Vec<Item>,
    /// The imported paths, each ending with the name, and whether the import is `pub`.
    uses: Vec<(bool, Vec<String>)>,
}

/// A file with the folder of its submodules.
#[derive(Debug, Clone)]
struct Module {
    source: Source,
    folder: PathBuf,
}

/// Whether users of the crate may name an item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    Public,
    Private,
}

/// Finds `covmap_plan::Strategy::Cl`, given as the parts of the path.
pub(super) fn find(path: &[String]) -> Result<Found, String> {
    let missing = |part: &str| format!("{}: there is no {part}", path.join("::"));
    let [krate, name, rest @ ..] = path else { return Err(missing("item")) };
    let src = root().join("crates").join(krate.replace('_', "-")).join("src");
    let top = Module::read(&src.join("lib.rs"), &src).ok_or_else(|| missing(krate))?;
    let exported =
        top.source.uses.iter().find(|(public, path)| *public && path.last() == Some(name));
    if let Some((_, target)) = exported {
        let target: Vec<String> = target.iter().chain(rest).cloned().collect();
        return top
            .walk(&src, &target, true)
            .map(|()| Found::Public)
            .map_err(|part| missing(&part));
    }
    let item = top.source.items.iter().find(|item| item.name == *name && item.kind != "impl");
    let public = item.ok_or_else(|| missing(name))?.public;
    top.walk(&src, &path[1..], public).map_err(|part| missing(&part))?;
    Ok(if public { Found::Public } else { Found::Private })
}

/// Returns all crates of the library, by their names in paths.
pub(super) fn crates() -> Vec<String> {
    let entries = fs::read_dir(root().join("crates")).unwrap().map(|entry| entry.unwrap());
    let folders = entries.filter(|entry| entry.path().is_dir());
    folders.map(|entry| entry.file_name().into_string().unwrap().replace('-', "_")).collect()
}

impl Module {
    fn read(file: &Path, folder: &Path) -> Option<Self> {
        let source = parse(&fs::read_to_string(file).ok()?);
        Some(Self { source, folder: folder.to_owned() })
    }

    fn child(&self, name: &str) -> Option<Self> {
        let folder = self.folder.join(name);
        Self::read(&folder.with_extension("rs"), &folder)
            .or_else(|| Self::read(&folder.join("mod.rs"), &folder))
    }

    /// Follows a path from this module; the error is the missing part. `exported` paths go through
    /// private modules to public items.
    fn walk(&self, src: &Path, path: &[String], exported: bool) -> Result<(), String> {
        let [name, rest @ ..] = path else { return Ok(()) };
        let mut declared = self.source.items.iter().filter(|item| item.name == *name);
        if let Some(item) = declared.find(|item| item.kind != "impl") {
            if item.kind == "mod" {
                return self.child(name).ok_or_else(|| name.clone())?.walk(src, rest, exported);
            }
            return match rest {
                _ if exported && !item.public => Err(format!("public {name}")),
                [] => Ok(()),
                [member] if has_member(src, item, member, exported) => Ok(()),
                [member, ..] => Err(member.clone()),
            };
        }
        let is_it = |public: bool, path: &[String]| path.last() == Some(name) && public >= exported;
        let imported = self.source.uses.iter().find(|(public, path)| is_it(*public, path));
        let target = &imported.ok_or_else(|| name.clone())?.1;
        let whole: Vec<String> = target.iter().chain(rest).cloned().collect();
        match whole[0].as_str() {
            "crate" => {
                let top = Self::read(&src.join("lib.rs"), src).ok_or_else(|| name.clone())?;
                top.walk(src, &whole[1..], exported)
            }
            first if target.len() > 1 && self.child(first).is_some() => {
                self.walk(src, &whole, exported)
            }
            _ => Err(name.clone()),
        }
    }
}

/// Returns whether a type has a field, variant, function or constant of this name, anywhere in its
/// crate.
fn has_member(src: &Path, item: &Item, name: &str, public: bool) -> bool {
    let of_impls = |file: &PathBuf| {
        let items = parse(&fs::read_to_string(file).unwrap()).items.into_iter();
        items.filter(|other| other.kind == "impl" && other.name == item.name).collect::<Vec<_>>()
    };
    let open = ["enum", "trait"].contains(&item.kind.as_str());
    let declares = |body: &[String], open: bool| {
        let members = body.iter().filter(|line| indent(line) == 4);
        members.filter(|line| open || !public || line.trim().starts_with("pub ")).any(|line| {
            let line = without_visibility(line.trim());
            let line = ["const fn ", "fn ", "const ", "type "]
                .iter()
                .find_map(|word| line.strip_prefix(word))
                .unwrap_or(line);
            leading_name(line) == name
        })
    };
    declares(&item.body, open)
        || crate::rust_files(src).iter().flat_map(of_impls).any(|block| {
            // The items of a trait's `impl` are as public as the trait.
            declares(&block.body, block.public)
        })
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn without_visibility(line: &str) -> &str {
    ["pub(crate) ", "pub(super) ", "pub "]
        .iter()
        .find_map(|word| line.strip_prefix(word))
        .unwrap_or(line)
}

fn leading_name(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    &text[..end]
}

fn parse(text: &str) -> Source {
    let mut source = Source::default();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let public = line.starts_with("pub ");
        let rest = without_visibility(line);
        if let Some(first) = rest.strip_prefix("use ") {
            let mut tree = first.to_owned();
            while !tree.ends_with(';') {
                tree.push_str(lines.next().unwrap().trim());
            }
            let paths = paths_of_tree(tree.trim_end_matches(';')).into_iter();
            source.uses.extend(paths.map(|path| (public, path)));
            continue;
        }
        let rest = rest.strip_prefix("const fn ").map_or(rest, |_| &rest["const ".len()..]);
        let (kind, after) = rest.split_once([' ', '<']).unwrap_or((rest, ""));
        let kinds = ["fn", "struct", "enum", "trait", "const", "static", "type", "mod", "impl"];
        if !kinds.contains(&kind) {
            continue;
        }
        let (mut header, mut body) = (rest.to_owned(), Vec::new());
        if !line.ends_with([';', '}']) {
            for line in lines.by_ref() {
                let in_body = header.ends_with('{');
                if in_body {
                    body.push(line.to_owned())
                } else {
                    header = format!("{header} {}", line.trim())
                }
                if line.starts_with(['}', ']']) || !in_body && line.ends_with(';') {
                    break;
                }
            }
        }
        let (name, of_trait) = if kind == "impl" {
            implemented(&header)
        } else {
            (leading_name(after).to_owned(), false)
        };
        let public = public || of_trait;
        source.items.push(Item { public, kind: kind.to_owned(), name, body });
    }
    source
}

/// Returns the type of `impl<T> Trait for Type<T> {`, and whether there is a trait.
fn implemented(header: &str) -> (String, bool) {
    let header = header.trim_end_matches('{').split(" where ").next().unwrap();
    let (kind, of_trait) = match header.rsplit_once(" for ") {
        Some((_, kind)) => (kind, true),
        None if header.starts_with("impl<") => (header.split_once("> ").unwrap().1, false),
        None => (header.strip_prefix("impl ").unwrap(), false),
    };
    let kind = kind.trim_start_matches('&').split(['<', ' ']).next().unwrap();
    (kind.rsplit("::").next().unwrap().to_owned(), of_trait)
}

/// Returns all paths of `a::{b, c::{d, e}}`; renamed imports are not followed.
pub(crate) fn paths_of_tree(tree: &str) -> Vec<Vec<String>> {
    let Some(at) = tree.find('{') else {
        let path = parts(tree);
        return if path.is_empty() { Vec::new() } else { vec![path] };
    };
    let prefix = parts(&tree[..at]);
    let inner = &tree[at + 1..tree.rfind('}').unwrap()];
    let paths = branches(inner).into_iter().flat_map(paths_of_tree);
    paths.map(|path| prefix.iter().cloned().chain(path).collect()).collect()
}

fn parts(path: &str) -> Vec<String> {
    path.split("::").map(|part| part.trim().to_owned()).filter(|part| !part.is_empty()).collect()
}

/// Splits a text at the commas outside of all braces.
fn branches(text: &str) -> Vec<&str> {
    let (mut depth, mut from, mut found) = (0, 0, Vec::new());
    for (at, letter) in text.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(&text[from..at]);
                from = at + 1;
            }
            _ => {}
        }
    }
    found.push(&text[from..]);
    found
}
