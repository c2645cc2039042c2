//! Replay of a run from its trace, up to one decision.

use crate::TraceHeader;
use crate::error::{Fault, LabError, Result, about};
use crate::files::{check_config, in_file};
use crate::memory;
use crate::trace_file::Trace;
use covmap::{Cell, CoverageMap};
use covmap_explore::{Event, Mission, RecordedRobot, View, explore};
use covmap_plan::{CandidateRecord, Decision};
use nalgebra::Point2;
use std::ops::ControlFlow;
use std::path::Path;

/// The state of a run when a decision was taken.
#[derive(Debug)]
pub struct Moment {
    /// The mission of the run.
    pub mission: Mission,
    /// The belief.
    pub map: CoverageMap,
    /// Corners of the path driven so far \[m\].
    pub trajectory: Vec<Point2<f64>>,
    /// The number of scans before the decision.
    pub scans: usize,
    /// The robot's cell.
    pub from: Cell,
    /// The decision.
    pub decision: Decision,
    /// All candidates, with their gains.
    pub candidates: Vec<CandidateRecord>,
}

/// Repeats a run up to the last event of its trace, which must be a decision.
///
/// # Errors
/// If an event differs from the recorded one, or if the header of the trace is invalid.
pub fn replay(trace: &Trace, path: &Path) -> Result<Moment> {
    let header = &trace.header;
    check(header).map_err(in_file(path))?;
    let (ring, _) = header.config.build()?;
    let beams = ring.beams().len();
    check_scans(&trace.events, beams).map_err(in_file(path))?;
    let mission = header.mission().map_err(about(path))?;
    let mut robot = RecordedRobot::new(trace.events.iter().cloned(), beams);
    let mut recorded = trace.events.iter().enumerate();
    let mut differs = None;
    let mut seen = None;
    explore(&mission, &mut robot, &mut |event, view| {
        match recorded.next() {
            Some((_, expected)) if expected == event => {}
            // Lines are counted from 1, and the first is the header.
            Some((i, _)) => differs = differs.or(Some(i + 2)),
            None => return ControlFlow::Break(()),
        }
        match event {
            _ if differs.is_some() => ControlFlow::Break(()),
            Event::Decision { from, decision, .. } if recorded.len() == 0 => {
                seen = Some(look(&mission, *from, decision, view));
                ControlFlow::Break(())
            }
            _ => ControlFlow::Continue(()),
        }
    })
    .map_err(about(path))?;
    let line = differs.unwrap_or(trace.events.len() + 1);
    seen.ok_or_else(|| about(path)(Fault::Differs { line }))
}

fn look(mission: &Mission, from: Cell, decision: &Decision, view: &View<'_>) -> Moment {
    Moment {
        mission: mission.clone(),
        map: view.map.clone(),
        trajectory: view.trajectory.to_vec(),
        scans: view.scans,
        from,
        decision: decision.clone(),
        candidates: view.planner.clone().candidate_table(view.map, from),
    }
}

/// Checks a header, which may come from any program.
pub(crate) fn check(header: &TraceHeader) -> Result<()> {
    let TraceHeader { config, grid, .. } = header;
    check_config(config).map_err(in_part("config"))?;
    // For two planners: the candidates come from a clone.
    memory::check_run(grid, config, 2)
}

pub(crate) fn check_scans(events: &[Event], beams: usize) -> Result<()> {
    for event in events {
        if let Event::Scan { number, scan } = event
            && scan.ranges.len() != beams
        {
            return Err(Fault::Ranges { number: *number, ranges: scan.ranges.len(), beams }.into());
        }
    }
    Ok(())
}

/// Names the part of a header in an error without a file.
fn in_part(part: &'static str) -> impl Fn(LabError) -> LabError {
    move |error| match error {
        LabError::Fault(fault) => Fault::Part { part, fault: Box::new(fault) }.into(),
        other => other,
    }
}
