//! The program `covmap`: explores worlds, makes maps of logs, fits, compares, runs campaigns, and writes what
//! came out.
//!
//! [`run`] is the whole program, and [`run_with`] one with more commands, as `cargo xtask` is. What computes
//! is in the other crates; here are arguments, files, the terminal, the clock and Ctrl-C.
//!
//! ```text
//! cargo install --path crates/covmap-cli
//! covmap explore scenarios/office.ron
//! ```
#![allow(clippy::print_stdout, reason = "a program talks to its user")]

mod about;
mod arguments;
mod beside;
mod built_in;
mod campaign;
mod compare;
mod completions;
mod explain;
mod explain_picture;
mod explore;
mod fit;
mod fit_charts;
mod fit_report;
mod log;
mod map;
mod map_pictures;
mod map_report;
mod map_summary;
mod model;
mod names;
mod output;
mod readings;
mod survey;
pub mod terminal;
mod truth;

pub use arguments::{Command, Force, named_file};

use anyhow::{Result, anyhow};
use arguments::Arguments;
use clap::Subcommand;
use covmap_lab::memory;
use std::io::ErrorKind;
use std::process::ExitCode;
use terminal::say;

/// What the program ends with after bad input; clap ends with the same.
const BAD_INPUT: u8 = 2;
/// What a shell says of a program that was ended by a closed pipe.
const CLOSED_PIPE: u8 = 141;

/// Runs the program with what was typed after `name`, as which it calls itself.
pub fn run(name: &str) -> ExitCode {
    run_with(name, Command::run)
}

/// Runs a program with commands of its own; `act` does what one says.
pub fn run_with<C: Subcommand>(name: &str, act: impl FnOnce(C) -> Result<ExitCode>) -> ExitCode {
    let Arguments { command, memory } = match Arguments::typed(name) {
        Ok(arguments) => arguments,
        Err(told) => return ended(say::clap(told)),
    };
    memory::allow(memory.memory);
    ended(act(command).unwrap_or_else(|error| {
        say::error(&error);
        ExitCode::from(BAD_INPUT)
    }))
}

impl Command {
    /// Does what was typed.
    ///
    /// # Errors
    /// In one sentence, which names the file if there is one.
    pub fn run(self) -> Result<ExitCode> {
        match self {
            Self::Explore(arguments) => explore::run(&arguments),
            Self::Explain(arguments) => explain::run(&arguments),
            Self::Map(arguments) => map::run(&arguments),
            Self::Log(arguments) => log::run(&arguments),
            Self::Truth(arguments) => truth::run(&arguments),
            Self::Model(arguments) => model::run(&arguments),
            Self::Fit(arguments) => fit::run(&arguments),
            Self::Compare(arguments) => compare::run(&arguments),
            Self::Survey(arguments) => survey::run(&arguments),
            Self::Readings(arguments) => readings::run(&arguments),
            Self::Beside(arguments) => beside::run(&arguments),
            Self::Campaign(arguments) => campaign::run(&arguments),
            Self::Collect(arguments) => campaign::collect(&arguments),
            Self::Completions(arguments) => completions::run(&arguments),
        }
    }
}

/// How the program ends, unless what it said could not be written.
fn ended(code: ExitCode) -> ExitCode {
    match say::finish() {
        Ok(()) => code,
        // Nobody reads on, and that is known.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => ExitCode::from(CLOSED_PIPE),
        Err(error) => {
            say::error(&anyhow!("the standard output cannot be written: {error}"));
            ExitCode::from(BAD_INPUT)
        }
    }
}
