//! How fast covmap is, as ratios that are measured in one run.
//!
//! A ratio is measured on one core, against something that gives the same answers, by the time
//! that the core computes: what else a machine does hardly changes it. Nothing is asserted of
//! a time.

mod arguments;
mod clock;
mod decisions;
mod fields;
mod firing;
mod growth;
mod integrating;
mod literal;
mod situation;
mod table;
mod tiles;

use anyhow::Result;
use arguments::{Bench, Rows};
use clap::Parser;
use covmap_cli::terminal::progress::Progress;
use covmap_cli::terminal::say;
use covmap_lab::Config;
use std::process::ExitCode;
use table::Table;

/// How much is measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    /// Cells along a side of the small map, and of the large one.
    small: u32,
    large: u32,
    /// Scans of the exploration that the small map is of.
    scans: usize,
    /// View-points that the literal equations are evaluated at.
    sample: usize,
    /// Decisions of which the median is taken: small map, large map, office.
    small_decisions: usize,
    large_decisions: usize,
    office_decisions: usize,
    /// Rounds of the other races.
    rounds: usize,
}

const FULL: Extent = Extent {
    small: 200,
    large: 1000,
    scans: 250,
    sample: 120,
    small_decisions: 30,
    large_decisions: 8,
    office_decisions: 100,
    rounds: 5,
};

const QUICK: Extent = Extent {
    small: 100,
    large: 200,
    scans: 25,
    sample: 8,
    small_decisions: 5,
    large_decisions: 3,
    office_decisions: 10,
    rounds: 1,
};

/// What is measured, with where to say how far it is.
pub(crate) struct Measuring<'a> {
    config: &'a Config,
    extent: Extent,
    progress: &'a Progress,
}

fn main() -> ExitCode {
    let done = run(&Bench::parse());
    if let Err(error) = &done {
        say::error(error);
    }
    if done.is_ok() && say::finish().is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn run(arguments: &Bench) -> Result<()> {
    let config = Config::b21r();
    let extent = if arguments.quick { QUICK } else { FULL };
    let progress = Progress::new(false);
    let bench = Measuring { config: &config, extent, progress: &progress };
    if let Some(folder) = &arguments.growth {
        growth::run(&bench, arguments.quick, (folder, arguments.force))?;
        progress.finish();
        return Ok(());
    }
    let wanted = |rows| arguments.only.is_none_or(|only| only == rows);
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    if let Some(point) = arguments.point {
        one_core.install(|| growth::point(&config, point))?;
        return Ok(());
    }
    let mut table = one_core.install(|| -> Result<Table> {
        let mut table = Table::default();
        if wanted(Rows::Decisions) {
            for update in decisions::updates(&config) {
                decisions::small(&bench, &update, &mut table)?;
                decisions::large(&bench, &update, &mut table)?;
            }
        }
        if wanted(Rows::Integrating) {
            integrating::compare(&bench, &mut table)?;
        }
        if wanted(Rows::Fields) {
            fields::compare(&bench, &mut table)?;
        }
        if wanted(Rows::Firing) {
            firing::compare(&bench, &mut table)?;
        }
        Ok(table)
    })?;
    if wanted(Rows::Decisions) {
        for update in decisions::updates(&config) {
            decisions::office(&bench, &update, &mut table)?;
        }
    }
    progress.finish();
    table.to_string().lines().for_each(say::line);
    Ok(())
}
