//! `fit`: a fit of the sensor model to the truth.

use crate::arguments::Fit;
use crate::fit_charts;
use crate::fit_report::{self, Maps, Report};
use crate::output;
use crate::terminal::Terminal;
use crate::terminal::interrupt::{self, Interrupt};
use crate::terminal::progress::Progress;
use anyhow::Result;
use covmap_io::{OutputFolder, write_json, write_ron};
use covmap_lab::{Config, FitPlan, Source, files, results::reliability};
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Fit) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let plan = FitPlan::read(&arguments.file)?;
    let (file, config) = (&plan.file, &plan.begin.config);
    let folder = output::of_fit("fit", arguments, &plan)?;
    let progress = Progress::new(arguments.quiet);
    let terminal = Terminal { progress: &progress, interrupt: &interrupt };
    let examples = |sources: &[Source]| plan.examples(sources, &terminal);
    let (training, held_out) = (examples(&file.training)?, examples(&file.held_out)?);
    if interrupt.done() {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    }
    let fitted = plan.search(&training, &terminal)?;
    let stopped = interrupt.done();
    progress.say("fitting the read-out …");
    let models = (&config.model, &fitted.parameters);
    let training = Maps::of(&training, models)?;
    let held_out = Maps::of(&held_out, models)?;
    let read_out = fit_report::read_out(&training, fitted.parameters.bins, file.weighting);
    let report = Report::new(
        (&arguments.file, file.seed, file.weighting),
        (&config.model, &fitted, stopped),
        (&training, &held_out),
        read_out,
    )?;
    progress.finish();
    write(&folder, config, &report)?;
    let written = folder.finish()?;
    if !arguments.quiet {
        fit_report::tell(&report, &written);
    }
    Ok(if stopped { interrupt::EXIT_CODE.into() } else { ExitCode::SUCCESS })
}

fn write(folder: &OutputFolder, config: &Config, report: &Report<'_>) -> Result<()> {
    let fitted = Config { model: report.after.clone(), ..config.clone() };
    files::check(&fitted, Path::new("the fitted configuration"))?;
    let comment = report.provenance();
    write_ron(folder.path("config.ron"), &fitted, Some(&comment))?;
    write_ron(folder.path("read_out.ron"), &report.read_out, Some(&comment))?;
    let path = |name: &str, kind: &str| folder.path(&format!("{name}.{kind}"));
    let both = |name: &str| (path(name, "svg"), path(name, "png"));
    let (svg, png) = both("search");
    fit_charts::search(report.path).save(svg, png)?;
    let (svg, png) = both("profiles");
    fit_charts::profiles(report.profiles, report.after).save(svg, png)?;
    let (svg, png) = both("reliability");
    let bins = report.after.bins;
    let maps = [("as it is", &report.reliability), ("read out", &report.reliability_read_out)];
    reliability::figure(&report.checked_on(), &maps, bins).save(svg, png)?;
    // The last file: its presence means that all others are complete.
    write_json(folder.path("fit.json"), report)?;
    Ok(())
}
