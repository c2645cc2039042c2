//! The setup of a mission in a simulated world.

use crate::{Config, ConfigError};
use covmap::{Raster, short};
use covmap_explore::{Limits, Mission, MissionError, ParameterError};
use covmap_world::World;
use nalgebra::{Isometry2, Point2};

/// Error in the setup of a mission in a simulated world.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// The configuration is invalid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The mission is impossible in any world.
    #[error(transparent)]
    Mission(#[from] MissionError),
    /// An obstacle is too near to the start.
    #[error(
        "the robot of radius {radius} m cannot stand at the start ({}, {}): the next obstacle is {clearance:.3} m from there",
        short(x),
        short(y)
    )]
    StartOccupied {
        /// x of the start \[m\].
        x: f64,
        /// y of the start \[m\].
        y: f64,
        /// Radius of the robot \[m\].
        radius: f64,
        /// Distance to the nearest obstacle \[m\].
        clearance: f64,
    },
    /// The robot fits into no cell of the world.
    #[error("a robot of radius {0} m fits nowhere in this world")]
    NoStart(f64),
    /// `inside` is not a list of runs of cells.
    #[error(
        "inside[{number}]: ({first}, {next}) is no run of cells after {end} in a grid of {cells}"
    )]
    Inside {
        /// Number of the run.
        number: usize,
        /// First cell of the run.
        first: usize,
        /// First cell past the run.
        next: usize,
        /// First cell past the run before.
        end: usize,
        /// The number of cells of the grid.
        cells: usize,
    },
}

/// Returns the mission to explore a world.
///
/// If `start` is `None`, the robot starts where the world says, or in the roomiest place of a world
/// without a start.
///
/// # Errors
/// If the configuration is invalid or the robot cannot stand at the start.
pub fn mission(
    world: &World,
    config: &Config,
    start: Option<Isometry2<f64>>,
    limits: Limits,
) -> Result<Mission, SetupError> {
    config.build()?;
    limits.validate()?;
    let grid = world
        .grid(config.resolution)
        .map_err(|error| ConfigError::from(ParameterError::from(error)))?;
    let radius = config.robot.radius;
    let start = match start.or_else(|| world.given_start()) {
        Some(start) => start,
        None => world
            .default_start(&world.coverage(&grid), radius)
            .ok_or(SetupError::NoStart(radius))?,
    };
    let at = Point2::from(start.translation.vector);
    let extent = Extent { low: world.lower_left(), high: world.lower_left() + world.size() };
    if !extent.holds(at) || !start.rotation.angle().is_finite() {
        return Err(MissionError::StartOutside(at.x, at.y).into());
    }
    let clearance = world.clearance(at);
    if clearance < radius {
        return Err(SetupError::StartOccupied { x: at.x, y: at.y, radius, clearance });
    }
    let outside = Raster::from_fn(grid, |cell| !extent.holds(grid.center(cell)));
    Ok(Mission { config: config.parameters(), grid, outside, start, limits, explains: true })
}

/// The rectangle to explore.
struct Extent {
    low: Point2<f64>,
    high: Point2<f64>,
}

impl Extent {
    fn holds(&self, p: Point2<f64>) -> bool {
        (self.low.x..=self.high.x).contains(&p.x) && (self.low.y..=self.high.y).contains(&p.y)
    }
}
