//! `explore`: the exploration of a world to its end.

use crate::arguments::Explore;
use crate::built_in;
use crate::fit_report;
use crate::names;
use crate::output;
use crate::terminal::interrupt::{self, Interrupt};
use crate::terminal::progress::Progress;
use crate::terminal::say;
use anyhow::Result;
use covmap_explore::{Ending, Limits, Run};
use covmap_io::Digest;
use covmap_io::MapCounts;
use covmap_lab::{
    Config, CutOff, Experiment, Summary, TraceWriter,
    files::{self, Remarks, WorldFile},
    results::{self, Task, Written},
};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

pub(crate) fn run(arguments: &Explore) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    if let Some(widest) = arguments.registers {
        widest.limit();
    }
    let (task, remarks, world) = task(arguments)?;
    let read_out = arguments.read_out.read_out.as_ref();
    let inputs = [Some(&arguments.world), arguments.config.as_ref(), read_out];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
    let run = run_line(&task, world, arguments.read_out.path())?;
    let folder = output::folder(&folder_name(arguments, &task)?, &run, arguments.force, &inputs)?;
    if !arguments.quiet {
        say::remarks(&remarks);
    }
    let progress = Progress::new(arguments.quiet);
    let mut trace = TraceWriter::create(&folder.path("trace.jsonl"))?;
    let begun = Instant::now();
    let run = watch(&task, &mut trace, &progress, &interrupt)?;
    interrupt.done();
    let seconds = begun.elapsed().as_secs_f64();
    let hash = trace.finish(&run.map)?;
    progress.say("drawing and scoring the map …");
    let (written, counts) = results::write(&folder, &task, &run, seconds, hash)?;
    let folder = folder.finish()?;
    progress.finish();
    if !arguments.quiet {
        report(&written, &counts, &folder);
    }
    Ok(ExitCode::from(exit_code(run.ending)))
}

/// Returns the task, the remarks about the world, and the bytes that identify the world.
fn task(arguments: &Explore) -> Result<(Task, Remarks, Vec<u8>)> {
    let (config, name) = files::config(arguments.config.as_deref(), built_in::B21R)?;
    let config = arguments.settings.apply(overridden(config, arguments))?;
    let read = files::read(&arguments.world, config.sonar.surface)?;
    let WorldFile { world, remarks, bytes } = read;
    let limits = Limits {
        while_driving: arguments.while_driving,
        max_scans: arguments.max_scans.map(|most| most.get()),
    };
    let places = ((&world, arguments.world.as_path()), (&config, name.as_path()));
    let mission = files::mission(places.0, places.1, arguments.start, limits)?;
    let thresholds = arguments.safe_map.thresholds(&mission.config.planner);
    let reader = arguments.read_out.load(mission.config.model.bins)?;
    let experiment = Experiment { mission, sonar: config.sonar, seed: arguments.seed };
    Ok((Task { world, experiment, thresholds, reader }, remarks, bytes))
}

/// Returns the configuration with the arguments in place of the file's values.
fn overridden(mut config: Config, arguments: &Explore) -> Config {
    if let Some(strategy) = arguments.strategy {
        config.planner.strategy = strategy;
    }
    if let Some(effort) = arguments.effort {
        config.planner = config.planner.with_effort(effort.effort());
    }
    if let Some(resolution) = arguments.resolution {
        config.resolution = resolution;
    }
    config
}

/// Returns the folder of `--out`, or one whose name tells all differences from the default.
fn folder_name(arguments: &Explore, task: &Task) -> Result<PathBuf> {
    let Explore { config, resolution, while_driving, max_scans, start, out, .. } = arguments;
    if let Some(out) = out {
        return Ok(out.clone());
    }
    let (default, _) = files::config(None, built_in::B21R)?;
    let (named, _) = files::config(config.as_deref(), built_in::B21R)?;
    let other = config.as_deref().filter(|_| named != default);
    let finer = resolution.and_then(|resolution| names::unlike(resolution, named.resolution));
    let start = start.map(|start| {
        let (place, heading) = (start.translation.vector, start.rotation.angle().to_degrees());
        let [x, y, degrees] = [place.x, place.y, heading].map(names::typed);
        format!("at{x}_{y}_{degrees}")
    });
    Ok(names::named([
        Some(task.world.name().to_owned()),
        Some(task.experiment.mission.config.planner.strategy.file_name()),
        Some(task.experiment.seed.to_string()),
        other.map(names::stem),
        arguments.settings.in_name(),
        arguments.effort.map(|effort| format!("{effort:?}").to_lowercase()),
        finer.map(|resolution| format!("r{resolution}")),
        start,
        while_driving.map(|every| format!("every{every}")),
        max_scans.map(|most| format!("max{most}")),
        arguments.read_out.path().map(names::stem),
    ]))
}

