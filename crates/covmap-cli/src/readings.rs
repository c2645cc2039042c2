//! `readings`: a comparison of simulated sonars with those of a real robot.

mod knobs;
mod table;

use crate::about::about;
use crate::arguments::Readings as Arguments;
use crate::built_in;
use crate::fit_report::INTERRUPTED;
use crate::names;
use crate::output;
use crate::terminal::interrupt::{self, Interrupt};
use crate::terminal::progress::Progress;
use crate::terminal::say;
use anyhow::{Result, bail};
use covmap_fit::{SearchSettings, maximise};
use covmap_io::csv;
use covmap_io::{read_ron, write_ron};
use covmap_lab::{Config, Frames, Stride, files, frames};
use covmap_log::Sensor;
use covmap_sonar::{Range, Scan, SonarRing};
use covmap_statistics::stream;
use covmap_survey::Survey;
use covmap_world::{Surface, World};
use knobs::KNOBS;
use nalgebra::{Isometry2, Point2, Translation2};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use table::KindTable;

/// Free space around the walls of a survey \[m\].
const MARGIN: f64 = 1.0;
/// The truth of a reading is the nearest of the laser's echoes within this angle of the sonar's
/// axis \[rad\]: 7.5°, whatever the cone of the simulated sonars.
const CONE: f64 = 7.5 * std::f64::consts::PI / 180.0;
/// The number of seeds behind the shares of the simulated readings.
const SEEDS: u64 = 4;
/// Scans of sonar and laser are of the same frame if their times differ by at most this \[s\].
const SAME_TIME: f64 = 1e-6;

/// A reading of a real sonar, with the truth by the laser.
struct RealReading {
    sensor: usize,
    /// The nearest of the laser's echoes around the sensor's axis \[m\].
    truth: f64,
    range: Range,
}

/// All readings of one scan.
struct Frame {
    /// The robot's pose in the world of the survey.
    pose: Isometry2<f64>,
    readings: Vec<RealReading>,
}

/// A log, with the world that its laser saw.
struct Recording {
    world: World,
    frames: Vec<Frame>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let (config, name) = files::config(arguments.config.as_deref(), built_in::SONAR8)?;
    files::check(&config, &name)?;
    let recording = Recording::read(arguments, &config)?;
    let inputs = [
        Some(&arguments.log),
        Some(&arguments.truth),
        arguments.poses.as_ref(),
        arguments.config.as_ref(),
    ];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
    let run = run_line(arguments, &config)?;
    let folder = output::folder(&arguments.out, &run, arguments.force, &inputs)?;
    let real = recording.real();
    let mut rows = vec![("real", real.clone()), ("simulated", recording.simulated(&config)?)];
    if arguments.fit > 0 {
        let fitted = fit(arguments, &config, &recording, &real, &interrupt)?;
        let simulated = recording.simulated(&fitted)?;
        let (before, after) =
            (real.log_likelihood_under(&rows[1].1), real.log_likelihood_under(&simulated));
        let comment = format!(
            "Physics fitted to the readings of {}, by `cargo xtask readings`{}.\n\
             Mean log-likelihood of the kind of a reading [nats]: {before:.3} → {after:.3}, of {} readings",
            arguments.log.file_name().unwrap_or_default().to_string_lossy(),
            if interrupt.is_pressed() { INTERRUPTED } else { "" },
            real.count()
        );
        write_ron(folder.path("config.ron"), &fitted, Some(&comment))?;
        rows.push(("fitted", simulated));
    }
    csv::write(&folder.path("readings.csv"), |out| {
        writeln!(out, "source,{}", KindTable::HEADING)?;
        rows.iter().try_for_each(|(name, table)| {
            table.lines(",").iter().try_for_each(|line| writeln!(out, "{name},{line}"))
        })
    })?;
    let charts = table::figure(&rows);
    charts.save(folder.path("readings.svg"), folder.path("readings.png"))?;
    let written = folder.finish()?;
    if !arguments.quiet {
        tell(&rows);
        say::line(format!("  {}", written.display()));
    }
    Ok(if interrupt.is_pressed() { interrupt::EXIT_CODE.into() } else { ExitCode::SUCCESS })
}

