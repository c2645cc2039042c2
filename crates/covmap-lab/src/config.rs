//! The configuration of a simulated run: belief, behaviour, and the physics of the sensors.

use covmap_explore::{ParameterError, Parameters, RobotParameters};
use covmap_model::{ModelParameters, SensorModel};
use covmap_plan::PlannerParameters;
use covmap_sonar::{RingSpecification, SonarRing};
use covmap_world::{PhysicsError, SonarPhysics};
use serde::{Deserialize, Serialize};

/// All parameters of a simulated run: the content of a file of `configs`.
///
/// The sections are a robot, the physics of its sensors, its sensor model and its planner. The crate that
/// reads a section defines it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// The side of a cell, r \[m\].
    pub resolution: f64,
    /// The robot.
    pub robot: RobotParameters,
    /// Simulated physics of the sensors, which the belief does not know.
    pub sonar: SonarPhysics,
    /// The sensor model and the footprint.
    pub model: ModelParameters,
    /// ε, thresholds, stall rule, strategy.
    pub planner: PlannerParameters,
}

/// Error in a configuration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// The parameters of the robot.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The physics.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

impl Config {
    /// Returns the default: a B21r, r = .1 m, 3 m usable range, ε = .6, IG_CL:0.1, and cones that
    /// shrink from a half-angle of 12.5° near the sensor to 7.5° at 2.9 m.
    pub fn b21r() -> Self {
        Self {
            resolution: 0.1,
            robot: RobotParameters { radius: 0.27, speed: 0.5, ring: RingSpecification::B21r },
            sonar: SonarPhysics { cone_shrink_per_metre: 0.03, ..SonarPhysics::b21r() },
            model: ModelParameters::b21r(),
            planner: PlannerParameters::standard(),
        }
    }

    /// Returns the configuration with these parameters and this physics.
    pub fn of(parameters: Parameters, sonar: SonarPhysics) -> Self {
        let Parameters { resolution, robot, model, planner } = parameters;
        Self { resolution, robot, sonar, model, planner }
    }

    /// Returns the parameters of the robot: all sections except the physics.
    pub fn parameters(&self) -> Parameters {
        let Self { resolution, robot, sonar: _, model, planner } = self.clone();
        Parameters { resolution, robot, model, planner }
    }

    /// Builds the ring and the sensor model. Checks all sections except the planner's, which
    /// [`covmap_plan::Planner::new`] checks.
    ///
    /// # Errors
    /// If any parameter is out of its interval.
    pub fn build(&self) -> Result<(SonarRing, SensorModel), ConfigError> {
        self.sonar.validate()?;
        Ok(self.parameters().build()?)
    }
}
