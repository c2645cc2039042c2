//! A robot in a simulated world.

use crate::{Config, ConfigError};
use covmap_explore::{Robot, Sensed};
use covmap_sonar::{Drive, Range, SonarRing};
use covmap_statistics::stream;
use covmap_world::{SonarPhysics, World};
use nalgebra::{Isometry2, Point2};
use std::convert::Infallible;

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
    /// Returns a robot whose noise is a function of the seed and the number of the scan.
    ///
    /// # Errors
    /// If the configuration is invalid.
    pub fn new(world: &'a World, config: &Config, seed: u64) -> Result<Self, ConfigError> {
        let (ring, _) = config.build()?;
        Ok(Self { world, ring, physics: config.sonar, radius: config.robot.radius, seed, scans: 0 })
    }
}

impl SimulatedRobot<'_> {
    /// Measures with the ring at a pose.
    pub fn fire(&mut self, pose: &Isometry2<f64>) -> Vec<Range> {
        let mut noise = stream(self.seed, "fire", self.scans);
        self.scans += 1;
        self.world.fire(&self.ring, pose, &self.physics, &mut noise)
    }
}

impl Robot for SimulatedRobot<'_> {
    type Error = Infallible;

    fn sense(&mut self, expected: &Isometry2<f64>) -> Result<Sensed, Infallible> {
        Ok(Sensed { pose: *expected, ranges: self.fire(expected) })
    }

    fn drive(&mut self, from: Point2<f64>, to: Point2<f64>) -> Result<Drive, Infallible> {
        Ok(self.world.drive(from, to, self.radius))
    }
}
