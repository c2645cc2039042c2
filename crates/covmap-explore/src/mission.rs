//! What is to be explored, and from where.

use crate::{ParameterError, Parameters};
use covmap::{Cell, Grid, Raster, short};
use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};

/// How a run measures, and how long it may last.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The distance between scans while driving \[m\]; `None` measures at view-points only.
    pub while_driving: Option<f64>,
    /// End after this number of scans.
    pub max_scans: Option<usize>,
}

impl Limits {
    /// Checks the limits: with others a run would not begin, or not end.
    ///
    /// # Errors
    /// If one is out of its interval.
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

/// Why a mission cannot be begun.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MissionError {
    /// A parameter is invalid.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// The start pose is not finite or not in the extent.
    #[error("the start ({}, {}) lies outside of the world", short(.0), short(.1))]
    StartOutside(f64, f64),
    /// The distance between scans while driving is impossible.
    #[error("measuring while driving every {} m: it must be at least 0.01 m, at most 1e6 m", short(.0))]
    WhileDriving(f64),
    /// No scan is allowed.
    #[error("max_scans is 0: a run needs at least one scan; leave it out for no limit")]
    MaxScans,
    /// The grids of a mission differ.
    #[error("the grid, and the cells that are outside, are not of the configuration's resolution of {} m", short(.0))]
    Grids(f64),
}

/// The environment's extent on its grid, the start, and the parameters: all that the
/// robot is told.
#[derive(Debug, Clone, PartialEq)]
pub struct Mission {
    /// The parameters.
    pub config: Parameters,
    /// The grid of the map.
    pub grid: Grid,
    /// The cells outside the extent of the environment.
    pub outside: Raster<bool>,
    /// Where the robot starts, `world_from_robot`; the heading is kept.
    pub start: Isometry2<f64>,
    /// How it measures and how long.
    pub limits: Limits,
}

impl Mission {
    /// Checks what must hold of a mission that anybody may have put together, but for its
    /// parameters ([`Parameters::build`]). [`explore`](crate::explore()) calls it.
    ///
    /// # Errors
    /// If a limit is impossible, the grids do not fit, or the start is not in the grid.
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

/// Where a robot stands in a cell \[m\]: on its centre; in the cell of a start \[m\] from which it
/// does not get there, so that it is `cramped`, on the start itself.
pub fn standing_place(grid: &Grid, start: Point2<f64>, cramped: bool, cell: Cell) -> Point2<f64> {
    if cramped && grid.cell_at(start) == Some(cell) { start } else { grid.center(cell) }
}
