//! Running the missing runs of a campaign in parallel.

use crate::error::{CampaignError, Result};
use crate::execute::execute;
use crate::file::Campaign;
use crate::folder::{self, Folder, Planned, Recorded};
use crate::plan::{Job, Plan, Shard};
use crate::record::RunRecord;
use crate::tables;
use covmap_explore::{Event, View};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Options for running a campaign.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The number of runs at the same time.
    pub jobs: NonZeroUsize,
    /// The runs to do.
    pub shard: Shard,
    /// The folder of the campaign.
    pub out: &'a Path,
    /// Whether the campaign is to stop in good order.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// A report while a campaign goes on.
#[derive(Debug)]
pub enum Step {
    /// The campaign begins.
    Begin {
        /// The number of runs of the shard that are recorded already.
        recorded: usize,
        /// The number of runs of the shard.
        of: usize,
    },
    /// A note to the user.
    Note(String),
    /// A run took a scan.
    Scan {
        /// Length of the path since the scan before in this run \[m\].
        metres: f64,
    },
    /// A run is done and recorded.
    Done,
}

/// Checks a campaign and its folder, before anything is run or written.
///
/// # Errors
/// If anything is wrong with the campaign or the folder.
pub fn check(campaign: &Campaign, out: &Path) -> Result<()> {
    Folder::check(out, &Plan::new(campaign)?.manifest)
}

/// Does the runs of the shard that are not recorded yet, writes the tables, and returns all recorded runs
/// of the shard, in the order of the campaign. If `stop` ends this early, runs are missing.
///
/// # Errors
/// If anything is wrong with the campaign or the folder; then nothing was run. If a result cannot be
/// written; then the recorded runs are intact.
pub fn run(
    campaign: &Campaign,
    options: &Options<'_>,
    tell: &(dyn Fn(&Step) + Sync),
) -> Result<Vec<RunRecord>> {
    let plan = Plan::new(campaign)?;
    let at_once = plan.runs_at_once()?;
    if at_once < options.jobs {
        let note =
            format!("the memory that --memory allows is enough for {at_once} runs at a time");
        tell(&Step::Note(note));
    }
    let folder = Folder::open(options.out, &plan.manifest)?;
    plan.notes.iter().for_each(|note| tell(&Step::Note(note.clone())));
    let strangers = folder.strangers(&plan.manifest)?;
    if strangers > 0 {
        let files = if strangers == 1 { "file" } else { "files" };
        tell(&Step::Note(format!(
            "{}: {strangers} {files} that this version of covmap did not write stay there unused",
            options.out.display()
        )));
    }
    let runs: Vec<&Planned> = plan.jobs.iter().map(|job| &job.planned).collect();
    let mut recorded = folder::read_all(options.out, &runs, plan.keep_paths);
    let missing = missing(&recorded, options.shard, tell);
    let of = (0..runs.len()).filter(|index| options.shard.has(*index)).count();
    tell(&Step::Begin { recorded: of - missing.len(), of });
    if !missing.is_empty() {
        tables::remove(options.out)?;
    }
    let jobs: Vec<&Job> = missing.iter().map(|index| &plan.jobs[*index]).collect();
    let options = Options { jobs: options.jobs.min(at_once), ..*options };
    work(&plan, &jobs, &folder, &options, tell)?;
    let done: Vec<&Planned> = missing.iter().map(|index| runs[*index]).collect();
    let done = folder::read_all(options.out, &done, false);
    for (index, done) in missing.into_iter().zip(done) {
        recorded[index] = done;
    }
    let records: Vec<Option<RunRecord>> = recorded.into_iter().map(Recorded::whole).collect();
    let metrics = &plan.manifest.metrics;
    tables::write(options.out, metrics, records.iter().flatten(), records.len())?;
    let mine = records.into_iter().enumerate().filter(|(index, _)| options.shard.has(*index));
    Ok(mine.filter_map(|(_, record)| record).collect())
}

/// The runs of a shard that are not recorded, or whose files are damaged.
fn missing(recorded: &[Recorded], shard: Shard, tell: &(dyn Fn(&Step) + Sync)) -> Vec<usize> {
    let is_missing = |index: &usize| match &recorded[*index] {
        Recorded::Whole(_) => false,
        Recorded::Missing => true,
        Recorded::Damaged(file) => {
            let note = format!("{}: is damaged; the run is done again", file.display());
            tell(&Step::Note(note));
            true
        }
    };
    (0..recorded.len()).filter(|index| shard.has(*index)).filter(is_missing).collect()
}

/// Does the jobs; each worker takes the next run and does all of it by itself.
fn work(
    plan: &Plan,
    jobs: &[&Job],
    folder: &Folder,
    options: &Options<'_>,
    tell: &(dyn Fn(&Step) + Sync),
) -> Result<()> {
    let (next, failed) = (AtomicUsize::new(0), AtomicBool::new(false));
    let error = Mutex::new(None);
    let stop = || failed.load(Ordering::SeqCst) || (options.stop)();
    let one = |job: &Job| -> Result<()> {
        let mut driven = 0.0;
        let mut watch = |event: &Event, view: &View<'_>| {
            if matches!(event, Event::Scan { .. }) {
                tell(&Step::Scan { metres: view.path_length - driven });
                driven = view.path_length;
            }
            if stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        if let Some(done) = execute(plan, job, &mut watch)? {
            folder.write(&job.planned.id, &done.record, done.paths.as_ref())?;
            tell(&Step::Done);
        }
        Ok(())
    };
    let worker = || {
        while !stop() {
            let Some(job) = jobs.get(next.fetch_add(1, Ordering::SeqCst)) else { break };
            if let Err(wrong) = one(job) {
                failed.store(true, Ordering::SeqCst);
                if let Ok(mut error) = error.lock() {
                    error.get_or_insert(wrong);
                }
            }
        }
    };
    let workers = options.jobs.get().min(jobs.len());
    let pools = (0..workers)
        .map(|_| rayon::ThreadPoolBuilder::new().num_threads(1).build())
        .collect::<std::result::Result<Vec<_>, _>>()?;
    std::thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| pool.install(worker));
        }
    });
    let error = error.into_inner().map_err(|_| CampaignError::Worker)?;
    error.map_or(Ok(()), Err)
}
