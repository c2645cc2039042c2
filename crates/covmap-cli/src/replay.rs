//! A run is repeated from its trace, up to one decision.

use crate::trace_file::Trace;
use crate::{input, memory};
use anyhow::{Result, anyhow, bail};
use covmap::{Cell, CoverageMap};
use covmap_explore::{Event, Mission, RecordedRobot, View, explore};
use covmap_lab::TraceHeader;
use covmap_plan::{CandidateRecord, Decision};
use nalgebra::Point2;
use std::ops::ControlFlow;
use std::path::Path;

/// All that was known when a decision was taken.
pub(crate) struct Moment {
    pub(crate) mission: Mission,
    pub(crate) map: CoverageMap,
    pub(crate) trajectory: Vec<Point2<f64>>,
    pub(crate) scans: usize,
    /// Where the robot was.
    pub(crate) from: Cell,
    pub(crate) decision: Decision,
    /// All candidates, with their gains.
    pub(crate) candidates: Vec<CandidateRecord>,
}

/// Repeats a run up to the last event of its trace, which must be a decision. Every event on
/// the way must be the recorded one.
pub(crate) fn replay(trace: &Trace, path: &Path) -> Result<Moment> {
    let header = &trace.header;
    check(header).map_err(input::about(path))?;
    let (ring, _) = header.config.build()?;
    let beams = ring.beams().len();
    check_scans(&trace.events, beams).map_err(input::about(path))?;
    let mission = header.mission().map_err(input::about(path))?;
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
    .map_err(input::about(path))?;
    let line = differs.unwrap_or(trace.events.len() + 1);
    seen.ok_or_else(|| {
        anyhow!(
            "{}:{line}: the replay differs from here on; the trace was changed, or written by \
             another version of covmap",
            path.display()
        )
    })
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

/// Checks a header that anybody may have written.
fn check(header: &TraceHeader) -> Result<()> {
    let TraceHeader { config, grid, .. } = header;
    input::check(config, Path::new("config"))?;
    // The planner is looked at as it was, and goes on.
    memory::check_run(grid, config, 2)
}

fn check_scans(events: &[Event], beams: usize) -> Result<()> {
    for event in events {
        if let Event::Scan { number, scan } = event
            && scan.ranges.len() != beams
        {
            bail!(
                "scan {number} has {} ranges, but the ring has {beams} sensors",
                scan.ranges.len()
            );
        }
    }
    Ok(())
}