/// Returns the identity of the run: the header of the trace, and the world.
fn run_line(task: &Task, world_bytes: Vec<u8>, read_out: Option<&Path>) -> Result<String> {
    let Task { world, experiment, .. } = task;
    let Experiment { mission, seed, .. } = experiment;
    let strategy = &mission.config.planner.strategy;
    let words = format!("explore {}, {strategy}, seed {seed}", world.name());
    let header = experiment.header(world);
    let digest = Digest::default().with(serde_json::to_vec(&header)?).with(world_bytes);
    let digest = read_out.into_iter().try_fold(digest, Digest::with_file)?;
    Ok(output::run_line(&words, digest))
}

/// Explores the world, with trace, progress and interrupts.
fn watch(
    task: &Task,
    trace: &mut TraceWriter,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Run> {
    let Task { world, experiment, .. } = task;
    trace.header(&experiment.header(world))?;
    let mut failed = None;
    let run = experiment.explore(world, &mut |event, view| {
        progress.show(&experiment.mission, view);
        if failed.is_none() {
            failed = trace.event(event).err();
        }
        if failed.is_some() { ControlFlow::Break(()) } else { interrupt.flow() }
    })?;
    failed.map_or(Ok(run), |error| Err(error.into()))
}

fn exit_code(ending: Ending) -> u8 {
    match ending {
        Ending::Explored => 0,
        Ending::BudgetSpent => 3,
        Ending::StartBlocked | Ending::BoxedIn | Ending::NothingHeard | Ending::RobotFailed => 4,
        Ending::Interrupted => interrupt::EXIT_CODE,
    }
}

/// The legend of the line of the measured cells.
const MEASURED_LEGEND: &str = "  (mean log-likelihood of classes alike; of each class the log-likelihood [nats] and \
                               the error of the mode)";

/// The legend of the report.
const LEGEND: &str = "  (exhausted: still uncertain, and measuring helps no longer; wall recall: the \
                      share of the walls in sight that the map has; docs/guide.md#reading-the-summary)";

fn report(written: &Written, counts: &MapCounts, folder: &Path) {
    let Written { summary, measured, read_out } = written;
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let Summary { world, strategy, update, .. } = summary;
    say::line(format!("{world}, {strategy}, update {update}: {}", summary.ending.in_words()));
    say::line(format!(
        "  {} scans, {} decisions, {:.1} m driven, {} bumps, {:.1} s",
        summary.scans, summary.decisions, summary.path_length_m, summary.bumps, summary.seconds
    ));
    let cells = &summary.cells;
    let not_seen = match cells.not_seen {
        0 => String::new(),
        count => format!(", {count} not seen yet"),
    };
    say::line(format!(
        "  cells: {} resolved, {} exhausted, {} open, {} unreachable{not_seen}",
        cells.resolved, cells.exhausted, cells.open, cells.unreachable
    ));
    let recall =
        [("rough", summary.score.wall_recall_rough), ("smooth", summary.score.wall_recall_smooth)];
    let by_surface: Vec<String> = recall
        .iter()
        .filter_map(|(surface, share)| Some(format!("{surface} {}", percent((*share)?))))
        .collect();
    say::line(format!(
        "  completeness {}, wall recall {} ({})",
        percent(summary.score.completeness),
        percent(summary.score.wall_recall),
        by_surface.join(", ")
    ));
    say::line(fit_report::row("measured", measured));
    say::line(MEASURED_LEGEND);
    if let Some(file) = read_out {
        say::line(format!("  (recall, scores and pictures: read through {})", file.display()));
    }
    if summary.cut_off.cells > 0 {
        say::line(format!("  {}", cut_off(&summary.cut_off, summary.resolution)));
    }
    say::line(format!("  {}", results::map_line(counts)));
    say::line(LEGEND);
    say::line(format!("  {}", folder.display()));
}

/// Describes the area that is cut off, and the obstacles in the way.
fn cut_off(cut_off: &CutOff, resolution: f64) -> String {
    let area = cut_off.cells as f64 * resolution * resolution;
    let bars = [
        (cut_off.bumps, "bumps"),
        (cut_off.phantoms, "phantoms"),
        (cut_off.passages, "passages that look too narrow"),
        (cut_off.unknown, "unknown cells"),
    ];
    let bars = bars.iter().filter(|(count, _)| *count > 0);
    let bars: Vec<String> = bars.map(|(count, what)| format!("{count} {what}")).collect();
    let bars = if bars.is_empty() { "no way that it knows".to_owned() } else { bars.join(", ") };
    format!(
        "cut off: {} cells ({area:.1} m²) that the robot could truly reach were not found free; in the way: {bars}",
        cut_off.cells
    )
}
