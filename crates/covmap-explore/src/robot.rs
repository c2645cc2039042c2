//! Who senses and drives: a simulated robot, or the record of one.

use crate::{Config, ConfigError, Event};
use covmap_sonar::{Range, SonarRing};
use covmap_statistics::stream;
use covmap_world::{Drive, SonarPhysics, World};
use nalgebra::{Isometry2, Point2};
use std::collections::VecDeque;

/// A body that senses and drives.
pub trait Robot {
    /// What the ring measures at a pose.
    fn sense(&mut self, pose: &Isometry2<f64>) -> Vec<Range>;
    /// Drives straight from one point to another, or bumps into something.
    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Drive;
}

/// A robot in a simulated world.
#[derive(Debug)]
pub struct SimulatedRobot<'a> {
    world: &'a World,
    ring: SonarRing,
    physics: SonarPhysics,
    radius: f64,
    seed: u64,
    scans: u64,
}

impl<'a> SimulatedRobot<'a> {
    /// A robot whose noise is a function of the seed and the number of the scan.
    ///
    /// # Errors
    /// If the configuration is invalid.
    pub fn new(world: &'a World, config: &Config, seed: u64) -> Result<Self, ConfigError> {
        let (ring, _) = config.build()?;
        Ok(Self { world, ring, physics: config.sonar, radius: config.robot.radius, seed, scans: 0 })
    }
}

impl Robot for SimulatedRobot<'_> {
    fn sense(&mut self, pose: &Isometry2<f64>) -> Vec<Range> {
        let mut noise = stream(self.seed, "fire", self.scans);
        self.scans += 1;
        self.world.fire(&self.ring, pose, &self.physics, &mut noise)
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Drive {
        self.world.drive(from, to, self.radius)
    }
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
