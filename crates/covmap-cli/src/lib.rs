//! The program `covmap`: explores worlds, builds maps from logs, fits, compares, runs campaigns,
//! and writes the results.
//!
//! [`run`] is the whole program, and [`run_with`] a program with more commands, such as `cargo
//! xtask`. The computations are in the other crates; this crate has the arguments, the files, the
//! terminal, the clock and Ctrl-C.
//!
//! ```text
//! cargo install --path crates/covmap-cli
//! covmap explore scenarios/office.ron
//! ```
#![allow(clippy::print_stdout, reason = "a program talks to its user")]

mod about;
mod arguments;
mod bag;
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
use std::num::NonZeroUsize;
use std::process::ExitCode;
use terminal::say;

/// The exit code after bad input; clap uses the same.
const BAD_INPUT: u8 = 2;
/// The exit code that a shell reports for a program that a closed pipe ended.
const CLOSED_PIPE: u8 = 141;

/// Runs the program with the command line; the program calls itself `name`.
pub fn run(name: &str) -> ExitCode {
    run_with(name, Command::run)
}

/// Runs a program with commands of its own; `act` executes a command.
pub fn run_with<C: Subcommand>(name: &str, act: impl FnOnce(C) -> Result<ExitCode>) -> ExitCode {
    let Arguments { command, memory } = match Arguments::typed(name) {
        Ok(arguments) => arguments,
        Err(told) => return ended(say::clap(told)),
    };
    memory::allow(memory.memory);
    end(act(command))
}

/// Ends a program: says what went wrong, and returns the exit code.
pub fn end(done: Result<ExitCode>) -> ExitCode {
    ended(done.unwrap_or_else(|error| {
        say::error(&error);
        ExitCode::from(BAD_INPUT)
    }))
}

/// Returns the number of runs at the same time: by default one for each core.
pub fn jobs(asked: Option<NonZeroUsize>) -> NonZeroUsize {
    asked.or(std::thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
}

impl Command {
    /// Executes the command.
    ///
    /// # Errors
    /// One sentence, which names the file if there is one.
    pub fn run(self) -> Result<ExitCode> {
        match self {
            Self::Explore(arguments) => explore::run(&arguments),
            Self::Explain(arguments) => explain::run(&arguments),
            Self::Map(arguments) => map::run(&arguments),
            Self::Log(arguments) => log::run(&arguments),
            Self::Bag(arguments) => bag::run(&arguments),
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

/// Returns the exit code, or another one if the output could not be written.
fn ended(code: ExitCode) -> ExitCode {
    match say::finish() {
        Ok(()) => code,
        // The reader closed the pipe on purpose.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => ExitCode::from(CLOSED_PIPE),
        Err(error) => {
            say::error(&anyhow!("the standard output cannot be written: {error}"));
            ExitCode::from(BAD_INPUT)
        }
    }
}
