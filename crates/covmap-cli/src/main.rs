//! The program `covmap`; `covmap help` lists its commands.

use std::process::ExitCode;

fn main() -> ExitCode {
    covmap_cli::run("covmap")
}
