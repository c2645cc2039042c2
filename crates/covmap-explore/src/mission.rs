//! The mission: the extent to explore, the start, and the parameters.

use crate::{ParameterError, Parameters};
use covmap::{Cell, Grid, Raster, short};
use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};

/// Limits of a run, and its scans while driving.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Distance between scans while driving \[m\]; with `None` the robot measures at view-points only.
    pub while_driving: Option<f64>,
    /// The number of scans after which the run ends.
    pub max_scans: Option<usize>,
}

impl Limits {
    /// Checks the limits, so that a run begins and ends.
    ///
    /// # Errors
    /// If a limit is out of its interval.
    pub fn validate(&self) -> Result<(), MissionError> {
        if let Some(step) = self.while_driving.filter(|step| !(0.01..=1e6).contains(step)) {
            return Err(MissionError::WhileDriving(step));
        }
        if self.max_scans == Some(0) {
            return Err(MissionError::MaxScans);
        }
        Ok(())
    }
}

/// Error in a mission.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MissionError {
    /// A parameter is invalid.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The start pose is not finite, or lies outside of the grid or the extent.
    #[error("the start ({}, {}) lies outside of the world", short(.0), short(.1))]
    StartOutside(f64, f64),
    /// The distance between scans while driving is out of its interval.
    #[error("measuring while driving every {} m: it must be at least 0.01 m, at most 1e6 m", short(.0))]
    WhileDriving(f64),
    /// No scan is allowed.
    #[error("max_scans is 0: a run needs at least one scan; leave it out for no limit")]
    MaxScans,
    /// The grids of a mission differ.
    #[error("the map and the cells outside must have the same grid, with the configuration's resolution of {} m", short(.0))]
    Grids(f64),
}

/// Everything that the robot knows beforehand: the environment's extent on its grid, the start, and the
/// parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Mission {
    /// The parameters.
    pub config: Parameters,
    /// The grid of the map.
    pub grid: Grid,
    /// The cells outside of the environment's extent.
    pub outside: Raster<bool>,
    /// Start pose, `world_from_robot`; the robot keeps the heading.
    pub start: Isometry2<f64>,
    /// Limits of the run.
    pub limits: Limits,
    /// Whether a decision tells what its five best candidates would gain, though the strategy does not weigh
    /// gains. What the robot does is the same without, and takes less time.
    pub explains: bool,
}

impl Mission {
    /// Checks the mission except its parameters, which [`Parameters::build`] checks.
    /// [`explore`](crate::explore()) calls this.
    ///
    /// # Errors
    /// If a limit is out of its interval, the grids do not fit, or the start is not on the grid.
    pub fn validate(&self) -> Result<(), MissionError> {
        self.limits.validate()?;
        let resolution = self.config.resolution;
        let fits = (self.grid.resolution() - resolution).abs() <= 1e-12;
        if !fits || *self.outside.grid() != self.grid {
            return Err(MissionError::Grids(resolution));
        }
        let at = Point2::from(self.start.translation.vector);
        if self.grid.cell_at(at).is_none() || !self.start.rotation.angle().is_finite() {
            return Err(MissionError::StartOutside(at.x, at.y));
        }
        Ok(())
    }
}

/// Returns the place where a robot stands in a cell \[m\].
///
/// This is the centre of the cell. A robot that cannot get from its start \[m\] to the centre of the
/// start's cell is `cramped`: in that cell it stands on the start itself.
pub fn standing_place(grid: &Grid, start: Point2<f64>, cramped: bool, cell: Cell) -> Point2<f64> {
    if cramped && grid.cell_at(start) == Some(cell) { start } else { grid.center(cell) }
}
