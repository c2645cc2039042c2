//! All parameters of a run: belief and behaviour.

use covmap::{GridError, short};
use covmap_model::{ModelError, ModelParameters, SensorModel};
use covmap_plan::{PlannerError, PlannerParameters};
use covmap_sonar::{RingError, RingSpecification, SonarRing};
use covmap_world::{PhysicsError, SonarPhysics};
use serde::{Deserialize, Serialize};

/// The robot's body and its sensors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotParameters {
    /// Radius of its disc \[m\].
    pub radius: f64,
    /// Speed \[m/s\], for the times of scans.
    pub speed: f64,
    /// Its ring of range sensors.
    pub ring: RingSpecification,
}

/// A robot, the physics of its sensors, what it makes of their readings, and how it plans:
/// each section is defined by the crate that reads it.
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
    /// A number of the robot is out of its interval.
    #[error("robot.{name}: {} must lie in [{min}, {max}]", short(value))]
    Robot {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Smallest allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
    },
    /// The ring.
    #[error("robot.ring: {0}")]
    Ring(#[from] RingError),
    /// The physics.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// The sensor model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The planner.
    #[error(transparent)]
    Planner(#[from] PlannerError),
    /// The resolution.
    #[error(transparent)]
    Grid(#[from] GridError),
}

impl Config {
    /// The default: a B21r, r = .1 m, 3 m usable range, ε = .6, IG_CL(.3), and cones that
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

    /// The ring and the sensor model, with all sections checked but the planner's, which
    /// [`covmap_plan::Planner::new`] checks.
    ///
    /// # Errors
    /// If any parameter is out of its interval.
    pub fn build(&self) -> Result<(SonarRing, SensorModel), ConfigError> {
        let within = |name, value: f64, min, max| {
            let good = (min..=max).contains(&value);
            good.then_some(()).ok_or(ConfigError::Robot { name, value, min, max })
        };
        within("radius", self.robot.radius, 0.01, 10.0)?;
        within("speed", self.robot.speed, 1e-3, 100.0)?;
        self.sonar.validate()?;
        let ring = SonarRing::from_specification(&self.robot.ring)?;
        let model = SensorModel::new(&self.model, &ring, self.resolution)?;
        Ok((ring, model))
    }
}
