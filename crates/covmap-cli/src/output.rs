//! The folders and files of results; no input of the user is lost there.

use crate::arguments::{Fit, Force};
use crate::names;
use anyhow::{Result, bail};
use covmap_io::Digest;
use covmap_io::{FileError, OutputFolder, Replace, shown};
use covmap_lab::FitPlan;
use std::path::Path;

/// Returns a run in words, with the hash of everything that determines its results.
pub(crate) fn run_line(words: &str, digest: Digest) -> String {
    format!("{words}, {}", digest.finish())
}

/// Begins the folder of a run that reads `inputs`. A folder with an input in it is refused.
pub(crate) fn folder(
    out: &Path,
    run: &str,
    force: Force,
    inputs: &[&Path],
) -> Result<OutputFolder> {
    if let Some(input) = inside(out, inputs) {
        bail!(
            "{}: holds {}, which this command reads; name another folder with --out",
            shown(out),
            shown(input)
        );
    }
    Ok(OutputFolder::create(out, run, force.replace())?)
}

/// Begins the folder of a command that reads a file for `fit`, and the configurations named there.
pub(crate) fn of_fit(command: &str, arguments: &Fit, plan: &FitPlan) -> Result<OutputFolder> {
    let Fit { file, out, force, .. } = arguments;
    let digest = Digest::default()
        .with_file(file)?
        .with(serde_json::to_vec(&plan.begin.config)?)
        .with(serde_json::to_vec(&plan.explorer.config)?);
    let run = run_line(&format!("{command} {}", names::stem(file)), digest);
    folder(out, &run, *force, &[file, &plan.begin.file, &plan.explorer.file])
}

/// Returns the permission to replace a file by a command that reads `inputs`; an input is never
/// replaced.
pub(crate) fn replace(out: &Path, force: Force, inputs: &[&Path]) -> Result<Replace> {
    let out_file = out.canonicalize().unwrap_or_default();
    for input in inputs {
        let input_file = input.canonicalize().unwrap_or_else(|_| input.to_path_buf());
        // A folder among the inputs stands for all of its files.
        if input_file == out_file || out_file.parent() == Some(&input_file) {
            bail!("{}: is an input of this command; name another file with --out", shown(out));
        }
    }
    Ok(force.replace())
}

/// Returns the first input that lies in a folder.
fn inside<'a>(folder: &Path, inputs: &[&'a Path]) -> Option<&'a Path> {
    let folder = folder.canonicalize().ok()?;
    let is_inside =
        |input: &&&Path| input.canonicalize().is_ok_and(|input| input.starts_with(&folder));
    inputs.iter().find(is_inside).copied()
}

/// Returns the hash of a log file, or of the files of a log's folder.
pub(crate) fn log_digest(log: &Path) -> Result<Digest, FileError> {
    let parts = ["od.txt", "sonar.txt", "laser.txt"].map(|name| log.join(name));
    let files = if log.is_dir() { &parts[..] } else { &[log.to_owned()] };
    files.iter().filter(|file| file.exists()).try_fold(Digest::default(), Digest::with_file)
}
