//! How the experiments are run: where, how many at a time, and how thoroughly.

use crate::arguments::Experiments;
use crate::campaign::{Campaign, Options, RunRecord, Seeds, Setting, Shard, Starts, run};
use crate::interrupt::Interrupt;
use crate::progress::Bar;
use crate::say;
use anyhow::{Result, bail};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// A series of experiments.
#[derive(Debug)]
pub(crate) struct Session<'a> {
    /// A look instead of a result.
    pub(crate) quick: bool,
    /// Nothing but errors is printed.
    pub(crate) quiet: bool,
    pub(crate) interrupt: &'a Interrupt,
    /// Worlds of the campaign of other worlds that are taken from files.
    pub(crate) worlds: &'a [(String, PathBuf)],
    jobs: NonZeroUsize,
    out: PathBuf,
    /// What was run: a row for each setting of each campaign.
    ran: Mutex<Vec<Vec<String>>>,
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
    pub(crate) fn new(
        arguments: &Experiments,
        worlds: &'a [(String, PathBuf)],
        interrupt: &'a Interrupt,
    ) -> Self {
        let all = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Self {
            quick: arguments.quick,
            quiet: arguments.quiet,
            interrupt,
            worlds,
            jobs: arguments.jobs.unwrap_or(all),
            out: arguments.out.clone(),
            ran: Mutex::default(),
        }
    }

    /// Where results go.
    pub(crate) fn out(&self) -> &Path {
        &self.out
    }

    /// The number of runs at the same time.
    pub(crate) fn jobs(&self) -> NonZeroUsize {
        self.jobs
    }

    /// The folder of a campaign.
    pub(crate) fn folder(&self, campaign: &Campaign) -> PathBuf {
        self.out.join("campaigns").join(&campaign.name)
    }

    /// Runs what is missing of a campaign.
    ///
    /// # Errors
    /// If it is wrong or cannot be written, and after Ctrl-C.
    pub(crate) fn run(&self, campaign: Campaign) -> Result<Series> {
        let dir = self.folder(&campaign);
        self.tell(&format!("{}: {}", campaign.name, dir.display()));
        let options =
            Options { jobs: self.jobs, shard: Shard::WHOLE, out: &dir, interrupt: self.interrupt };
        let bar = Bar::new(&campaign.name, self.quiet);
        let records = run(&campaign, &options, &|step| bar.note(step));
        bar.finish();
        let records = records?;
        self.check()?;
        if let Ok(mut ran) = self.ran.lock() {
            ran.extend(campaign.settings.iter().map(|setting| row(&campaign, setting, &records)));
        }
        Ok(Series { campaign, dir, records })
    }

    /// Says that something else takes time now.
    pub(crate) fn tell(&self, text: &str) {
        if !self.quiet {
            say::line(text);
        }
    }

    /// What was run, for the report: [`RAN`] are the columns.
    pub(crate) fn ran(&self) -> Vec<Vec<String>> {
        self.ran.lock().map(|ran| ran.clone()).unwrap_or_default()
    }

    /// An error after Ctrl-C: what is done stays, and is taken the next time.
    pub(crate) fn check(&self) -> Result<()> {
        if self.interrupt.done() {
            bail!("interrupted; what is done stays, and the same command goes on with it");
        }
        Ok(())
    }
}

/// The columns of [`Session::ran`].
pub(crate) const RAN: [&str; 8] = [
    "campaign",
    "worlds",
    "setting",
    "configuration",
    "with",
    "starts",
    "seeds",
    "runs, and their time [min]",
];

fn row(campaign: &Campaign, setting: &Setting, records: &[RunRecord]) -> Vec<String> {
    let mut with: Vec<String> =
        setting.overrides.iter().map(|(path, value)| format!("{path}: {value}")).collect();
    with.extend(setting.while_driving.map(|every| format!("a scan every {every} m")));
    with.extend(setting.max_scans.map(|most| format!("at most {most} scans")));
    let mine: Vec<&RunRecord> = records.iter().filter(|r| r.key.setting == setting.name).collect();
    let worlds: std::collections::BTreeSet<&str> =
        mine.iter().map(|record| record.key.world.as_str()).collect();
    let worlds: Vec<&str> = worlds.into_iter().collect();
    let starts = match &campaign.starts {
        Starts::Drawn { count, seed } => format!("{count}, drawn with seed {seed}"),
        Starts::Given => "given by the world".to_owned(),
        other => format!("{other:?}"),
    };
    let seconds: f64 = mine.iter().filter_map(|r| r.times.get("seconds")).sum();
    let Seeds { first, count } = campaign.seeds;
    vec![
        campaign.name.clone(),
        worlds.join(", "),
        setting.name.clone(),
        setting.config.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        with.join(", "),
        starts,
        format!("{first} to {}", first + count.max(1) as u64 - 1),
        format!("{}, {:.1}", mine.len(), seconds / 60.0),
    ]
}
