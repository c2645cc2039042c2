//! `collect`: what several machines did becomes one campaign.

use super::folder::{self, Folder, Manifest, Planned, Recorded};
use super::record::RunRecord;
use super::tables;
use crate::arguments::Collect;
use crate::say;
use anyhow::{Result, anyhow, bail};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(crate) fn run(arguments: &Collect) -> Result<ExitCode> {
    let Collect { dirs, out, quiet } = arguments;
    let out = out.as_deref().unwrap_or(&dirs[0]);
    let manifest = manifest(dirs)?;
    if let Some(present) = Manifest::read(out)? {
        check_version((out, &present), (&dirs[0], &manifest))?;
    }
    // Which folder has a run; the first of several, since all are the same.
    let mut found: BTreeMap<&str, &Path> = BTreeMap::new();
    let mut damaged: BTreeMap<&str, PathBuf> = BTreeMap::new();
    for dir in dirs {
        for planned in &manifest.runs {
            match folder::read(dir, planned, true) {
                folder::Recorded::Whole(_) => {
                    found.entry(&planned.id).or_insert(dir);
                }
                folder::Recorded::Damaged(file) => {
                    damaged.insert(&planned.id, file);
                }
                folder::Recorded::Missing => {}
            }
        }
    }
    for (_, file) in damaged.iter().filter(|(id, _)| !found.contains_key(*id)) {
        say::note(format!("{}: is damaged, and is left out", file.display()));
    }
    let folder = Folder::open(out, &manifest)?;
    tables::remove(out)?;
    for (id, dir) in found.iter().filter(|(_, dir)| **dir != out) {
        folder::copy(dir, &folder, id)?;
    }
    let runs: Vec<&Planned> = manifest.runs.iter().collect();
    let recorded = folder::read_all(out, &runs, false);
    let records: Vec<RunRecord> = recorded.into_iter().filter_map(Recorded::whole).collect();
    tables::write(out, &manifest.metrics, &records, manifest.runs.len())?;
    if records.len() < manifest.runs.len() {
        let missing = manifest.runs.len() - records.len();
        say::note(format!("{}: {missing} runs are missing", out.display()));
    }
    if !quiet {
        say::line(format!(
            "{}: {} of {} runs of {}",
            out.display(),
            records.len(),
            manifest.runs.len(),
            manifest.name
        ));
    }
    Ok(ExitCode::SUCCESS)
}

/// The campaign of which all folders are.
fn manifest(dirs: &[PathBuf]) -> Result<Manifest> {
    let read = |dir: &PathBuf| {
        Manifest::read(dir)?.ok_or_else(|| anyhow!("{}: is no folder of a campaign", dir.display()))
    };
    let first = read(&dirs[0])?;
    for dir in &dirs[1..] {
        let other = read(dir)?;
        if !other.is_campaign(&first) {
            bail!(
                "{}: holds another campaign ({}) than {} ({})",
                dir.display(),
                other.name,
                dirs[0].display(),
                first.name
            );
        }
        check_version((dir, &other), (&dirs[0], &first))?;
    }
    Ok(first)
}

fn check_version(
    (dir, other): (&Path, &Manifest),
    (first_dir, first): (&Path, &Manifest),
) -> Result<()> {
    if other.version == first.version {
        return Ok(());
    }
    bail!(
        "{}: was made by covmap {}, {} by {}; results of different versions are not mixed",
        dir.display(),
        other.version,
        first_dir.display(),
        first.version
    )
}
