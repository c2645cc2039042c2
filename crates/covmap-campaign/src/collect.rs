//! Joining the runs of several machines in one campaign.

use crate::error::{FolderFault, Result, of_folder};
use crate::folder::{self, Folder, Manifest, Planned, Recorded};
use crate::record::RunRecord;
use crate::tables;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The result of collecting.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Collected {
    /// Name of the campaign.
    pub name: String,
    /// The number of runs that are recorded now.
    pub recorded: usize,
    /// The number of runs of the campaign.
    pub of: usize,
    /// Damaged files of runs that are whole in no folder.
    pub damaged: Vec<PathBuf>,
}

/// Copies the runs of several folders of one campaign into one, and writes its tables.
///
/// # Errors
/// If a folder is of no campaign, of another one, or of another version; or if a file cannot be written.
///
/// # Panics
/// If there is no folder.
pub fn collect(dirs: &[PathBuf], out: &Path) -> Result<Collected> {
    let manifest = manifest(dirs)?;
    if let Some(present) = Manifest::read(out)? {
        check_version((out, &present), (&dirs[0], &manifest))?;
    }
    // The folder that has a run; the first of several, as all have the same.
    let mut found: BTreeMap<&str, &Path> = BTreeMap::new();
    let mut damaged: BTreeMap<&str, PathBuf> = BTreeMap::new();
    for dir in dirs {
        for planned in &manifest.runs {
            match folder::read(dir, planned, true) {
                Recorded::Whole(_) => {
                    found.entry(&planned.id).or_insert(dir);
                }
                Recorded::Damaged(file) => {
                    damaged.insert(&planned.id, file);
                }
                Recorded::Missing => {}
            }
        }
    }
    damaged.retain(|id, _| !found.contains_key(id));
    let folder = Folder::open(out, &manifest)?;
    tables::remove(out)?;
    for (id, dir) in found.iter().filter(|(_, dir)| **dir != out) {
        folder::copy(dir, &folder, id)?;
    }
    let runs: Vec<&Planned> = manifest.runs.iter().collect();
    let recorded = folder::read_all(out, &runs, false);
    let records: Vec<RunRecord> = recorded.into_iter().filter_map(Recorded::whole).collect();
    tables::write(out, &manifest.metrics, &records, manifest.runs.len())?;
    Ok(Collected {
        name: manifest.name,
        recorded: records.len(),
        of: manifest.runs.len(),
        damaged: damaged.into_values().collect(),
    })
}

/// The list of the campaign to which all folders belong.
fn manifest(dirs: &[PathBuf]) -> Result<Manifest> {
    let read =
        |dir: &PathBuf| Manifest::read(dir)?.ok_or_else(|| of_folder(dir, FolderFault::None));
    let first = read(&dirs[0])?;
    for dir in &dirs[1..] {
        let other = read(dir)?;
        if !other.is_campaign(&first) {
            let fault = FolderFault::Differs {
                name: other.name,
                first: dirs[0].clone(),
                first_name: first.name,
            };
            return Err(of_folder(dir, fault));
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
    let fault = FolderFault::OtherVersion {
        version: other.version.clone(),
        first: first_dir.to_owned(),
        first_version: first.version.clone(),
    };
    Err(of_folder(dir, fault))
}
