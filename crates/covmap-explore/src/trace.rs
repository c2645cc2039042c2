//! The trace of a run: every scan and every decision.

use crate::{Config, Ending, Limits, Mission, MissionError};
use covmap::{Cell, Grid, Raster};
use covmap_plan::Decision;
use covmap_sonar::Scan;
use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// The version of the trace's format.
pub const TRACE_VERSION: u32 = 4;

/// The first line of a trace: all that is needed to repeat the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraceHeader {
    /// [`TRACE_VERSION`].
    pub covmap_trace: u32,
    /// The name of the world.
    pub world: String,
    /// The seed of the noise.
    pub seed: u64,
    /// All parameters, the strategy among them.
    pub config: Config,
    /// The map's grid.
    pub grid: Grid,
    /// The row-major indices of the first cell and past the last of every run of cells in
    /// the extent: the others are outside.
    pub inside: Vec<(usize, usize)>,
    /// Where the robot started, `world_from_robot`.
    pub start: Isometry2<f64>,
    /// How it measured, and its budget.
    pub limits: Limits,
}

impl TraceHeader {
    /// The header of a mission in the world called `world`.
    pub fn new(mission: &Mission, world: &str, seed: u64) -> Self {
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
            config: mission.config.clone(),
            grid: mission.grid,
            inside,
            start: mission.start,
            limits: mission.limits,
        }
    }

    /// The mission that the header describes. Anybody may have written it.
    ///
    /// # Errors
    /// If [`Mission::validate`] finds something, or what is inside is no list of runs of cells in
    /// order.
    pub fn mission(&self) -> Result<Mission, MissionError> {
        let mut outside = Raster::filled(self.grid, true);
        let (mut end, cells) = (0, self.grid.len());
        for (number, &(first, next)) in self.inside.iter().enumerate() {
            if first < end || next <= first || next > cells {
                return Err(MissionError::Inside { number, first, next, end, cells });
            }
            outside.values_mut()[first..next].fill(false);
            end = next;
        }
        let Self { config, grid, start, limits, .. } = self.clone();
        let mission = Mission { config, grid, outside, start, limits };
        mission.validate()?;
        Ok(mission)
    }
}

/// What happens in a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Event {
    /// The robot measured.
    Scan {
        /// How many scans there were before.
        number: usize,
        /// What it measured, and where.
        scan: Scan,
    },
    /// The planner chose.
    Decision {
        /// How many decisions there were before.
        number: usize,
        /// The cell the robot was in.
        from: Cell,
        /// What it chose, and why.
        decision: Decision,
    },
    /// The robot bumped into something.
    Bump {
        /// The cell that it was entering; its own, if it did not get to its centre.
        cell: Cell,
        /// The last place without contact \[m\].
        at: Point2<f64>,
        /// Where it was driving \[m\].
        towards: Point2<f64>,
    },
    /// The run is over.
    End {
        /// How it ended.
        ending: Ending,
    },
}

/// A hash over a trace, line by line: the same for the same run.
#[derive(Debug, Clone, Default)]
pub struct TraceHasher(Sha256);

impl TraceHasher {
    /// Adds a line of the trace.
    pub fn add<T: Serialize>(&mut self, line: &T) {
        // Numbers are written with all their digits; what cannot be written cannot differ.
        self.0.update(serde_json::to_vec(line).unwrap_or_default());
        self.0.update(b"\n");
    }

    /// Adds bytes that are no line of the trace, such as those of the belief.
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The hash as a hexadecimal number.
    pub fn finish(self) -> String {
        let mut text = String::new();
        for byte in self.0.finalize() {
            let _ = write!(text, "{byte:02x}");
        }
        text
    }
}
