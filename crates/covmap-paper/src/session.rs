//! How the experiments are run: where, how many at a time, and how thoroughly.

use crate::error::{PaperError, Result};
use covmap_campaign::{Campaign, Options, RunRecord, Seeds, Setting, Shard, Starts, Step, run};
use covmap_lab::Watch;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// What is told each step of a campaign.
pub type Steps<'a> = dyn Fn(&Step) + Sync + 'a;

/// Who started the experiments, is told how far they are, and may end them.
pub trait Audience: Watch {
    /// Is told something to be remembered.
    fn line(&self, text: &str);

    /// Starts a campaign, and looks at its steps.
    fn campaign(&self, name: &str, run: &mut dyn FnMut(&Steps<'_>));

    /// Whether the work is to end; asked between two parts, of which the next one may not ask.
    fn is_stopped_between(&self) -> bool {
        self.is_stopped()
    }
}

/// A series of experiments.
pub struct Session<'a> {
    /// Whether it is a look instead of a result.
    pub quick: bool,
    /// Who looks on.
    pub watch: &'a dyn Audience,
    /// Worlds of the campaign of other worlds that are taken from files.
    pub worlds: &'a [(String, PathBuf)],
    jobs: NonZeroUsize,
    out: PathBuf,
    /// What was run: a row for each setting of each campaign.
    ran: Mutex<Vec<Vec<String>>>,
}

/// A campaign that was run.
#[derive(Debug)]
pub struct Series {
    /// What it is.
    pub campaign: Campaign,
    /// Its folder.
    pub dir: PathBuf,
    /// What was recorded.
    pub records: Vec<RunRecord>,
}

impl<'a> Session<'a> {
    /// Experiments whose results go into a folder, so many runs at a time.
    pub fn new(
        out: PathBuf,
        jobs: NonZeroUsize,
        quick: bool,
        worlds: &'a [(String, PathBuf)],
        watch: &'a dyn Audience,
    ) -> Self {
        Self { quick, watch, worlds, jobs, out, ran: Mutex::default() }
    }

    /// Where results go.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// The number of runs at the same time.
    pub fn jobs(&self) -> NonZeroUsize {
        self.jobs
    }

    /// The folder of a campaign.
    pub fn folder(&self, campaign: &Campaign) -> PathBuf {
        self.out.join("campaigns").join(&campaign.name)
    }

    /// Runs what is missing of a campaign.
    ///
    /// # Errors
    /// If it is wrong or cannot be written, and after Ctrl-C.
    pub fn run(&self, campaign: Campaign) -> Result<Series> {
        let dir = self.folder(&campaign);
        self.tell(&format!("{}: {}", campaign.name, dir.display()));
        let stop = &|| self.watch.is_stopped();
        let options = Options { jobs: self.jobs, shard: Shard::WHOLE, out: &dir, stop };
        let mut records = None;
        self.watch
            .campaign(&campaign.name, &mut |tell| records = Some(run(&campaign, &options, tell)));
        let records = records.ok_or(PaperError::Missing("a campaign"))??;
        self.check()?;
        if let Ok(mut ran) = self.ran.lock() {
            ran.extend(campaign.settings.iter().map(|setting| row(&campaign, setting, &records)));
        }
        Ok(Series { campaign, dir, records })
    }

    /// Says that something else takes time now.
    pub fn tell(&self, text: &str) {
        self.watch.line(text);
    }

    /// What was run, for the report: a row for each setting of each campaign.
    pub fn ran(&self) -> Vec<Vec<String>> {
        self.ran.lock().map(|ran| ran.clone()).unwrap_or_default()
    }

    /// An error after Ctrl-C: what is done stays, and is taken the next time.
    pub fn check(&self) -> Result<()> {
        if self.watch.is_stopped_between() { Err(PaperError::Interrupted) } else { Ok(()) }
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
