//! `completions`: the completions of a shell for `covmap`.

use crate::arguments::{Command, Completions};
use anyhow::Result;
use clap::{CommandFactory, Parser};
use std::process::ExitCode;

/// The program as a shell sees it.
#[derive(Parser)]
#[command(name = "covmap")]
struct Covmap {
    #[command(subcommand)]
    _command: Command,
}

pub(crate) fn run(arguments: &Completions) -> Result<ExitCode> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut Covmap::command(), "covmap", &mut text);
    std::io::Write::write_all(&mut std::io::stdout(), &text)?;
    Ok(ExitCode::SUCCESS)
}
