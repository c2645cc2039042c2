//! The thresholds of the map for other software.

use super::values::{coverage, entropy};
use clap::Args;
use covmap_io::MapThresholds;
use covmap_plan::PlannerParameters;

/// The most likely coverage from which a cell is occupied.
const OCCUPIED: f64 = 0.5;

/// The thresholds of map.pgm; by default the planner's.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct SafeMap {
    /// In map.pgm, a cell with a larger entropy is unknown, in nats [default:
    /// planner.entropy_threshold of the configuration for free cells, no limit for occupied ones]
    #[arg(long, value_name = "NATS", value_parser = entropy)]
    pub(crate) map_entropy: Option<f64>,
    /// In map.pgm, a cell with at most this coverage is free [default: planner.traversable_coverage
    /// of the configuration]
    #[arg(long, value_name = "COVERAGE", value_parser = coverage)]
    pub(crate) map_free: Option<f64>,
    /// In map.pgm, a cell with at least this coverage is occupied [default: 0.5]
    #[arg(long, value_name = "COVERAGE", value_parser = coverage)]
    pub(crate) map_occupied: Option<f64>,
}

impl SafeMap {
    pub(crate) fn thresholds(&self, planner: &PlannerParameters) -> MapThresholds {
        MapThresholds {
            entropy: self.map_entropy.unwrap_or(planner.entropy_threshold),
            occupied_entropy: self.map_entropy.unwrap_or(f64::INFINITY),
            free: self.map_free.unwrap_or(planner.traversable_coverage),
            occupied: self.map_occupied.unwrap_or(OCCUPIED),
        }
    }
}
