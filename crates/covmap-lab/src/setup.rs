//! Setting up a mission in a simulated world.

use crate::{Config, ConfigError};
use covmap::{Raster, short};
use covmap_explore::{Limits, Mission, MissionError, ParameterError};
use covmap_world::World;
use nalgebra::{Isometry2, Point2};

/// Why a mission in a simulated world cannot be begun.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// The configuration is invalid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The mission is impossible in any world.
    #[error(transparent)]
    Mission(#[from] MissionError),
    /// Something is where the robot should start.
    #[error(
        "the robot of radius {radius} m cannot stand at the start ({}, {}): the next obstacle is {clearance:.3} m from there",
        short(x),
        short(y)
    )]
    StartOccupied {
        /// Start.
        x: f64,
        /// Start.
        y: f64,
        /// The robot's radius \[m\].
        radius: f64,
        /// The distance to the nearest solid \[m\].
        clearance: f64,
    },
    /// No cell of the world is free.
    #[error("a robot of radius {0} m fits nowhere in this world")]
    NoStart(f64),
    /// What is inside is no list of runs of cells.
    #[error(
        "inside[{number}]: ({first}, {next}) is no run of cells after {end} in a grid of {cells}"
    )]
    Inside {
        /// Which run.
        number: usize,
        /// Its first cell.
        first: usize,
        /// The first cell past it.
        next: usize,
        /// The first cell past the one before.
        end: usize,
        /// How many cells the grid has.
        cells: usize,
    },
}

/// The mission to explore a world; from the world's own start, or, if it gives none,
/// from its roomiest place, if `start` is `None`.
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
    Ok(Mission { config: config.parameters(), grid, outside, start, limits })
}

/// The rectangle that is to be explored.
struct Extent {
    low: Point2<f64>,
    high: Point2<f64>,
}

impl Extent {
    fn holds(&self, p: Point2<f64>) -> bool {
        (self.low.x..=self.high.x).contains(&p.x) && (self.low.y..=self.high.y).contains(&p.y)
    }
}
