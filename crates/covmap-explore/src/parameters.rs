//! What a robot is told: its body, its belief, its behaviour.

use covmap::{GridError, short};
use covmap_model::{ModelError, ModelParameters, SensorModel};
use covmap_plan::{PlannerError, PlannerParameters};
use covmap_sonar::{RingError, RingSpecification, SonarRing};
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

/// A robot, what it makes of the readings of its sensors, and how it plans: each section is defined by
/// the crate that reads it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// The side of a cell, r \[m\].
    pub resolution: f64,
    /// The robot.
    pub robot: RobotParameters,
    /// The sensor model and the footprint.
    pub model: ModelParameters,
    /// ε, thresholds, stall rule, strategy.
    pub planner: PlannerParameters,
}

/// Why parameters cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterError {
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

impl Parameters {
    /// The ring and the sensor model, with all sections checked but the planner's, which
    /// [`covmap_plan::Planner::new`] checks.
    ///
    /// # Errors
    /// If any parameter is out of its interval.
    pub fn build(&self) -> Result<(SonarRing, SensorModel), ParameterError> {
        let within = |name, value: f64, min, max| {
            let good = (min..=max).contains(&value);
            good.then_some(()).ok_or(ParameterError::Robot { name, value, min, max })
        };
        within("radius", self.robot.radius, 0.01, 10.0)?;
        within("speed", self.robot.speed, 1e-3, 100.0)?;
        let ring = SonarRing::from_specification(&self.robot.ring)?;
        let model = SensorModel::new(&self.model, &ring, self.resolution)?;
        Ok((ring, model))
    }
}
