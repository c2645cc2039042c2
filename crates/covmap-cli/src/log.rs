//! `log`: the scans of a run as a CARMEN log.

use crate::about::about;
use crate::arguments::Log;
use crate::output;
use crate::terminal::say;
use anyhow::Result;
use covmap_explore::Event;
use covmap_io::{FileError, NewFile, read_json_lines};
use covmap_lab::{RunPath, TraceHeader, in_folder, read_header};
use covmap_log::{CarmenWriter, CarmenWriterError};
use covmap_sonar::SonarRing;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Log) -> Result<ExitCode> {
    let Log { dir, out, force } = arguments;
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
