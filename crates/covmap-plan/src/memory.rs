//! How much memory a planner will take, before it takes any.

use crate::PlannerParameters;
use covmap::{CoverageMap, Grid};
use covmap_gain::GainCache;
use covmap_model::SensorModel;

/// About how many bytes a [`Planner`](crate::Planner) on a grid takes at most while it is made and
/// decides: an estimate, mostly too large, to be asked for before there is one.
pub fn planner_bytes(parameters: &PlannerParameters, model: &SensorModel, grid: &Grid) -> u64 {
    // Ways and costs, what is explored, where it can stand, where it measured.
    const BY_CELL: u64 = 80;
    let cells = u64::try_from(grid.len()).unwrap_or(u64::MAX);
    // An unknown map, to begin with.
    let unknown = CoverageMap::bytes(grid, model.parameters().bins);
    BY_CELL
        .saturating_mul(cells)
        .saturating_add(GainCache::bytes(model, grid, parameters.upkeep()))
        .saturating_add(unknown)
}
