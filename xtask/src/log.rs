//! `log`: the scans of a run as a log of CARMEN.

use crate::arguments::Log;
use crate::input::about;
use crate::trace_file::read_header;
use crate::{csv_file, say};
use anyhow::Result;
use covmap_explore::Event;
use covmap_io::log::CarmenWriter;
use covmap_io::{FileError, read_json_lines};
use covmap_sonar::SonarRing;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Log) -> Result<ExitCode> {
    let trace = arguments.dir.join("trace.jsonl");
    let header = read_header(&trace)?;
    let (ring, _) = header.config.build().map_err(about(&trace))?;
    let mut written = Ok(0);
    csv_file::write(&arguments.out, |out| {
        written = write(&trace, &ring, out);
        let stop = |_: &anyhow::Error| io::Error::other("the trace cannot be written as a log");
        written.as_ref().map(|_| ()).map_err(stop)
    })
    .or_else(|error| written.as_ref().map_or(Ok(()), |_| Err(error)))?;
    let scans = written?;
    say::line(format!("{scans} scans, {}", arguments.out.display()));
    Ok(ExitCode::SUCCESS)
}

/// Writes the scans of a trace, one by one. Its last line may be cut short.
fn write(trace: &Path, ring: &SonarRing, out: &mut impl Write) -> Result<usize> {
    let mut log = CarmenWriter::new(ring, out).map_err(about(trace))?;
    // The first line is the header, which is no event.
    for event in read_json_lines::<Event>(trace)?.skip(1) {
        match event {
            Err(FileError::Truncated { .. }) => break,
            Err(error) => return Err(error.into()),
            Ok(Event::Scan { scan, .. }) => log.write(&scan).map_err(about(trace))?,
            Ok(_) => {}
        }
    }
    log.finish().map_err(about(trace))
}
