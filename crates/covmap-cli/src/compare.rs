//! `compare`: mapping methods against the same truth, each tuned and calibrated alike.

use crate::arguments::Fit;
use crate::output;
use crate::terminal::Terminal;
use crate::terminal::interrupt;
use crate::terminal::interrupt::Interrupt;
use crate::terminal::progress::Progress;
use crate::terminal::say;
use anyhow::{Result, bail};
use covmap_fit::{
    Axis, BetaCounting, CellMean, ComparisonRow, ComparisonSettings, Contender, Crm, Example,
    LogOdds, Method, MethodParameter, Parameter, TuneSettings, Update, compare, tune,
};
use covmap_io::csv;
use covmap_io::{FileError, OutputFolder, write_json};
use covmap_lab::{Config, FitFile, FitPlan, Source, Watch};
use covmap_model::ModelParameters;
use covmap_statistics::{stream, uniform};
use serde::Serialize;
use std::io::Write;
use std::process::ExitCode;

/// The parameters that the paper fits: those of Eq. (9).
const PAPER: [Parameter; 7] = [
    Parameter::GammaBase,
    Parameter::GammaPerCellDistance,
    Parameter::GammaPerRange,
    Parameter::SigmaOutBase,
    Parameter::SigmaOutPerCellDistance,
    Parameter::SigmaOutPerRange,
    Parameter::SigmaIn,
];

/// The comparison in one direction: fitted on some examples, checked on others.
#[derive(Serialize)]
struct Direction {
    fitted_on: Vec<String>,
    checked_on: Vec<String>,
    /// The tuned contenders.
    contenders: Vec<Contender>,
    rows: Vec<ComparisonRow>,
}

/// A method before its tuning.
struct Entry {
    name: String,
    method: Method,
    axes: Vec<Axis<MethodParameter>>,
}

