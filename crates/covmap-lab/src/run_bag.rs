//! A run as a bag of ROS 2: scans and poses, maps, decisions with their reasons, and the end.

mod drawn;

use crate::error::{Fault, LabError, Result, about};
use crate::files::in_file;
use crate::replay::{check, check_scans};
use crate::{RunPath, TraceHeader, read_header};
use covmap_bag::messages::{Header, Path as PathMessage, PoseStamped, Stamp};
use covmap_bag::planar::planar;
use covmap_explore::{Event, RecordedRobot, View, explore};
use covmap_io::{FileError, read_json_lines};
use covmap_log::{BagWriterError, FRAMES, RosBagWriter};
use nalgebra::Isometry2;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;

/// The number of scans after which the maps are written again.
const MAPS_EVERY: usize = 25;

/// Writes a run as a bag; returns the number of scans. `trace` may be cut short.
///
/// Beside what [`RosBagWriter`] writes of scans and poses, the bag has
/// - `/map`: the expected coverage in percent, −1 for unknown cells; every 25 scans and at the end;
/// - `/entropy`: the entropy in percent of that of a uniform histogram, at the same times;
/// - `/certificate`, at the end: −1 outside, 0 resolved, 25 exhausted, 50 unreachable, 75 not seen, 100 open;
/// - `/path`, at the end: where the robot drove;
/// - `/candidates`: at each decision the five best candidates, larger ones with a better score, the chosen one
///   with its reason as text, and the way there.
///
/// # Errors
/// If the trace is invalid or is not repeated by this version of the program, or the bag cannot be written.
pub fn write_run_bag<W: Write>(trace: &Path, out: W) -> Result<usize> {
    let header = read_header(trace)?;
    check(&header).map_err(in_file(trace))?;
    let events = read_events(trace)?;
    let (ring, _) = header.config.build()?;
    check_scans(&events, ring.beams().len()).map_err(in_file(trace))?;
    let mission = header.mission().map_err(about(trace))?;
    let bag = RosBagWriter::new(&ring, out).map_err(written)?;
    let mut recording = Recording {
        bag,
        path: RunPath::new(&header),
        stamp: Stamp::default(),
        scans: 0,
        poses: Vec::new(),
    };
    let mut robot = RecordedRobot::new(events.iter().cloned(), ring.beams().len());
    let mut expected = events.iter().enumerate();
    let mut fault: Option<LabError> = None;
    let run = explore(&mission, &mut robot, &mut |event, view| {
        match expected.next() {
            // Lines are counted from 1, and the first is the header.
            Some((i, recorded)) if !is_same(recorded, event) => {
                fault = Some(about(trace)(Fault::Differs { line: i + 2 }));
            }
            Some(_) => fault = recording.take(&header, event, view).err(),
            None => return ControlFlow::Break(()),
        }
        if fault.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let run = run.map_err(about(trace))?;
    match fault {
        Some(fault) => Err(fault),
        None => recording.finish(&run),
    }
}

/// Whether two events are the same, but for what explains them.
fn is_same(a: &Event, b: &Event) -> bool {
    match (a, b) {
        (Event::Decision { decision: a, .. }, Event::Decision { decision: b, .. }) => {
            (a.target, &a.path) == (b.target, &b.path)
        }
        _ => a == b,
    }
}

fn read_events(trace: &Path) -> Result<Vec<Event>> {
    let mut events = Vec::new();
    // The first line is the header.
    for event in read_json_lines::<Event>(trace)?.skip(1) {
        match event {
            Err(FileError::Truncated { .. }) => break,
            event => events.push(event?),
        }
    }
    Ok(events)
}

fn written(error: BagWriterError) -> LabError {
    Fault::Bag(error).into()
}

/// A bag in the making.
struct Recording<'a, W: Write> {
    bag: RosBagWriter<'a, W>,
    path: RunPath,
    /// The time of the last scan or pose.
    stamp: Stamp,
    scans: usize,
    poses: Vec<(Stamp, Isometry2<f64>)>,
}

impl<W: Write> Recording<'_, W> {
    fn take(&mut self, header: &TraceHeader, event: &Event, view: &View<'_>) -> Result<()> {
        for (time, pose) in self.path.follow(event) {
            self.pass(time, &pose)?;
        }
        match event {
            Event::Scan { scan, .. } => {
                self.stamp = self.bag.write(scan).map_err(written)?;
                self.poses.push((self.stamp, scan.pose));
                self.scans += 1;
                if self.scans % MAPS_EVERY == 1 {
                    self.maps(view.map)?;
                }
            }
            Event::Decision { decision, .. } => {
                let drawn = drawn::decision(self.header(), &header.grid, decision);
                self.bag.add("/candidates", self.stamp, &drawn).map_err(written)?;
            }
            Event::Bump { .. } | Event::End { .. } => {}
        }
        Ok(())
    }

    fn pass(&mut self, time: f64, pose: &Isometry2<f64>) -> Result<()> {
        self.stamp = self.bag.pass(time, pose).map_err(written)?;
        self.poses.push((self.stamp, *pose));
        Ok(())
    }

    fn header(&self) -> Header {
        Header { stamp: self.stamp, frame_id: FRAMES[0].to_owned() }
    }

    fn maps(&mut self, map: &covmap::CoverageMap) -> Result<()> {
        for (topic, grid) in drawn::maps(&self.header(), map) {
            self.bag.add(topic, self.stamp, &grid).map_err(written)?;
        }
        Ok(())
    }

    fn finish(mut self, run: &covmap_explore::Run) -> Result<usize> {
        for (time, pose) in self.path.rest() {
            self.pass(time, &pose)?;
        }
        self.maps(&run.map)?;
        let certificate = drawn::certificate(&self.header(), &run.certificate);
        self.bag.add("/certificate", self.stamp, &certificate).map_err(written)?;
        let posed = |(stamp, pose): &(Stamp, Isometry2<f64>)| PoseStamped {
            header: Header { stamp: *stamp, ..self.header() },
            pose: planar(pose),
        };
        let path =
            PathMessage { header: self.header(), poses: self.poses.iter().map(posed).collect() };
        self.bag.add("/path", self.stamp, &path).map_err(written)?;
        self.bag.finish().map_err(written)
    }
}
