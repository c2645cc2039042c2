//! Estimate of a planner's memory, before the planner is made.

use crate::PlannerParameters;
use covmap::{CoverageMap, Grid};
use covmap_gain::GainCache;
use covmap_model::SensorModel;

/// Estimates the peak memory of a [`Planner`](crate::Planner) on a grid while it is made and decides
/// \[bytes\]. The estimate is mostly too large, and needs no planner.
pub fn planner_bytes(parameters: &PlannerParameters, model: &SensorModel, grid: &Grid) -> u64 {
    // Travel costs, exploration, traversable cells, places of scans.
    const BY_CELL: u64 = 80;
    let cells = u64::try_from(grid.len()).unwrap_or(u64::MAX);
    // An unknown map, to begin with.
    let unknown = CoverageMap::bytes(grid, model.parameters().bins);
    BY_CELL
        .saturating_mul(cells)
        .saturating_add(GainCache::bytes(model, grid, parameters.upkeep()))
        .saturating_add(unknown)
}
