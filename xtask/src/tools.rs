//! Developers' tools: each starts Cargo, which does the work.

use anyhow::{Context, Result};
use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The crates for mutation tests: those with the paper's equations and rules.
const CORE: [&str; 5] = ["covmap", "covmap-model", "covmap-gain", "covmap-plan", "covmap-explore"];

/// Runs covmap-bench in the user's current folder, because it writes there.
pub(crate) fn bench(rest: &[String]) -> Result<ExitCode> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.toml");
    let mut cargo = cargo("run");
    cargo.args(["--release", "--package", "covmap-bench", "--manifest-path"]).arg(manifest);
    ended(cargo.arg("--").args(rest))
}

pub(crate) fn docs_check() -> Result<ExitCode> {
    let mut doc = cargo("doc");
    doc.args(["--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
    let done = ended(&mut doc)?;
    if done != ExitCode::SUCCESS {
        return Ok(done);
    }
    ended(cargo("test").args(["--package", "covmap-tests", "docs"]))
}

pub(crate) fn mutants(rest: &[String]) -> Result<ExitCode> {
    let mut mutants = cargo("mutants");
    mutants.args(CORE.iter().flat_map(|package| ["--package", package]));
    ended(mutants.args(["--timeout", "300"]).args(rest))
}

/// Returns the Cargo that started this program.
fn cargo(command: &str) -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or(OsString::from("cargo")));
    cargo.arg(command);
    cargo
}

/// Returns the exit code of the command.
fn ended(command: &mut Command) -> Result<ExitCode> {
    let status = command.status().with_context(|| format!("{command:?} cannot be started"))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
