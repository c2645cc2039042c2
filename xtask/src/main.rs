//! `cargo xtask COMMAND` runs the program `covmap` from its sources; `cargo xtask help` says what it can do.

use std::process::ExitCode;

fn main() -> ExitCode {
    covmap_cli::run("cargo xtask")
}
