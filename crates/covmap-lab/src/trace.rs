//! The header of a trace.

use crate::{Config, SetupError};
use covmap::{Grid, Raster};
use covmap_explore::{Limits, Mission};
use covmap_world::SonarPhysics;
use nalgebra::Isometry2;
use serde::{Deserialize, Serialize};

/// Version of the trace's format.
pub const TRACE_VERSION: u32 = 5;
/// Oldest version that can be read; it spells strategies `{"IgCl":{"alpha":0.3}}`.
pub const OLDEST_TRACE: u32 = 4;

/// Header of a trace, its first line: everything needed to repeat the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraceHeader {
    /// [`TRACE_VERSION`].
    pub covmap_trace: u32,
    /// The name of the world.
    pub world: String,
    /// The seed of the noise.
    pub seed: u64,
    /// All parameters, including the strategy.
    pub config: Config,
    /// The map's grid.
    pub grid: Grid,
    /// Row-major indices of the first cell and past the last cell of every run of cells in the extent; all
    /// other cells are outside.
    pub inside: Vec<(usize, usize)>,
    /// Start pose, `world_from_robot`.
    pub start: Isometry2<f64>,
    /// Limits of the run.
    pub limits: Limits,
}

impl TraceHeader {
    /// Returns the header of a mission in the world called `world`, with the physics of its sensors.
    pub fn new(mission: &Mission, sonar: &SonarPhysics, world: &str, seed: u64) -> Self {
        let outside = mission.outside.values();
        let mut inside: Vec<(usize, usize)> = Vec::new();
        for index in (0..outside.len()).filter(|i| !outside[*i]) {
            match inside.last_mut() {
                Some((_, end)) if *end == index => *end += 1,
                _ => inside.push((index, index + 1)),
            }
        }
        Self {
            covmap_trace: TRACE_VERSION,
            world: world.to_owned(),
            seed,
            config: Config::of(mission.config.clone(), *sonar),
            grid: mission.grid,
            inside,
            start: mission.start,
            limits: mission.limits,
        }
    }

    /// Returns the mission that the header describes, checked, as the header may come from any program.
    ///
    /// # Errors
    /// If [`Mission::validate`] fails, or `inside` is not a list of runs of cells in order.
    pub fn mission(&self) -> Result<Mission, SetupError> {
        let mut outside = Raster::filled(self.grid, true);
        let (mut end, cells) = (0, self.grid.len());
        for (number, &(first, next)) in self.inside.iter().enumerate() {
            if first < end || next <= first || next > cells {
                return Err(SetupError::Inside { number, first, next, end, cells });
            }
            outside.values_mut()[first..next].fill(false);
            end = next;
        }
        let Self { grid, start, limits, .. } = *self;
        let config = self.config.parameters();
        let mission = Mission { config, grid, outside, start, limits, explains: true };
        mission.validate()?;
        Ok(mission)
    }
}
