//! Where results go, and that nothing of the user's is lost there.

use crate::arguments::{Fit, Force};
use anyhow::{Result, bail};
use covmap_io::Digest;
use covmap_io::{FileError, OutputFolder, Replace, shown};
use covmap_lab::FitPlan;
use std::path::{Path, PathBuf};

/// A run in words, and all that its results are a function of as a hash.
pub(crate) fn run_line(words: &str, digest: Digest) -> String {
    format!("{words}, {}", digest.finish())
}

/// Begins the folder of a run that reads `inputs`, which must not lie in a folder that is
/// replaced.
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

/// Begins the folder of a command that reads a file for `fit`, and the configurations that it
/// names.
pub(crate) fn of_fit(command: &str, arguments: &Fit, plan: &FitPlan) -> Result<OutputFolder> {
    let Fit { file, out, force, .. } = arguments;
    let digest = Digest::default()
        .with_file(file)?
        .with(serde_json::to_vec(&plan.begin.config)?)
        .with(serde_json::to_vec(&plan.explorer.config)?);
    let run = run_line(&format!("{command} {}", stem(file)), digest);
    folder(out, &run, *force, &[file, &plan.begin.file, &plan.explorer.file])
}

/// What may be replaced by a file of a command that reads `inputs`: never one of these.
pub(crate) fn replace(out: &Path, force: Force, inputs: &[&Path]) -> Result<Replace> {
    let out_file = out.canonicalize().unwrap_or_default();
    for input in inputs {
        let input_file = input.canonicalize().unwrap_or_else(|_| input.to_path_buf());
        // A folder that is read is all of its files.
        if input_file == out_file || out_file.parent() == Some(&input_file) {
            bail!("{}: is an input of this command; name another file with --out", shown(out));
        }
    }
    Ok(force.replace())
}

/// The first input that lies in a folder.
fn inside<'a>(folder: &Path, inputs: &[&'a Path]) -> Option<&'a Path> {
    let folder = folder.canonicalize().ok()?;
    let is_inside =
        |input: &&&Path| input.canonicalize().is_ok_and(|input| input.starts_with(&folder));
    inputs.iter().find(is_inside).copied()
}

/// The hash of a log, or of the files that a folder has of one.
pub(crate) fn log_digest(log: &Path) -> Result<Digest, FileError> {
    let parts = ["od.txt", "sonar.txt", "laser.txt"].map(|name| log.join(name));
    let files = if log.is_dir() { &parts[..] } else { &[log.to_owned()] };
    files.iter().filter(|file| file.exists()).try_fold(Digest::default(), Digest::with_file)
}

/// A folder in `out/`, named by parts that are there.
pub(crate) fn named(parts: impl IntoIterator<Item = Option<String>>) -> PathBuf {
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    Path::new("out").join(parts.join("-"))
}

/// What a file is called, for the name of a folder.
pub(crate) fn stem(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    plain(&stem)
}

/// A text with nothing in it that a file's name should not have.
pub(crate) fn plain(text: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "._-".contains(c) { c } else { '_' };
    text.chars().map(plain).collect()
}

/// A number for the name of a folder, if it is not the usual one.
pub(crate) fn unlike(number: f64, usual: f64) -> Option<f64> {
    number.total_cmp(&usual).is_ne().then_some(number)
}

/// A number as it was typed, and not with what its computing added.
pub(crate) fn typed(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain() {
        assert_eq!(stem(Path::new("configs/my robot\n2.ron")), "my_robot_2");
        assert_eq!(typed(90.0_f64.to_radians().to_degrees()).to_string(), "90");
        let name = named(["lab".to_owned().into(), None, Some("r0.2".to_owned())]);
        assert_eq!(name, Path::new("out/lab-r0.2"));
    }
}
