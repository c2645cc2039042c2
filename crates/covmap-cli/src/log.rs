//! `log`: the scans of a run as a CARMEN log, or a run or a log as a bag of ROS 2.

mod layout;

use crate::about::about;
use crate::arguments::Log;
use crate::built_in;
use crate::output;
use crate::terminal::Terminal;
use crate::terminal::interrupt::{self, Interrupt};
use crate::terminal::progress::Progress;
use crate::terminal::say;
use anyhow::{Result, anyhow};
use covmap_explore::Event;
use covmap_io::{FileError, NewFile, Replace, read_json_lines};
use covmap_lab::{RunPath, TraceHeader, files, in_folder, read_header, write_run_bag};
use covmap_log::{BagOptions, CarmenWriter, CarmenWriterError, LogOptions, Sensor};
use covmap_sonar::SonarRing;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Log) -> Result<ExitCode> {
    let Log { dir, out, .. } = arguments;
    let is_run = !dir.exists() || dir.join("trace.jsonl").exists();
    match (is_run, out.extension().is_some_and(|ending| ending == "mcap")) {
        (true, false) => carmen(arguments),
        (true, true) => bag_of_run(arguments),
        (false, true) => bag_of_log(arguments),
        (false, false) => {
            if dir.is_dir() {
                in_folder(dir)?;
            }
            Err(anyhow!(
                "{}: is no run of `explore`; name the new file {}.mcap, and a log becomes a bag",
                dir.display(),
                out.with_extension("").display()
            ))
        }
    }
}

fn carmen(arguments: &Log) -> Result<ExitCode> {
    let Log { dir, out, force, .. } = arguments;
    let trace = in_folder(dir)?;
    let replace = output::replace(out, *force, &[&trace])?;
    let header = read_header(&trace)?;
    let (ring, _) = header.config.build().map_err(about(&trace))?;
    let mut file = NewFile::create(out, replace)?;
    let scans = write(&trace, (&header, &ring), (out, &mut file))?;
    file.finish()?;
    say::line(format!("{scans} scans, {}", out.display()));
    Ok(ExitCode::SUCCESS)
}

fn bag_of_run(arguments: &Log) -> Result<ExitCode> {
    let Log { dir, out, force, .. } = arguments;
    let trace = in_folder(dir)?;
    let replace = output::replace(out, *force, &[&trace])?;
    let mut file = NewFile::create(out, replace)?;
    let scans = write_run_bag(&trace, &mut file)?;
    finish(file, (out, replace), scans)
}

fn bag_of_log(arguments: &Log) -> Result<ExitCode> {
    let Log { dir, out, force, config, poses } = arguments;
    let (config, name) = files::config(config.as_deref(), built_in::of_sonars(dir))?;
    files::check(&config, &name)?;
    let (ring, _) = config.build()?;
    let (sensor, bag) = (Sensor::Sonar, BagOptions::default());
    let options = LogOptions { sensor, ring, poses: poses.clone(), bag };
    let log = covmap_lab::Log { path: dir.clone(), options };
    let replace = output::replace(out, *force, &[dir])?;
    let interrupt = Interrupt::listen()?;
    let progress = Progress::new(false);
    let terminal = Terminal { progress: &progress, interrupt: &interrupt };
    let mut file = NewFile::create(out, replace)?;
    let scans = log.write_bag(&mut file, &terminal)?;
    interrupt.done();
    let Some(scans) = scans else { return Ok(interrupt::EXIT_CODE.into()) };
    progress.finish();
    finish(file, (out, replace), scans)
}

/// Gives a bag its name, writes the layout beside it, and says so.
fn finish(file: NewFile, (out, replace): (&Path, Replace), scans: usize) -> Result<ExitCode> {
    file.finish()?;
    let layout = layout::write(out, replace)?;
    say::line(format!(
        "{scans} scans, {}; a layout for Foxglove: {}",
        out.display(),
        layout.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// Writes the scans of a trace, one by one, and the robot's way between them. The last line of the
/// trace may be cut short.
fn write(
    trace: &Path,
    (header, ring): (&TraceHeader, &SonarRing),
    (out, file): (&Path, &mut NewFile),
) -> Result<usize> {
    let fail = |error| match error {
        CarmenWriterError::Io(error) => about(out)(format!("cannot be written: {error}")),
        error => about(trace)(error.to_string()),
    };
    let mut log = CarmenWriter::new(ring, file).map_err(fail)?;
    let mut path = RunPath::new(header);
    // The first line is the header, which is not an event.
    for event in read_json_lines::<Event>(trace)?.skip(1) {
        let event = match event {
            Err(FileError::Truncated { .. }) => break,
            event => event?,
        };
        for (time, pose) in path.follow(&event) {
            log.pass(time, &pose).map_err(fail)?;
        }
        if let Event::Scan { scan, .. } = &event {
            log.write(scan).map_err(fail)?;
        }
    }
    for (time, pose) in path.rest() {
        log.pass(time, &pose).map_err(fail)?;
    }
    log.finish().map_err(fail)
}
