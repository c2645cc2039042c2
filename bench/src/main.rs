//! The speed of covmap, as ratios measured in one run.
//!
//! Both sides of a ratio give the same answers. They are measured on one core, by the time that the
//! core computes; other work of the machine hardly changes the ratio. No test asserts a time.

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
use table::RatioTable;

/// The extent of the measurements.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    /// The number of cells along a side of the small map, and of the large one.
    small: u32,
    large: u32,
    /// The number of scans before the measurements on the small map.
    scans: usize,
    /// The number of view-points for the literal equations.
    sample: usize,
    /// The number of decisions behind a median: small map, large map, office.
    small_decisions: usize,
    large_decisions: usize,
    office_decisions: usize,
    /// The number of rounds of the other races.
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

/// The configuration and the extent of the measurements, with the line of progress.
pub(crate) struct Measuring<'a> {
    config: &'a Config,
    extent: Extent,
    progress: &'a Progress,
}

fn main() -> ExitCode {
    covmap_cli::end(run(&Bench::parse()).map(|()| ExitCode::SUCCESS))
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
    let mut table = one_core.install(|| -> Result<RatioTable> {
        let mut table = RatioTable::default();
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
