//! `log`: the scans of a run as a log of CARMEN.

use crate::arguments::Log;
use crate::input::about;
use crate::trace_file::{self, read_header};
use crate::{output, say};
use anyhow::Result;
use covmap_explore::Event;
use covmap_io::log::{CarmenWriter, CarmenWriterError};
use covmap_io::{FileError, NewFile, read_json_lines};
use covmap_sonar::SonarRing;
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Log) -> Result<ExitCode> {
    let Log { dir, out, force } = arguments;
    let trace = trace_file::in_folder(dir)?;
    let replace = output::replace(out, *force, &[&trace])?;
    let header = read_header(&trace)?;
    let (ring, _) = header.config.build().map_err(about(&trace))?;
    let mut file = NewFile::create(out, replace)?;
    let scans = write(&trace, &ring, (out, &mut file))?;
    file.finish()?;
    say::line(format!("{scans} scans, {}", out.display()));
    Ok(ExitCode::SUCCESS)
}

/// Writes the scans of a trace, one by one. Its last line may be cut short.
fn write(trace: &Path, ring: &SonarRing, (out, file): (&Path, &mut NewFile)) -> Result<usize> {
    let fail = |error| match error {
        CarmenWriterError::Io(error) => about(out)(format!("cannot be written: {error}")),
        error => about(trace)(error.to_string()),
    };
    let mut log = CarmenWriter::new(ring, file).map_err(fail)?;
    // The first line is the header, which is no event.
    for event in read_json_lines::<Event>(trace)?.skip(1) {
        match event {
            Err(FileError::Truncated { .. }) => break,
            Err(error) => return Err(error.into()),
            Ok(Event::Scan { scan, .. }) => log.write(&scan).map_err(fail)?,
            Ok(_) => {}
        }
    }
    log.finish().map_err(fail)
}
