//! `covmap help` says what it can do.

use std::process::ExitCode;

fn main() -> ExitCode {
    covmap_cli::run("covmap")
}
