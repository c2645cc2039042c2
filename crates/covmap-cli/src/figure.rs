//! `figure` and `table`: one of the paper's figures, or its table, from its own experiment; and how the
//! expected information gain is computed.

use crate::arguments::{Experiments, Figure, Table};
use crate::figures::{Output, gain};
use crate::interrupt::{self, Interrupt};
use crate::paper::{Session, drawing};
use crate::say;
use anyhow::Result;
use std::path::PathBuf;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Figure) -> Result<ExitCode> {
    draw(&arguments.common, &[], |session, output| match arguments.number.as_str() {
        "1" | "2" => drawing::cells(session, output).map(drop),
        "3" => drawing::models(output).map(drop),
        "5" => drawing::corridor(session, output).map(drop),
        "6" => drawing::counting(session, output).map(drop),
        "gain" => gain::write(output, session.quick),
        _ => drawing::strategies(session, output).map(drop),
    })
}

pub(crate) fn table(arguments: &Table) -> Result<ExitCode> {
    draw(&arguments.common, &[], |session, output| drawing::corridor(session, output).map(drop))
}

/// Does something in a session, and says where the results are; 130 after Ctrl-C.
pub(crate) fn draw(
    arguments: &Experiments,
    worlds: &[(String, PathBuf)],
    what: impl FnOnce(&Session<'_>, &Output) -> Result<()> + Send,
) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let session = Session::new(arguments, worlds, &interrupt);
    let output = Output::create(session.out(), arguments.force.replace())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(session.jobs().get()).build()?;
    let done = pool.install(|| what(&session, &output));
    if interrupt.is_pressed() {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    }
    done?;
    if !arguments.quiet {
        say::line(output.dir().display());
    }
    Ok(ExitCode::SUCCESS)
}
