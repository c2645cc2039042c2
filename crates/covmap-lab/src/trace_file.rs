//! The trace of a run in its file.

use crate::error::{Fault, Result, about};
use crate::{OLDEST_TRACE, TRACE_VERSION, TraceHeader};
use covmap::CoverageMap;
use covmap_explore::{Event, TraceHasher};
use covmap_io::{FileError, JsonLines, read_json, read_json_lines};
use serde::Deserialize;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Returns the path of the trace in a folder that `explore` wrote.
///
/// # Errors
/// If there is no trace; the error says what the folder holds instead.
pub fn in_folder(dir: &Path) -> Result<PathBuf> {
    /// The field that only the summary of a map has.
    #[derive(Deserialize)]
    struct Summary {
        sensor: Option<String>,
    }
    let is_map = || {
        let summary = read_json::<Summary>(dir.join("summary.json"));
        summary.is_ok_and(|summary| summary.sensor.is_some())
    };
    let trace = dir.join("trace.jsonl");
    if trace.exists() || !dir.exists() {
        return Ok(trace);
    }
    Err(about(dir)(Fault::NoTrace(match () {
        () if !dir.is_dir() => "is no folder; name the folder that `explore` wrote",
        () if is_map() => {
            "`map` wrote it: a map has no decisions, and its scans are in the log that it was made of"
        }
        () if dir.join("campaign.json").exists() => {
            "`campaign` wrote it: it keeps no traces; repeat a run with `explore`"
        }
        () => "holds no trace.jsonl; name a folder that `explore` wrote",
    })))
}

/// Writer of a trace, line by line, with a hash.
#[derive(Debug)]
pub struct TraceWriter {
    lines: JsonLines<BufWriter<File>>,
    hasher: TraceHasher,
}

impl TraceWriter {
    /// Begins a trace in a file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        Ok(Self { lines: JsonLines::create(path)?, hasher: TraceHasher::default() })
    }

    /// Writes the header, the first line.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn header(&mut self, header: &TraceHeader) -> Result<(), FileError> {
        self.hasher.add(header);
        self.lines.write(header)?;
        self.lines.flush()
    }

    /// Writes an event; when this returns, a decision or the end is in the file.
    pub fn event(&mut self, event: &Event) -> Result<(), FileError> {
        self.hasher.add_event(event);
        self.lines.write(event)?;
        match event {
            Event::Decision { .. } | Event::End { .. } => self.lines.flush(),
            Event::Scan { .. } | Event::Bump { .. } => Ok(()),
        }
    }

    /// Finishes the file; returns the hash of the run.
    pub fn finish(mut self, belief: &CoverageMap) -> Result<String, FileError> {
        self.lines.sync()?;
        self.hasher.add_bytes(&belief.to_bytes());
        Ok(self.hasher.finish())
    }
}

/// A trace up to one decision.
#[derive(Debug)]
pub struct Trace {
    /// The header.
    pub header: TraceHeader,
    /// All events up to and including the decision.
    pub events: Vec<Event>,
}

/// The only field that every version of a trace has.
#[derive(Deserialize)]
struct Version {
    covmap_trace: u32,
}

impl Trace {
    /// Reads a trace up to the decision with a number. The last line of the file may be cut short.
    pub fn read(path: &Path, step: usize) -> Result<Self> {
        let header = read_header(path)?;
        let mut events = Vec::new();
        let mut decisions = 0;
        // The first line is the header, which is no event.
        for event in read_json_lines::<Event>(path)?.skip(1) {
            let event = match event {
                Err(FileError::Truncated { .. }) => break,
                event => event?,
            };
            let decision = matches!(event, Event::Decision { .. });
            if decisions <= step {
                events.push(event);
            }
            decisions += usize::from(decision);
        }
        if step >= decisions {
            return Err(about(path)(Fault::NoDecision { step, decisions }));
        }
        Ok(Self { header, events })
    }
}

/// Reads the header of a trace.
pub fn read_header(path: &Path) -> Result<TraceHeader> {
    let empty = || about(path)(Fault::EmptyTrace);
    let Version { covmap_trace } = read_json_lines(path)?.next().ok_or_else(empty)??;
    if !(OLDEST_TRACE..=TRACE_VERSION).contains(&covmap_trace) {
        return Err(about(path)(Fault::TraceVersion {
            found: covmap_trace,
            oldest: OLDEST_TRACE,
            newest: TRACE_VERSION,
        }));
    }
    Ok(read_json_lines(path)?.next().ok_or_else(empty)??)
}
