//! `cargo xtask COMMAND` runs the program `covmap` from its sources, and commands of this
//! repository only: the experiments of the paper, and the developers' tools.
#![allow(clippy::print_stdout, reason = "a program talks to its user")]

mod arguments;
mod paper;
mod tools;

use arguments::{FIGURE_EXAMPLES, Figure, PAPER_EXAMPLES, Paper, PaperTable, Rest};
use clap::Subcommand;
use std::process::ExitCode;

/// The commands of this repository.
#[derive(Debug, Subcommand)]
enum Command {
    #[command(flatten)]
    Covmap(Box<covmap_cli::Command>),
    /// Draws a figure of the paper from its own experiment.
    #[command(after_help = FIGURE_EXAMPLES)]
    Figure(Figure),
    /// Makes a table of the paper from its own experiment.
    Table(PaperTable),
    /// Runs all of the paper's experiments, draws all figures, and judges all claims.
    #[command(after_help = PAPER_EXAMPLES)]
    Paper(Paper),
    /// Measures the speed of decisions, updates and echoes, as ratios: compiles and runs
    /// covmap-bench.
    #[command(disable_help_flag = true)]
    Bench(Rest),
    /// Checks the pages of all crates, their links, and the files and commands that docs/ names.
    DocsCheck,
    /// Plants faults in the core one by one, to see whether a test notices: runs cargo-mutants, for
    /// hours.
    #[command(disable_help_flag = true)]
    Mutants(Rest),
}

fn main() -> ExitCode {
    covmap_cli::run_with("cargo xtask", |command| match command {
        Command::Covmap(command) => command.run(),
        Command::Figure(arguments) => paper::figure(&arguments),
        Command::Table(arguments) => paper::table(&arguments),
        Command::Paper(arguments) => paper::paper(&arguments),
        Command::Bench(Rest { rest }) => tools::bench(&rest),
        Command::DocsCheck => tools::docs_check(),
        Command::Mutants(Rest { rest }) => tools::mutants(&rest),
    })
}
