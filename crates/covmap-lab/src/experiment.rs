//! One run in a simulated world, from its setup to its numbers.

use crate::{
    Config, ConfigError, CutOff, SetupError, SimulatedRobot, Summary, TraceHeader, Truth, mission,
};
use covmap::CoverageMap;
use covmap_explore::{Event, Limits, Mission, Run, View, explore};
use covmap_world::{SonarPhysics, World};
use nalgebra::Isometry2;
use std::ops::ControlFlow;

/// What is done in a world: the mission of the robot, and what the robot is not told, the physics of its
/// sensors and the seed of their noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// What the robot is told.
    pub mission: Mission,
    /// How its sensors are simulated.
    pub sonar: SonarPhysics,
    /// Seed of the noise.
    pub seed: u64,
}

impl Experiment {
    /// An experiment with a configuration, begun as [`mission`] says.
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

    /// The robot that does it.
    ///
    /// # Errors
    /// If the configuration is invalid.
    pub fn robot<'a>(&self, world: &'a World) -> Result<SimulatedRobot<'a>, ConfigError> {
        let config = Config::of(self.mission.config.clone(), self.sonar);
        SimulatedRobot::new(world, &config, self.seed)
    }

    /// What its trace begins with.
    pub fn header(&self, world: &World) -> TraceHeader {
        TraceHeader::new(&self.mission, &self.sonar, world.name(), self.seed)
    }

    /// Lets the robot explore; the hook sees all that happens.
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

    /// The numbers of a run, of which `map` is the map as it is read; `seconds` and `hash` are known to
    /// the caller.
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
