//! `map`: the map of a real robot's log.

use crate::about::about;
use crate::arguments::{Map, SensorName};
use crate::built_in;
use crate::map_pictures::MapPictures;
use crate::map_report;
use crate::map_summary::{CellCounts, MapSummary};
use crate::names;
use crate::output;
use crate::terminal::Terminal;
use crate::terminal::interrupt::{self, Interrupt};
use crate::terminal::progress::Progress;
use anyhow::Result;
use covmap::CoverageMap;
use covmap_io::{MapCounts, OutputFolder, write_json};
use covmap_lab::{
    Config, LabError, Log, LogOverview, Mapper, Reader, Stride, files, memory, results,
};
use covmap_log::{LogOptions, Sensor, SensorAccount, Skipped};
use covmap_model::{Footprint, FootprintRule, SensorModel};
use covmap_plan::BodyEvidence;
use covmap_sonar::{Beam, SonarRing};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

/// The largest distance between a sensor's axis and the robot's centre with which sectors from the
/// centre still describe the sensor \[m\].
const OFF_CENTRE: f64 = 0.05;

pub(crate) fn run(arguments: &Map) -> Result<ExitCode> {
    let begun = Instant::now();
    let interrupt = Interrupt::listen()?;
    let config = config(arguments)?;
    let log = log(arguments, &config)?;
    let progress = Progress::new(arguments.quiet);
    let terminal = Terminal { progress: &progress, interrupt: &interrupt };
    let Some(survey) = log.overview(&terminal)? else {
        return Ok(interrupt::EXIT_CODE.into());
    };
    interrupt.done();
    let (models, remark) = models(&config, arguments.sensor, &survey)?;
    let reach = models.iter().fold(0.0f64, |most, (_, model)| most.max(model.max_reach()));
    let grid = survey.grid((config.resolution, reach), config.robot.radius, &log.path)?;
    memory::check_map(&grid, &config).map_err(about(&log.path))?;
    let body =
        (config.planner.body_evidence == BodyEvidence::Belief).then_some(config.robot.radius);
    let stride = Stride { every: arguments.every, turn: arguments.every_degrees.to_radians() };
    let reader = arguments.read_out.load(config.model.bins)?;
    let run = run_line(arguments, &config)?;
    let (poses, read_out) = (arguments.poses.as_ref(), arguments.read_out.read_out.as_ref());
    let inputs = [Some(&arguments.log), poses, arguments.config.as_ref(), read_out];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
    let folder = output::folder(&folder_name(arguments)?, &run, arguments.force, &inputs)?;
    let mapper = Mapper::new((grid, config.model.bins), models, stride, body)?;
    let mapper = log.map(mapper, &terminal)?;
    interrupt.done();
    progress.say("drawing the map …");
    let seconds = begun.elapsed().as_secs_f64();
    let map = reader.read(&mapper.map)?;
    let summary = summary(arguments, (&survey, remark), (&mapper, &map), seconds);
    map_report::write_readings(&folder.path("readings.csv"), &survey)?;
    let counts = write(&folder, (&mapper, &map, &reader), &summary, (arguments, &config))?;
    let written = folder.finish()?;
    progress.finish();
    if !arguments.quiet {
        let for_others = results::map_line(&counts);
        map_report::tell(arguments, &summary, (&survey.account.sensors, &for_others), &written);
    }
    Ok(if mapper.stopped { interrupt::EXIT_CODE.into() } else { ExitCode::SUCCESS })
}

/// Returns the configuration as its file has it.
fn named_config(arguments: &Map) -> Result<(Config, PathBuf), LabError> {
    let file = arguments.config.as_deref();
    match arguments.sensor {
        SensorName::Laser => files::config(file, built_in::LASER),
        SensorName::Sonar => files::config(file, built_in::of_sonars(&arguments.log)),
    }
}

