//! `fit`: the sensor model is fitted to the truth.

use crate::arguments::Fit;
use crate::fit_charts;
use crate::fit_file::{FitFile, Source, examples};
use crate::interrupt::{self, Interrupt};
use crate::progress::Progress;
use crate::{input, output, say};
use anyhow::{Result, anyhow};
use covmap_explore::{Config, Spread};
use covmap_fit::{
    ClassScore, Evaluation, Example, ExampleScore, FitSettings, Fitted, Profile, SearchSettings,
    Weighting, fit, score,
};
use covmap_io::{OutputFolder, write_json, write_ron};
use covmap_model::ModelParameters;
use covmap_world::{stream, uniform};
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;

/// All that `fit.json` holds.
#[derive(Serialize)]
struct Report<'a> {
    file: &'a Path,
    seed: u64,
    weighting: Weighting,
    /// Whether Ctrl-C ended the search before its time: what was found is the best so far.
    interrupted: bool,
    training: Compared,
    held_out: Vec<Compared>,
    /// Difference of the objective for each held-out example, after − before.
    held_out_difference: Option<Paired>,
    before: &'a ModelParameters,
    after: &'a ModelParameters,
    path: &'a [Evaluation],
    profiles: &'a [Profile],
}

/// One example, or all together, before and after.
#[derive(Serialize)]
struct Compared {
    name: String,
    before: ExampleScore,
    after: ExampleScore,
}

/// A mean of paired differences with its 95 % interval by Student's t.
#[derive(Serialize)]
struct Paired {
    n: usize,
    mean: f64,
    low: f64,
    high: f64,
}

/// What is added to the words on a search that Ctrl-C ended.
pub(crate) const INTERRUPTED: &str = "; INTERRUPTED, the best that was found so far";

pub(crate) fn run(arguments: &Fit) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let (file, config, name) = FitFile::read(&arguments.file)?;
    let folder = output::of_fit("fit", arguments, (&config, &name))?;
    let mut progress = Progress::new(arguments.quiet);
    let examples = |sources: &[Source]| {
        examples(sources, &arguments.file, (&config, &name), (&progress, &interrupt))
    };
    let (training, held_out) = (examples(&file.training)?, examples(&file.held_out)?);
    if interrupt.done() {
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    }
    let fitted = search(&file, &config, &training, &mut progress, &interrupt)?;
    let stopped = interrupt.done();
    progress.finish();

    let compare = |name: &str, examples: &[Example]| -> Result<Compared> {
        let before = score(examples, &config.model)?;
        let after = score(examples, &fitted.parameters)?;
        Ok(Compared { name: name.to_owned(), before, after })
    };
    let each = |example: &Example| compare(&example.name, std::slice::from_ref(example));
    let held_out: Vec<Compared> = held_out.iter().map(each).collect::<Result<_>>()?;
    let report = Report {
        file: &arguments.file,
        seed: file.seed,
        weighting: file.weighting,
        interrupted: stopped,
        training: compare("training", &training)?,
        held_out_difference: paired(&held_out, file.weighting),
        held_out,
        before: &config.model,
        after: &fitted.parameters,
        path: &fitted.path,
        profiles: &fitted.profiles,
    };
    write(&folder, &config, &report)?;
    let written = folder.finish()?;
    if !arguments.quiet {
        tell(&report, &written);
    }
    Ok(if stopped { interrupt::EXIT_CODE.into() } else { ExitCode::SUCCESS })
}

pub(crate) fn search(
    file: &FitFile,
    config: &Config,
    training: &[Example],
    progress: &mut Progress,
    interrupt: &Interrupt,
) -> Result<Fitted> {
    let settings = FitSettings {
        weighting: file.weighting,
        axes: file.axes.clone(),
        starts: file.starts,
        search: SearchSettings { evaluations: file.evaluations, ..SearchSettings::default() },
    };
    let mut random = stream(file.seed, "fit", 0);
    let (mut count, mut best) = (0, f64::NEG_INFINITY);
    let fitted = fit(
        training,
        &config.model,
        &settings,
        || uniform(&mut random),
        |evaluation| {
            count += 1;
            best = evaluation.log_likelihood.unwrap_or(best).max(best);
            progress.tell(|| {
                format!(
                    "search {} of {} · {count} evaluations · log-likelihood {best:.4} nats a cell",
                    evaluation.start + 1,
                    file.starts
                )
            });
            interrupt.flow()
        },
    );
    fitted.map_err(|error| anyhow!("the fit cannot begin: {error}"))
}

/// The paired differences of the held-out examples; `None` for fewer than two.
fn paired(compared: &[Compared], weighting: Weighting) -> Option<Paired> {
    let of = |score| weighting.objective(score);
    let differences: Vec<f64> = compared.iter().map(|c| of(&c.after) - of(&c.before)).collect();
    let Spread { n, mean, interval, .. } = Spread::of(&differences)?;
    interval.map(|(low, high)| Paired { n, mean, low, high })
}

fn write(folder: &OutputFolder, config: &Config, report: &Report<'_>) -> Result<()> {
    let fitted = Config { model: report.after.clone(), ..config.clone() };
    input::check(&fitted, Path::new("the fitted configuration"))?;
    let comment = format!(
        "Fitted by `cargo xtask fit {}`, seed {}{}.\n\
         Mean log-likelihood of the true coverage of a cell [nats], before → after:\n\
         training {:.4} → {:.4} ({} cells){}",
        report.file.display(),
        report.seed,
        if report.interrupted { INTERRUPTED } else { "" },
        report.training.before.all.log_likelihood,
        report.training.after.all.log_likelihood,
        report.training.after.all.cells,
        report.held_out_difference.as_ref().map_or_else(String::new, |d| format!(
            "\nheld out, difference: {:+.4}, 95 % interval [{:+.4}, {:+.4}] of {} examples",
            d.mean, d.low, d.high, d.n
        )),
    );
    write_ron(folder.path("config.ron"), &fitted, Some(&comment))?;
    let chart = |name: &str, kind: &str| folder.path(&format!("{name}.{kind}"));
    fit_charts::search(report.path).save(chart("search", "svg"), chart("search", "png"))?;
    fit_charts::profiles(report.profiles, report.after)
        .save(chart("profiles", "svg"), chart("profiles", "png"))?;
    // Last: whoever finds it finds all the others.
    write_json(folder.path("fit.json"), report)?;
    Ok(())
}

fn tell(report: &Report<'_>, written: &Path) {
    let change = |before: ClassScore, after: ClassScore| {
        format!("{:.3} → {:.3}", before.log_likelihood, after.log_likelihood)
    };
    let row = |compared: &Compared| {
        let (before, after) = (&compared.before, &compared.after);
        say::line(format!(
            "  {:36} all {} · free {} · partial {} · solid {} · error {:.3} → {:.3}",
            compared.name,
            change(before.all, after.all),
            change(before.free, after.free),
            change(before.partial, after.partial),
            change(before.solid, after.solid),
            before.all.error,
            after.all.error
        ));
    };
    say::line("mean log-likelihood [nats] and mean absolute error, before → after:");
    row(&report.training);
    report.held_out.iter().for_each(row);
    if let Some(Paired { n, mean, low, high }) = report.held_out_difference {
        say::line(format!("  held out: {mean:+.4} [{low:+.4}, {high:+.4}], {n} examples"));
    }
    say::line(format!("  {} evaluations; {}", report.path.len(), written.display()));
}