/// Returns the identity of the comparison: its inputs and its settings.
fn run_line(arguments: &Arguments, config: &Config) -> Result<String> {
    let Arguments { log, truth, poses, fit, every, every_degrees, .. } = arguments;
    let mut digest = output::log_digest(log)?
        .with_file(truth)?
        .with(serde_json::to_vec(config)?)
        .with(fit.to_string())
        .with_numbers(&[*every, *every_degrees]);
    if let Some(poses) = poses {
        digest = digest.with_file(poses)?;
    }
    Ok(output::run_line(&format!("readings {}", names::stem(log)), digest))
}

fn tell(rows: &[(&str, KindTable)]) {
    let real = &rows[0].1;
    for (name, table) in rows {
        let likelihood = real.log_likelihood_under(table);
        say::line(format!("{name} ({likelihood:.3} nats a reading)"));
        say::line(format!("  {}", KindTable::HEADING.replace(',', "  ")));
        table.lines("  ").iter().for_each(|line| say::line(format!("  {line}")));
    }
}

/// Returns the physics under which the kinds of the real readings are most likely.
fn fit(
    arguments: &Arguments,
    config: &Config,
    recording: &Recording,
    real: &KindTable,
    interrupt: &Interrupt,
) -> Result<Config> {
    let progress = Progress::new(arguments.quiet);
    let turned = |place: &[f64]| {
        let mut config = config.clone();
        KNOBS.iter().zip(place).for_each(|(knob, at)| knob.set(&mut config, *at));
        config
    };
    let start: Vec<f64> = KNOBS.iter().map(|knob| knob.place(config)).collect();
    let settings = SearchSettings { evaluations: arguments.fit, ..SearchSettings::default() };
    let value =
        |place: &[f64]| Some(real.log_likelihood_under(&recording.simulated(&turned(place)).ok()?));
    let mut done = 0;
    let found = maximise(&start, &settings, value, |step| {
        done += 1;
        let value = step.value.unwrap_or(f64::NEG_INFINITY);
        progress.tell(&format_args!("{done} evaluations · {value:.4} nats"));
        interrupt.flow()
    });
    progress.finish();
    let Some((place, _)) = found else { bail!("the physics of the configuration are impossible") };
    Ok(turned(&place))
}

/// The scans of a log in the order of time.
struct ByTime<'a> {
    frames: &'a Frames,
    order: Vec<usize>,
}

impl<'a> ByTime<'a> {
    fn new(frames: &'a Frames) -> Self {
        let mut order: Vec<usize> = (0..frames.scans.len()).collect();
        order.sort_by(|a, b| frames.scans[*a].1.time.total_cmp(&frames.scans[*b].1.time));
        Self { frames, order }
    }

    /// Returns the scan of a time; if several scans have this time, the one on the nearest line.
    fn beside(&self, time: f64, line: usize) -> Option<&'a (Arc<SonarRing>, Scan)> {
        let time_of = |at: &usize| self.frames.scans[*at].1.time;
        let line_of = |at: &usize| self.frames.lines[*at];
        let first = self.order.partition_point(|at| time_of(at) < time - SAME_TIME);
        let end = self.order.partition_point(|at| time_of(at) <= time + SAME_TIME);
        // Scans of one time are in the order of their lines.
        let same = &self.order[first..end];
        let after = same.partition_point(|at| line_of(at) < line);
        let around = &same[after.saturating_sub(1)..(after + 1).min(same.len())];
        let nearest = around.iter().min_by_key(|at| line_of(at).abs_diff(line))?;
        Some(&self.frames.scans[*nearest])
    }
}