fn config(arguments: &Map) -> Result<Config> {
    let (mut config, name) = named_config(arguments)?;
    if let Some(resolution) = arguments.resolution {
        config.resolution = resolution;
    }
    let config = arguments.settings.apply(config)?;
    files::check(&config, &name)?;
    Ok(config)
}

fn log(arguments: &Map, config: &Config) -> Result<Log> {
    let (ring, _) = config.build()?;
    let sensor = match arguments.sensor {
        SensorName::Sonar => Sensor::Sonar,
        SensorName::Laser => Sensor::Laser,
    };
    let options =
        LogOptions { sensor, ring, poses: arguments.poses.clone(), bag: arguments.bag.options() };
    Ok(Log { path: arguments.log.clone(), options })
}

/// The rings of a log, each with its sensor model.
type Models = Vec<(Arc<SonarRing>, SensorModel)>;

/// Returns the sensor models for the rings of a log, and a remark about them, if any.
fn models(
    config: &Config,
    sensor: SensorName,
    survey: &LogOverview,
) -> Result<(Models, Option<String>)> {
    let (mut models, mut remarks) = (Vec::new(), None);
    for ring in &survey.rings {
        let (model, remark) = model(config, sensor, ring)?;
        models.push((Arc::clone(ring), model));
        remarks = remarks.or(remark);
    }
    Ok((models, remarks))
}

fn model(
    config: &Config,
    sensor: SensorName,
    ring: &SonarRing,
) -> Result<(SensorModel, Option<String>)> {
    let mut parameters = config.model.clone();
    let mut remark = None;
    match (sensor, parameters.footprint) {
        (SensorName::Laser, _) => parameters.footprint = FootprintRule::Cones { half_angle: 0.0 },
        (SensorName::Sonar, rule @ FootprintRule::Sectors { half_angle }) => {
            let centred = ring.beams().iter().all(looks_outwards);
            if !centred || Footprint::new(ring, &rule).is_err() {
                parameters.footprint = FootprintRule::Cones { half_angle };
                remark = Some(format!(
                    "the log's sensors do not look straight out from one centre: cones of {:.1}° \
                     instead of sectors",
                    half_angle.to_degrees()
                ));
            }
        }
        (SensorName::Sonar, FootprintRule::Cones { .. }) => {}
    }
    Ok((SensorModel::new(&parameters, ring, config.resolution)?, remark))
}

/// Returns whether a sensor's axis starts at the robot's centre.
fn looks_outwards(beam: &Beam) -> bool {
    let place = beam.pose.rotation.inverse() * beam.pose.translation.vector;
    place.y.abs() <= OFF_CENTRE && place.x >= -OFF_CENTRE
}

fn sensor_name(sensor: SensorName) -> &'static str {
    match sensor {
        SensorName::Sonar => "sonar",
        SensorName::Laser => "laser",
    }
}

/// Returns the name of a log: that of its file or folder, without the endings of its format.
fn log_name(log: &Path) -> String {
    let whole = log.canonicalize().unwrap_or_else(|_| log.to_owned());
    let name = whole.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let endings = [".gz", ".log", ".clf", ".txt", ".mcap"];
    let short =
        endings.iter().fold(name.as_str(), |name, end| name.strip_suffix(end).unwrap_or(name));
    if short.is_empty() { "log".to_owned() } else { short.to_owned() }
}

/// Returns the folder of `--out`, or one whose name tells all differences from the default.
fn folder_name(arguments: &Map) -> Result<PathBuf> {
    let Map { config, poses, resolution, every, every_degrees, out, .. } = arguments;
    if let Some(out) = out {
        return Ok(out.clone());
    }
    let (named, _) = named_config(arguments)?;
    let finer = resolution.and_then(|resolution| names::unlike(resolution, named.resolution));
    Ok(names::named([
        Some(log_name(&arguments.log)),
        Some(sensor_name(arguments.sensor).to_owned()),
        config.as_deref().map(names::stem),
        poses.as_deref().map(names::stem),
        finer.map(|resolution| format!("r{resolution}")),
        arguments.settings.in_name(),
        names::unlike(*every, 0.05).map(|every| format!("every{every}")),
        names::unlike(*every_degrees, 5.0).map(|degrees| format!("turn{degrees}")),
        arguments.read_out.path().map(names::stem),
    ]))
}

