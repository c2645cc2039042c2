//! `campaign` and `collect`: run the campaign of a file, and merge the folders of several machines.

use crate::arguments::{Campaign as Arguments, Collect};
use crate::jobs;
use crate::terminal::interrupt::{self, Interrupt};
use crate::terminal::progress::Bar;
use crate::terminal::say;
use anyhow::Result;
use covmap_campaign::{Campaign, Collected, Options, Plan, Step};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let mut campaign = Campaign::read(&arguments.file)?;
    for (name, file) in &arguments.worlds {
        campaign.replace_world(name, file)?;
    }
    if arguments.check {
        let plan = Plan::new(&campaign)?;
        plan.notes.iter().for_each(say::note);
        say::line(format!("{}: {} runs", campaign.name, plan.jobs.len()));
        return Ok(ExitCode::SUCCESS);
    }
    let out = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.file));
    let jobs = jobs(arguments.jobs);
    let options =
        Options { jobs, shard: arguments.shard, out: &out, stop: &|| interrupt.is_pressed() };
    let bar = Bar::new(&campaign.name, arguments.quiet);
    let all = AtomicUsize::new(0);
    let records = covmap_campaign::run(&campaign, &options, &|step| {
        if let Step::Begin { of, .. } = step {
            all.store(*of, Ordering::Relaxed);
        }
        bar.note(step);
    });
    bar.finish();
    let records = records?;
    if interrupt.done() {
        let (done, all, name) = (records.len(), all.into_inner(), &campaign.name);
        say::note(format!(
            "interrupted; {done} of {all} runs of {name} are recorded; the same command continues"
        ));
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    }
    if !arguments.quiet {
        say::line(format!("{}: {} runs of {}", out.display(), records.len(), campaign.name));
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns the default folder: `out/fig7` for `configs/fig7.ron`.
fn default_folder(file: &Path) -> PathBuf {
    Path::new("out").join(file.file_stem().unwrap_or_default())
}

pub(crate) fn collect(arguments: &Collect) -> Result<ExitCode> {
    let Collect { dirs, out, quiet } = arguments;
    let out = out.as_deref().unwrap_or(&dirs[0]);
    let Collected { name, recorded, of, damaged } = covmap_campaign::collect(dirs, out)?;
    for file in damaged {
        say::note(format!("{}: is damaged, and is left out", file.display()));
    }
    if recorded < of {
        say::note(format!("{}: {} runs are missing", out.display(), of - recorded));
    }
    if !quiet {
        say::line(format!("{}: {recorded} of {of} runs of {name}", out.display()));
    }
    Ok(ExitCode::SUCCESS)
}
