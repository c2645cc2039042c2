//! An experiment: one run in a simulated world, from its setup to its numbers.

use crate::{
    Config, ConfigError, CutOff, SetupError, SimulatedRobot, Summary, TraceHeader, Truth, mission,
};
use covmap::CoverageMap;
use covmap_explore::{Event, Limits, Mission, Run, View, explore};
use covmap_world::{SonarPhysics, World};
use nalgebra::Isometry2;
use std::ops::ControlFlow;

/// A mission in a simulated world, with the physics of the sensors and the seed of their noise, which the
/// robot does not know.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Mission of the robot.
    pub mission: Mission,
    /// Physics of the simulated sensors.
    pub sonar: SonarPhysics,
    /// Seed of the noise.
    pub seed: u64,
}

impl Experiment {
    /// Returns an experiment with a configuration; the mission is that of [`mission`].
    ///
    /// # Errors
    /// If the configuration is invalid or the robot cannot stand at the start.
    pub fn new(
        world: &World,
        config: &Config,
        start: Option<Isometry2<f64>>,
        limits: Limits,
        seed: u64,
    ) -> Result<Self, SetupError> {
        Ok(Self { mission: mission(world, config, start, limits)?, sonar: config.sonar, seed })
    }

    /// Returns the robot of the experiment.
    ///
    /// # Errors
    /// If the configuration is invalid.
    pub fn robot<'a>(&self, world: &'a World) -> Result<SimulatedRobot<'a>, ConfigError> {
        let config = Config::of(self.mission.config.clone(), self.sonar);
        SimulatedRobot::new(world, &config, self.seed)
    }

    /// Returns the header of the experiment's trace.
    pub fn header(&self, world: &World) -> TraceHeader {
        TraceHeader::new(&self.mission, &self.sonar, world.name(), self.seed)
    }

    /// Lets the robot explore; the hook receives every event.
    ///
    /// # Errors
    /// If the configuration or the mission is invalid.
    pub fn explore(
        &self,
        world: &World,
        hook: &mut impl FnMut(&Event, &View<'_>) -> ControlFlow<()>,
    ) -> Result<Run, SetupError> {
        Ok(explore(&self.mission, &mut self.robot(world)?, hook)?)
    }

    /// Returns the numbers of a run, where `map` is the map of the run as it is read; the caller knows
    /// `seconds` and `hash`.
    pub fn summary(
        &self,
        (world, truth): (&World, &Truth),
        (run, map): (&Run, &CoverageMap),
        (seconds, hash): (f64, String),
    ) -> Summary {
        let score = truth.score(map, &truth.scored_cells(world, &self.mission, run));
        let cut_off = CutOff::new(truth, &self.mission, run);
        let of = (&self.mission.config, self.seed);
        Summary::new(world.name(), of, run, (&score, cut_off), seconds, hash)
    }
}
