//! All parameters of a simulated run: belief, behaviour, and the physics of the sensors.

use covmap_explore::{ParameterError, Parameters, RobotParameters};
use covmap_model::{ModelParameters, SensorModel};
use covmap_plan::PlannerParameters;
use covmap_sonar::{RingSpecification, SonarRing};
use covmap_world::{PhysicsError, SonarPhysics};
use serde::{Deserialize, Serialize};

/// A robot, the physics of its sensors, what it makes of their readings, and how it plans: each section
/// is defined by the crate that reads it. What a file of `configs` holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Config {
    /// The side of a cell, r \[m\].
    pub resolution: f64,
    /// The robot.
    pub robot: RobotParameters,
    /// The simulated physics of its sensors; the belief knows nothing of it.
    pub sonar: SonarPhysics,
    /// The sensor model and the footprint.
    pub model: ModelParameters,
    /// ε, thresholds, stall rule, strategy.
    pub planner: PlannerParameters,
}

/// What is wrong with a configuration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// What the robot is told.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The physics.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

impl Config {
    /// The default: a B21r, r = .1 m, 3 m usable range, ε = .6, IG_CL:0.1, and cones that
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

    /// The same parameters with a physics.
    pub fn of(parameters: Parameters, sonar: SonarPhysics) -> Self {
        let Parameters { resolution, robot, model, planner } = parameters;
        Self { resolution, robot, sonar, model, planner }
    }

    /// What the robot is told: all but the physics.
    pub fn parameters(&self) -> Parameters {
        let Self { resolution, robot, sonar: _, model, planner } = self.clone();
        Parameters { resolution, robot, model, planner }
    }

    /// The ring and the sensor model, with all sections checked but the planner's, which
    /// [`covmap_plan::Planner::new`] checks.
    ///
    /// # Errors
    /// If any parameter is out of its interval.
    pub fn build(&self) -> Result<(SonarRing, SensorModel), ConfigError> {
        self.sonar.validate()?;
        Ok(self.parameters().build()?)
    }
}