pub(crate) fn run(arguments: &Fit) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let plan = FitPlan::read(&arguments.file)?;
    let (file, config) = (&plan.file, &plan.begin.config);
    if file.held_out.is_empty() {
        bail!("{}: held_out: a comparison needs at least one entry", arguments.file.display());
    }
    let folder = output::of_fit("compare", arguments, &plan)?;
    let progress = Progress::new(arguments.quiet);
    let terminal = Terminal { progress: &progress, interrupt: &interrupt };
    let examples = |sources: &[Source]| plan.examples(sources, &terminal);
    let (a, b) = (examples(&file.training)?, examples(&file.held_out)?);
    let mut directions = Vec::new();
    for (training, test) in [(&a, &b), (&b, &a)] {
        directions.push(direction(file, config, (training, test), &terminal)?);
        // An interrupted comparison has no results.
        if interrupt.done() {
            return Ok(ExitCode::from(interrupt::EXIT_CODE));
        }
    }
    write_table(&folder, &directions)?;
    write_json(folder.path("compare.json"), &directions)?;
    let written = folder.finish()?;
    progress.finish();
    if !arguments.quiet {
        directions.iter().for_each(tell);
        say::line(written.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns the methods to compare. The reference comes first: the update of the configuration.
fn entries(file: &FitFile, config: &Config, training: &[Example]) -> Vec<Entry> {
    let with = |update: Update| Method { model: config.model.clone(), update };
    let coverage = |name: &str, model: &ModelParameters, axes: &[Axis]| Entry {
        name: format!("coverage, {}{name}", in_words(&model.update)),
        method: Method { model: model.clone(), update: Update::Coverage },
        axes: axes.iter().map(of_model).collect(),
    };
    let own = |name: &str, axes: &[Axis]| coverage(name, &config.model, axes);
    let read_with_a_prior = |entry: Entry| {
        let update = Update::CoverageWithPrior(0.5);
        let axes = update.axes().into_iter().chain(entry.axes).collect();
        Entry { method: Method { update, ..entry.method }, axes, ..entry }
    };
    let baseline = |name: &str, update: Update| Entry {
        name: name.to_owned(),
        axes: update.axes(),
        method: with(update),
    };
    let constant = |name: &str, method| Entry { name: name.to_owned(), method, axes: Vec::new() };
    let other = the_other(&config.model);
    let product = if config.model.update.product().is_some() { &config.model } else { &other };
    let paper: Vec<Axis> = Axis::all_of(&product.update)
        .into_iter()
        .filter(|axis| PAPER.contains(&axis.parameter))
        .collect();
    vec![
        own("", &file.axes),
        read_with_a_prior(own(", prior", &file.axes)),
        own(", unfitted", &[]),
        coverage("", &other, &Axis::all_of(&other.update)),
        coverage(", γ and σ", product, &paper),
        baseline("log-odds", Update::LogOdds(LogOdds::default())),
        baseline("Beta counting", Update::BetaCounting(BetaCounting::default())),
        baseline("forward (CRM)", Update::Crm(Crm::default())),
        constant("constant .5", with(Update::Constant(0.5))),
        constant("constant, mean", Method::training_mean(config.model.clone(), training)),
    ]
}

fn in_words(update: &covmap_model::Update) -> &'static str {
    match update {
        covmap_model::Update::Product(_) => "Eq. 9",
        covmap_model::Update::Cause(_) => "by cause",
    }
}

/// Returns the same model with the other update, with the parameters fitted for the default.
fn the_other(model: &ModelParameters) -> ModelParameters {
    let other = match model.update {
        covmap_model::Update::Product(_) => ModelParameters::b21r(),
        covmap_model::Update::Cause(_) => ModelParameters::product(),
    };
    ModelParameters { update: other.update, ..model.clone() }
}

fn of_model(&Axis { parameter, from, to }: &Axis) -> Axis<MethodParameter> {
    Axis { parameter: MethodParameter::Model(parameter), from, to }
}

fn direction(
    file: &FitFile,
    config: &Config,
    (training, test): (&[Example], &[Example]),
    watch: &dyn Watch,
) -> Result<Direction> {
    let mut contenders = Vec::new();
    for (number, entry) in (0u64..).zip(entries(file, config, training)) {
        let tuned = |calibrated: bool| -> Result<Method> {
            if entry.axes.is_empty() {
                return Ok(entry.method.clone());
            }
            let settings = TuneSettings {
                weighting: file.weighting,
                calibrated,
                evaluations: file.evaluations,
            };
            let mut random = stream(file.seed, "compare", 2 * number + u64::from(calibrated));
            let mut count = 0;
            let report = |_: Option<f64>| {
                count += 1;
                watch.tell(&format_args!("{}: {count} of {} maps", entry.name, file.evaluations));
                watch.flow()
            };
            let tuned = tune(
                &entry.method,
                &entry.axes,
                training,
                &settings,
                || uniform(&mut random),
                report,
            )?;
            Ok(tuned.method)
        };
        let (raw, calibrated) = (tuned(false)?, tuned(true)?);
        contenders.push(Contender { name: entry.name.clone(), raw, calibrated });
    }
    watch.begin("resampling blocks of the trajectories …");
    let settings =
        ComparisonSettings { weighting: file.weighting, ..ComparisonSettings::default() };
    let mut random = stream(file.seed, "blocks", 0);
    let rows = compare(&contenders, training, test, &settings, || uniform(&mut random))?;
    let names = |examples: &[Example]| examples.iter().map(|e| e.name.clone()).collect();
    Ok(Direction { fitted_on: names(training), checked_on: names(test), contenders, rows })
}

const COLUMNS: &str = "fitted_on,method,calibrated,class,cells,log_likelihood,log_likelihood_low,\
log_likelihood_high,difference,difference_low,difference_high,crps,error,central_50,central_90";

fn write_table(folder: &OutputFolder, directions: &[Direction]) -> Result<(), FileError> {
    csv::write(&folder.path("compare.csv"), |table| {
        writeln!(table, "{COLUMNS}")?;
        for direction in directions {
            for row in &direction.rows {
                let classes = [
                    ("all", &row.classes.all),
                    ("free", &row.classes.free),
                    ("partial", &row.classes.partial),
                    ("solid", &row.classes.solid),
                ];
                for (class, score) in classes {
                    let likelihood = &score.log_likelihood;
                    let ends = |interval: Option<(f64, f64)>| {
                        interval
                            .map_or_else(|| ",".to_owned(), |(low, high)| format!("{low},{high}"))
                    };
                    let difference = likelihood.difference.map_or_else(
                        || ",,".to_owned(),
                        |d| format!("{},{}", d.value, ends(d.interval)),
                    );
                    writeln!(
                        table,
                        "{:?},{:?},{},{class},{},{},{},{difference},{},{},{},{}",
                        direction.fitted_on.join(" + "),
                        row.name,
                        row.calibrated,
                        score.cells,
                        likelihood.value,
                        ends(likelihood.interval),
                        score.crps.value,
                        score.error.value,
                        score.central_50.value,
                        score.central_90.value
                    )?;
                }
            }
        }
        Ok(())
    })
}

fn tell(direction: &Direction) {
    say::line(format!(
        "fitted on {}, checked on {}: mean log-likelihood [nats] with its 95 % interval, CRPS,\n\
         mean absolute error, and the share of truths in the central 90 %",
        direction.fitted_on.join(" + "),
        direction.checked_on.join(" + ")
    ));
    for row in &direction.rows {
        let in_words = |estimate: &CellMean| match estimate.interval {
            Some((low, high)) => format!("{:7.3} [{low:7.3}, {high:7.3}]", estimate.value),
            None => format!("{:7.3}                    ", estimate.value),
        };
        let (all, partial) = (&row.classes.all, &row.classes.partial);
        say::line(format!(
            "  {:26} {:10} all {}  crps {:.3}  error {:.3}  90 %: {:.2}   partial {}  error {:.3}  90 %: {:.2}",
            row.name,
            if row.calibrated { "calibrated" } else { "" },
            in_words(&all.log_likelihood),
            all.crps.value,
            all.error.value,
            all.central_90.value,
            in_words(&partial.log_likelihood),
            partial.error.value,
            partial.central_90.value
        ));
    }
}
