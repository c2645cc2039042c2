//! How much memory a run will take, before it takes any.

use crate::{Config, ConfigError};
use covmap::{CoverageMap, Grid};
use covmap_plan::planner_bytes;

/// About how many bytes a run with a configuration on a grid takes at most, the truth and the
/// scores of its map among them: an estimate, mostly too large.
///
/// # Errors
/// If the configuration is invalid, but for its planner.
pub fn run_bytes(config: &Config, grid: &Grid) -> Result<u64, ConfigError> {
    // Coverage, clearances, what is in sight of each of the parts that look, and the certificate.
    const SCORES: usize = 8 + 8 + 2 * 18 + 16;
    let (_, model) = config.build()?;
    let scores = u64::try_from(grid.len().saturating_mul(SCORES)).unwrap_or(u64::MAX);
    // The belief once more, as it is written.
    let maps = CoverageMap::bytes(grid, config.model.bins).saturating_mul(2);
    Ok(planner_bytes(&config.planner, &model, grid).saturating_add(maps).saturating_add(scores))
}
