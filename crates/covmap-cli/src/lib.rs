//! The program `covmap`: explores worlds, makes maps of logs, fits, compares, runs campaigns, and writes what
//! came out.
//!
//! [`run`] is the whole program: `covmap` itself and `cargo xtask` call it. What computes is in the other
//! crates; here are arguments, files, the terminal, the clock and Ctrl-C.
//!
//! ```text
//! cargo install --path crates/covmap-cli
//! covmap explore scenarios/office.ron
//! ```
#![allow(clippy::print_stdout, reason = "a program talks to its user")]

mod arguments;
mod bench;
mod beside;
mod campaign;
mod certificate_file;
mod compare;
mod csv_file;
mod explain;
mod explain_picture;
mod explore;
mod figure;
mod figures;
mod file_kind;
mod fit;
mod fit_charts;
mod fit_file;
mod fit_report;
mod input;
mod interrupt;
mod log;
mod map;
mod map_pictures;
mod map_report;
mod mapper;
mod memory;
mod model;
mod output;
mod paper;
mod partial;
mod pictures;
mod progress;
mod readings;
mod recorded;
mod reliability_charts;
mod replay;
mod results;
mod run_path;
mod say;
mod survey;
mod trace_file;
mod trail;
mod truth;
mod way;
mod world_file;

use anyhow::anyhow;
use arguments::{Arguments, Command};
use std::io::ErrorKind;
use std::process::ExitCode;

/// What the program ends with after bad input; clap ends with the same.
const BAD_INPUT: u8 = 2;
/// What a shell says of a program that was ended by a closed pipe.
const CLOSED_PIPE: u8 = 141;

/// Runs the program with what was typed after `name`, as which it calls itself: `covmap`, or
/// `cargo xtask`.
pub fn run(name: &str) -> ExitCode {
    let Arguments { command, memory } = match Arguments::typed(name) {
        Ok(arguments) => arguments,
        Err(told) => return ended(say::clap(told)),
    };
    memory::allow(memory.memory);
    let done = match command {
        Command::Explore(arguments) => explore::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Map(arguments) => map::run(&arguments),
        Command::Log(arguments) => log::run(&arguments),
        Command::Truth(arguments) => truth::run(&arguments),
        Command::Model(arguments) => model::run(&arguments),
        Command::Fit(arguments) => fit::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Survey(arguments) => survey::run(&arguments),
        Command::Readings(arguments) => readings::run(&arguments),
        Command::Beside(arguments) => beside::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Figure(arguments) => figure::run(&arguments),
        Command::Table(arguments) => figure::table(&arguments),
        Command::Paper(arguments) => paper::run(&arguments),
        Command::Campaign(arguments) => campaign::command(&arguments),
        Command::Collect(arguments) => campaign::collect(&arguments),
    };
    ended(done.unwrap_or_else(|error| {
        say::error(&error);
        ExitCode::from(BAD_INPUT)
    }))
}

/// How the program ends, unless what it said could not be written.
fn ended(code: ExitCode) -> ExitCode {
    match say::finish() {
        Ok(()) => code,
        // Whoever closed the pipe does not want to read on, and knows.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => ExitCode::from(CLOSED_PIPE),
        Err(error) => {
            say::error(&anyhow!("the standard output cannot be written: {error}"));
            ExitCode::from(BAD_INPUT)
        }
    }
}