impl Recording {
    fn read(arguments: &Arguments, config: &Config) -> Result<Self> {
        let Arguments { log, poses, truth, .. } = arguments;
        let survey: Survey = read_ron(truth)?;
        if survey.bounds().map_err(about(truth))?.is_none() {
            bail!("{}: holds no wall, post or solid", truth.display());
        }
        let (scenario, corner) = survey.scenario("survey", MARGIN).map_err(about(truth))?;
        let world = World::from_scenario(&scenario, Surface::Rough).map_err(about(truth))?;
        let (ring, _) = config.build()?;
        let sonar = frames(log, poses.as_deref(), Sensor::Sonar, ring.clone())?;
        let laser = frames(log, poses.as_deref(), Sensor::Laser, ring)?;
        let stride = Stride { every: arguments.every, turn: arguments.every_degrees.to_radians() };
        if !arguments.quiet {
            for account in [&sonar.account, &laser.account] {
                let lost = (!account.skipped.is_empty()).then(|| account.skipped.to_string());
                account.remarks().into_iter().chain(lost).for_each(say::note);
            }
        }
        let lasers = ByTime::new(&laser);
        let (mut last, mut found) = (None, Vec::new());
        for ((ring, scan), line) in sonar.scans.iter().zip(&sonar.lines) {
            let Some((laser_ring, laser)) = lasers.beside(scan.time, *line) else { continue };
            if !stride.takes(last.as_ref(), &scan.pose) {
                continue;
            }
            last = Some(scan.pose);
            let pose = Translation2::from(-corner.coords) * scan.pose;
            let echoes = echoes(laser_ring, laser);
            let readings = readings(ring, scan, &echoes).collect();
            if !world.is_solid(pose.translation.vector.into()) {
                found.push(Frame { pose, readings });
            }
        }
        if found.is_empty() {
            bail!("{}: no frame has both sonar and laser in the surveyed world", log.display());
        }
        Ok(Self { world, frames: found })
    }

    fn real(&self) -> KindTable {
        let readings = self.frames.iter().flat_map(|frame| &frame.readings);
        readings.map(|reading| (reading.truth, reading.range)).collect()
    }

    fn simulated(&self, config: &Config) -> Result<KindTable> {
        let ring = SonarRing::from_specification(&config.robot.ring)?;
        config.sonar.validate()?;
        let mut all = Vec::new();
        for seed in 0..SEEDS {
            for (counter, frame) in (0..).zip(&self.frames) {
                let mut random = stream(seed, "readings", counter);
                let ranges = self.world.fire(&ring, &frame.pose, &config.sonar, &mut random);
                let readings = frame.readings.iter();
                all.extend(readings.filter_map(|r| Some((r.truth, *ranges.get(r.sensor)?))));
            }
        }
        Ok(all.into_iter().collect())
    }
}

/// Returns the places of the laser's echoes, in the frame of the robot \[m\].
fn echoes(ring: &SonarRing, scan: &Scan) -> Vec<Point2<f64>> {
    let beams = ring.beams().iter().zip(&scan.ranges);
    let place = |(beam, range): (&covmap_sonar::Beam, &Range)| match *range {
        Range::Echo(range) => Some(beam.pose * Point2::new(range, 0.0)),
        Range::NoEcho | Range::Missing => None,
    };
    beams.filter_map(place).collect()
}

/// Returns the readings of the sonars with echoes of the laser around their axes.
fn readings<'a>(
    ring: &'a SonarRing,
    scan: &'a Scan,
    echoes: &'a [Point2<f64>],
) -> impl Iterator<Item = RealReading> + 'a {
    let sensors = ring.beams().iter().zip(&scan.ranges).enumerate();
    sensors.filter_map(|(sensor, (beam, range))| {
        let in_cone = echoes.iter().filter_map(|echo| {
            let seen = beam.pose.inverse_transform_point(echo);
            (seen.y.atan2(seen.x).abs() <= CONE).then(|| seen.coords.norm())
        });
        let truth = in_cone.min_by(f64::total_cmp)?;
        (*range != Range::Missing).then_some(RealReading { sensor, truth, range: *range })
    })
}
