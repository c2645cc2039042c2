//! `completions`: the completions of a shell for `covmap`.

use crate::arguments::{Arguments, Command, Completions};
use crate::terminal::say;
use anyhow::Result;
use clap::CommandFactory;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Completions) -> Result<ExitCode> {
    let mut script = Vec::new();
    let mut program = Arguments::<Command>::command();
    clap_complete::generate(arguments.shell, &mut program, "covmap", &mut script);
    say::as_it_is(&script);
    Ok(ExitCode::SUCCESS)
}
