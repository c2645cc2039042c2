//! `figure`, `table` and `paper`: one of the paper's figures, its table, or all of its experiments.

use crate::arguments::{Experiments, Figure, Paper, PaperTable};
use anyhow::Result;
use covmap_cli::terminal::interrupt::{self, Interrupt};
use covmap_cli::terminal::progress::{Bar, Progress};
use covmap_cli::terminal::{Terminal, say};
use covmap_draw::FigureFolder;
use covmap_lab::Watch;
use covmap_paper::{Audience, PaperError, Session, Steps, drawing, gain_figures};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

pub(crate) fn figure(arguments: &Figure) -> Result<ExitCode> {
    draw(&arguments.common, &[], |session, folder| match arguments.number.as_str() {
        "1" | "2" => drawing::cells(session, folder).map(drop),
        "3" => drawing::models(folder).map(drop),
        "5" => drawing::corridor(session, folder).map(drop),
        "6" => drawing::counting(session, folder).map(drop),
        "gain" => gain_figures(folder, session.quick),
        _ => drawing::strategies(session, folder).map(drop),
    })
}

pub(crate) fn table(arguments: &PaperTable) -> Result<ExitCode> {
    draw(&arguments.common, &[], |session, folder| drawing::corridor(session, folder).map(drop))
}

pub(crate) fn paper(arguments: &Paper) -> Result<ExitCode> {
    let begun = Instant::now();
    draw(&arguments.common, &arguments.worlds, |session, folder| {
        covmap_paper::paper(session, folder, &|| begun.elapsed().as_secs_f64())
    })
}

/// Runs a task in a session, and prints the folder of the results; 130 after Ctrl-C.
fn draw(
    arguments: &Experiments,
    worlds: &[(String, PathBuf)],
    what: impl FnOnce(&Session<'_>, &FigureFolder) -> Result<(), PaperError> + Send,
) -> Result<ExitCode> {
    let Experiments { quick, jobs, out, force, quiet } = arguments;
    let interrupt = Interrupt::listen()?;
    let progress = Progress::new(*quiet);
    let terminal = Terminal { progress: &progress, interrupt: &interrupt };
    let watch = Onlooker { terminal, quiet: *quiet };
    let jobs = covmap_cli::jobs(*jobs);
    let session = Session::new(out.clone(), jobs, *quick, worlds, &watch);
    let folder = FigureFolder::create(out, force.replace())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.get()).build()?;
    let done = pool.install(|| what(&session, &folder));
    progress.finish();
    if interrupt.is_pressed() {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    }
    done?;
    if !quiet {
        say::line(folder.dir().display());
    }
    Ok(ExitCode::SUCCESS)
}

/// The observer on the terminal.
struct Onlooker<'a> {
    terminal: Terminal<'a>,
    quiet: bool,
}

impl Audience for Onlooker<'_> {
    fn watch(&self) -> &dyn Watch {
        &self.terminal
    }

    fn line(&self, text: &str) {
        self.terminal.progress.finish();
        if !self.quiet {
            say::line(text);
        }
    }

    fn campaign(&self, name: &str, run: &mut dyn FnMut(&Steps<'_>)) {
        let bar = Bar::new(name, self.quiet);
        run(&|step| bar.note(step));
        bar.finish();
    }

    fn is_stopped_between(&self) -> bool {
        self.terminal.interrupt.done()
    }
}
