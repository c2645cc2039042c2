//! How the experiments are run: where, how many at a time, and how thoroughly.

use crate::arguments::Experiments;
use crate::campaign::{Campaign, Options, RunRecord, Shard, Step, run};
use crate::interrupt::Interrupt;
use crate::progress::Bar;
use crate::say;
use anyhow::{Result, bail};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// A series of experiments.
#[derive(Debug)]
pub(crate) struct Session<'a> {
    /// A look instead of a result.
    pub(crate) quick: bool,
    /// Nothing but errors is printed.
    pub(crate) quiet: bool,
    pub(crate) interrupt: &'a Interrupt,
    jobs: NonZeroUsize,
    out: PathBuf,
}

/// A campaign that was run.
#[derive(Debug)]
pub(crate) struct Series {
    pub(crate) campaign: Campaign,
    /// Its folder.
    pub(crate) dir: PathBuf,
    pub(crate) records: Vec<RunRecord>,
}

impl<'a> Session<'a> {
    pub(crate) fn new(arguments: &Experiments, interrupt: &'a Interrupt) -> Self {
        let all = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Self {
            quick: arguments.quick,
            quiet: arguments.quiet,
            interrupt,
            jobs: arguments.jobs.unwrap_or(all),
            out: arguments.out.clone(),
        }
    }

    /// Where results go.
    pub(crate) fn out(&self) -> &Path {
        &self.out
    }

    /// So many runs at the same time.
    pub(crate) fn jobs(&self) -> NonZeroUsize {
        self.jobs
    }

    /// Runs what is missing of a campaign.
    ///
    /// # Errors
    /// If it is wrong or cannot be written, and after Ctrl-C.
    pub(crate) fn run(&self, campaign: Campaign) -> Result<Series> {
        let dir = self.out.join("campaigns").join(&campaign.name);
        if !self.quiet {
            say::line(format!("{}: {}", campaign.name, dir.display()));
        }
        let options =
            Options { jobs: self.jobs, shard: Shard::WHOLE, out: &dir, interrupt: self.interrupt };
        let bar = Bar::new(self.quiet);
        let records = run(&campaign, &options, &|step| match step {
            Step::Begin { recorded, of } => bar.begin(*recorded, *of),
            Step::Note(note) => bar.note(note),
            Step::Done(_) => bar.done(),
        });
        bar.finish();
        let records = records?;
        self.check()?;
        Ok(Series { campaign, dir, records })
    }

    /// An error after Ctrl-C: what is done stays, and is taken the next time.
    pub(crate) fn check(&self) -> Result<()> {
        if self.interrupt.is_pressed() {
            bail!("interrupted; what is done stays, and the same command goes on with it");
        }
        Ok(())
    }
}
