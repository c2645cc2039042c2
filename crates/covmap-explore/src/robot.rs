//! The robot that senses and drives, and a recorded one.

use crate::Event;
use covmap_sonar::{Drive, Range};
use nalgebra::{Isometry2, Point2};
use std::collections::VecDeque;
use std::convert::Infallible;

/// The readings of a robot, and their pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensed {
    /// Pose that the robot estimated, `world_from_robot`.
    pub pose: Isometry2<f64>,
    /// One reading for each beam of the ring.
    pub ranges: Vec<Range>,
}

/// A body that senses and drives.
///
/// A real robot may fail, be stopped on its way, drift, and turn its ring:
///
/// - The loop integrates the readings of [`sense`](Self::sense) at the pose that it returns. If this is not
///   the expected place, the loop goes on from there.
/// - The belief is right for any heading of the pose. The expected information gain assumes a ring that
///   keeps the heading of the start.
/// - An error ends the run with [`Ending::RobotFailed`](crate::Ending::RobotFailed); the map up to the error
///   is kept.
pub trait Robot {
    /// Error after which the robot can neither sense nor drive any longer.
    type Error: std::error::Error;

    /// Measures with the ring; `expected` is the pose where the robot should be.
    ///
    /// # Errors
    /// If the robot fails.
    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, Self::Error>;

    /// Drives straight from one point, where the robot is, to another \[m\].
    ///
    /// # Errors
    /// If the robot fails. A bump is no failure.
    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Result<Drive, Self::Error>;
}

/// Robot that repeats the record of a run: it senses and bumps as in the trace. Exploring with it repeats
/// the run up to the end of the trace.
#[derive(Debug, Clone)]
pub struct RecordedRobot {
    events: VecDeque<Event>,
    beams: usize,
}

impl RecordedRobot {
    /// Returns a robot with `beams` sensors that repeats the events of a trace.
    pub fn new(events: impl IntoIterator<Item = Event>, beams: usize) -> Self {
        let repeats = |e: &Event| matches!(e, Event::Scan { .. } | Event::Bump { .. });
        Self { events: events.into_iter().filter(repeats).collect(), beams }
    }
}

impl Robot for RecordedRobot {
    type Error = Infallible;

    /// Returns the next recorded scan; missing readings once the record has ended.
    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, Infallible> {
        Ok(match self.events.pop_front() {
            Some(Event::Scan { scan, .. }) if scan.ranges.len() == self.beams => {
                Sensed { pose: scan.pose, ranges: scan.ranges }
            }
            _ => Sensed { pose: *expected, ranges: vec![Range::Missing; self.beams] },
        })
    }

    fn drive(&mut self, _: Point2<f64>, to: Point2<f64>) -> Result<Drive, Infallible> {
        Ok(match self.events.front() {
            Some(Event::Bump { at, towards, .. }) if *towards == to => {
                let at = *at;
                self.events.pop_front();
                Drive::Bumped { at }
            }
            _ => Drive::Arrived,
        })
    }
}