/// Returns the identity of the map: its log and its settings.
fn run_line(arguments: &Map, config: &Config) -> Result<String> {
    let words = format!("map {}, {}", log_name(&arguments.log), sensor_name(arguments.sensor));
    let mut digest = output::log_digest(&arguments.log)?
        .with(serde_json::to_vec(config)?)
        .with_numbers(&[arguments.every, arguments.every_degrees])
        .with(format!("{:?}", arguments.bag.options()).into_bytes());
    for file in arguments.poses.as_deref().into_iter().chain(arguments.read_out.path()) {
        digest = digest.with_file(file)?;
    }
    Ok(output::run_line(&words, digest))
}

fn summary(
    arguments: &Map,
    (survey, remark): (&LogOverview, Option<String>),
    (mapper, map): (&Mapper, &CoverageMap),
    seconds: f64,
) -> MapSummary {
    let known = map.grid().cells().filter(|cell| map.is_known(*cell)).count();
    let account = &survey.account;
    let skipped: &Skipped = &account.skipped;
    let readings = |sensor: &SensorAccount| (sensor.lines, sensor.total());
    MapSummary {
        world: log_name(&arguments.log),
        sensor: sensor_name(arguments.sensor),
        resolution: map.grid().resolution(),
        frames: skipped.frames(),
        skipped: skipped.total(),
        standing: mapper.standing,
        scans: mapper.scans,
        jumps: mapper.jumps,
        path_length_m: mapper.path_length,
        cells: CellCounts { known, unknown: map.grid().len() - known },
        share_entropy_above_0_65: share_uncertain(map),
        read_out: arguments.read_out.read_out.clone(),
        seconds,
        readings: account.sensors.iter().map(readings).collect(),
        taken_from: map_report::taken_from(account),
        remarks: account.remarks().into_iter().chain(remark).collect(),
        warning: warning(skipped, mapper),
    }
}

/// Describes the parts of the log that are not in the map.
fn warning(skipped: &Skipped, mapper: &Mapper) -> Option<String> {
    let skipped = (!skipped.is_empty()).then(|| skipped.to_string());
    let stopped = mapper
        .stopped
        .then(|| format!("stopped by Ctrl-C after {} frames", mapper.scans + mapper.standing));
    let all: Vec<String> = skipped.into_iter().chain(stopped).collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// Returns the share of the known, not pinned cells with an entropy above .65 nats.
fn share_uncertain(map: &CoverageMap) -> f64 {
    let measured = map.grid().cells().filter(|cell| map.is_known(*cell) && !map.is_pinned(*cell));
    let (mut all, mut above) = (0usize, 0usize);
    for cell in measured {
        all += 1;
        above += usize::from(map.entropy(cell) > 0.65);
    }
    above as f64 / all.max(1) as f64
}

fn write(
    folder: &OutputFolder,
    (mapper, map, reader): (&Mapper, &CoverageMap, &Reader),
    summary: &MapSummary,
    (arguments, config): (&Map, &Config),
) -> Result<MapCounts> {
    let thresholds = arguments.safe_map.thresholds(&config.planner);
    let counts = results::write_map(folder, (&mapper.map, map), &thresholds, |_| true)?;
    let (how, explored) = (reader.in_words(), config.planner.entropy_threshold);
    let pictures = MapPictures { mapper, map, how: &how, summary, explored };
    pictures.coverage().save(folder.path("coverage.png"))?;
    pictures.entropy().save(folder.path("entropy.png"))?;
    pictures.occupancy().save(folder.path("occupancy.png"))?;
    // The last file: its presence means that all others are complete.
    write_json(folder.path("summary.json"), summary)?;
    Ok(counts)
}
