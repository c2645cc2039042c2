//! The parameters of a robot: its body, its belief, its behaviour.

use covmap::{GridError, short};
use covmap_model::{ModelError, ModelParameters, SensorModel};
use covmap_plan::{PlannerError, PlannerParameters};
use covmap_sonar::{RingError, RingSpecification, SonarRing};
use serde::{Deserialize, Serialize};

/// The robot's body and its sensors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotParameters {
    /// Radius of the body, a disc \[m\].
    pub radius: f64,
    /// Speed \[m/s\], for the times of scans.
    pub speed: f64,
    /// Ring of range sensors.
    pub ring: RingSpecification,
}

/// Parameters of a robot, its sensor model and its planner. The crate that reads a section defines it.
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

/// Error in the parameters.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// A number of the robot is out of its interval.
    #[error("robot.{name}: {} must lie in [{min}, {max}]", short(value))]
    Robot {
        /// Name of the parameter.
        name: &'static str,
        /// Value of the parameter.
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
    /// Builds the ring and the sensor model. Checks all sections except the planner's, which
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
