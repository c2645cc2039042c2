//! Who senses and drives; and the record of one.

use crate::Event;
use covmap_sonar::{Drive, Range};
use nalgebra::{Isometry2, Point2};
use std::collections::VecDeque;

/// A body that senses and drives.
pub trait Robot {
    /// What the ring measures at a pose.
    fn sense(&mut self, pose: &Isometry2<f64>) -> Vec<Range>;
    /// Drives straight from one point to another, or bumps into something.
    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Drive;
}

/// The record of a run: it senses and bumps as its trace says. Exploring with it repeats
/// the run up to the end of the trace.
#[derive(Debug, Clone)]
pub struct RecordedRobot {
    events: VecDeque<Event>,
    beams: usize,
}

impl RecordedRobot {
    /// A robot with `beams` sensors that repeats the events of a trace.
    pub fn new(events: impl IntoIterator<Item = Event>, beams: usize) -> Self {
        let repeats = |e: &Event| matches!(e, Event::Scan { .. } | Event::Bump { .. });
        Self { events: events.into_iter().filter(repeats).collect(), beams }
    }
}

impl Robot for RecordedRobot {
    /// The next recorded scan's readings; nothing once the record has ended.
    fn sense(&mut self, _: &Isometry2<f64>) -> Vec<Range> {
        match self.events.pop_front() {
            Some(Event::Scan { scan, .. }) if scan.ranges.len() == self.beams => scan.ranges,
            _ => vec![Range::Missing; self.beams],
        }
    }

    fn drive(&mut self, _: Point2<f64>, to: Point2<f64>) -> Drive {
        match self.events.front() {
            Some(Event::Bump { at, towards, .. }) if *towards == to => {
                let at = *at;
                self.events.pop_front();
                Drive::Bumped { at }
            }
            _ => Drive::Arrived,
        }
    }
}
