//! The session of the experiments: their folder, their parallel runs, and their thoroughness.

use crate::error::{PaperError, Result};
use covmap_campaign::{Campaign, Options, RunRecord, Seeds, Setting, Shard, Starts, Step, run};
use covmap_lab::Watch;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Mutex;

/// The receiver of each step of a campaign.
pub type Steps<'a> = dyn Fn(&Step) + Sync + 'a;

/// The caller of the experiments, which receives their progress and may stop them.
pub trait Audience: Sync {
    /// Returns the observer of work that takes long.
    fn watch(&self) -> &dyn Watch;

    /// Receives a message that stays.
    fn line(&self, text: &str);

    /// Starts a campaign, and observes its steps.
    fn campaign(&self, name: &str, run: &mut dyn FnMut(&Steps<'_>));

    /// Returns whether the work is to end; asked between two parts, because the next part may not
    /// ask.
    fn is_stopped_between(&self) -> bool {
        self.watch().is_stopped()
    }
}

/// A series of experiments.
pub struct Session<'a> {
    /// Whether the session is quick, for a look instead of a result.
    pub quick: bool,
    /// Worlds of the campaign of other worlds that come from files.
    pub worlds: &'a [(String, PathBuf)],
    audience: &'a dyn Audience,
    jobs: NonZeroUsize,
    out: PathBuf,
    /// The runs so far: a row for each setting of each campaign.
    ran: Mutex<Vec<Vec<String>>>,
}

/// A finished campaign.
#[derive(Debug)]
pub struct Series {
    /// The campaign.
    pub campaign: Campaign,
    /// The folder of the campaign.
    pub dir: PathBuf,
    /// The records of its runs.
    pub records: Vec<RunRecord>,
}

impl<'a> Session<'a> {
    /// Makes a session with a folder for results, and `jobs` runs at a time.
    pub fn new(
        out: PathBuf,
        jobs: NonZeroUsize,
        quick: bool,
        worlds: &'a [(String, PathBuf)],
        audience: &'a dyn Audience,
    ) -> Self {
        Self { quick, audience, worlds, jobs, out, ran: Mutex::default() }
    }

    /// Returns the observer of work that takes long.
    pub fn watch(&self) -> &dyn Watch {
        self.audience.watch()
    }

    /// Returns the folder of a campaign.
    pub fn folder(&self, campaign: &Campaign) -> PathBuf {
        self.out.join("campaigns").join(&campaign.name)
    }

    /// Runs the missing runs of a campaign.
    ///
    /// # Errors
    /// If the campaign is invalid or cannot be written, and after Ctrl-C.
    pub fn run(&self, campaign: Campaign) -> Result<Series> {
        let dir = self.folder(&campaign);
        self.tell(&format!("{}: {}", campaign.name, dir.display()));
        let stop = &|| self.watch().is_stopped();
        let options = Options { jobs: self.jobs, shard: Shard::WHOLE, out: &dir, stop };
        let mut records = None;
        self.audience
            .campaign(&campaign.name, &mut |tell| records = Some(run(&campaign, &options, tell)));
        let records = records.ok_or(PaperError::Missing("a campaign"))??;
        self.check()?;
        if let Ok(mut ran) = self.ran.lock() {
            ran.extend(campaign.settings.iter().map(|setting| row(&campaign, setting, &records)));
        }
        Ok(Series { campaign, dir, records })
    }

    /// Reports that another task takes time now.
    pub fn tell(&self, text: &str) {
        self.audience.line(text);
    }

    /// Returns the runs so far, for the report: a row for each setting of each campaign.
    pub fn ran(&self) -> Vec<Vec<String>> {
        self.ran.lock().map(|ran| ran.clone()).unwrap_or_default()
    }

    /// Returns an error after Ctrl-C; finished runs stay, and the next session uses them.
    pub fn check(&self) -> Result<()> {
        if self.audience.is_stopped_between() { Err(PaperError::Interrupted) } else { Ok(()) }
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
