//! The limit of memory: work that would take more is refused before it begins.
//!
//! The limit holds for the whole process.

use crate::error::{MemoryError, Result};
use crate::{Config, ConfigError};
use covmap::{CoverageMap, Grid};
use covmap_plan::planner_bytes;
use std::sync::atomic::{AtomicU64, Ordering};

const GIB: f64 = (1u64 << 30) as f64;

/// The allowed memory \[bytes\]; by default the amount in the help of `--memory`.
static LIMIT: AtomicU64 = AtomicU64::new(4 << 30);

/// Sets the allowed memory \[GiB\].
pub fn allow(gib: f64) {
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    LIMIT.store((gib * GIB) as u64, Ordering::Relaxed);
}

/// Checks that `at_once` runs with a configuration on a grid fit into the allowed memory.
///
/// # Errors
/// If they do not fit, or if the configuration is invalid.
pub fn check_run(grid: &Grid, config: &Config, at_once: usize) -> Result<()> {
    let times = u64::try_from(at_once).unwrap_or(u64::MAX);
    let bytes = run_bytes(config, grid)?.saturating_mul(times);
    let several = if at_once > 1 { format!("{at_once} times ") } else { String::new() };
    let beams = config.build()?.0.beams().len();
    let resolution = config.resolution;
    Ok(check(bytes, || match grid.len() {
        // Not of a particular world.
        1 => format!("the planner's tables for {beams} sensors in cells of {resolution} m"),
        _ => format!("{several}{} and a planner for {beams} sensors", map_of(grid, config)),
    })?)
}

/// Returns the number of runs with a configuration on a grid that fit at the same time; at least one.
///
/// # Errors
/// If the configuration is invalid.
pub fn runs_at_once(grid: &Grid, config: &Config) -> Result<usize> {
    let fit = LIMIT.load(Ordering::Relaxed) / run_bytes(config, grid)?.max(1);
    Ok(usize::try_from(fit).unwrap_or(usize::MAX).max(1))
}

/// Checks that the map of a configuration on a grid fits into the allowed memory.
///
/// # Errors
/// If the map does not fit.
pub fn check_map(grid: &Grid, config: &Config) -> Result<(), MemoryError> {
    // Besides the map: the occupancy map, the output and the pictures.
    const BESIDE: u64 = 60;
    let cells = u64::try_from(grid.len()).unwrap_or(u64::MAX);
    let bytes = CoverageMap::bytes(grid, config.model.bins).saturating_mul(2);
    check(bytes.saturating_add(BESIDE.saturating_mul(cells)), || map_of(grid, config))
}

fn map_of(grid: &Grid, config: &Config) -> String {
    let (width, height, bins) = (grid.width(), grid.height(), config.model.bins);
    format!("a map of {width} × {height} cells with {bins} bins each")
}

fn check(bytes: u64, what: impl Fn() -> String) -> Result<(), MemoryError> {
    let limit = LIMIT.load(Ordering::Relaxed);
    if bytes <= limit { Ok(()) } else { Err(MemoryError { what: what(), bytes, limit }) }
}

/// Estimates the peak memory of a run with a configuration on a grid, including the truth and the scores
/// of its map \[bytes\]. The estimate is mostly too large.
///
/// # Errors
/// If a section of the configuration other than the planner's is invalid.
pub fn run_bytes(config: &Config, grid: &Grid) -> Result<u64, ConfigError> {
    // Coverage, clearances, the cells in sight for each of the parallel parts, and the certificate.
    const SCORES: usize = 8 + 8 + 2 * 18 + 16;
    let (_, model) = config.build()?;
    let scores = u64::try_from(grid.len().saturating_mul(SCORES)).unwrap_or(u64::MAX);
    // The belief once more, for its output.
    let maps = CoverageMap::bytes(grid, config.model.bins).saturating_mul(2);
    Ok(planner_bytes(&config.planner, &model, grid).saturating_add(maps).saturating_add(scores))
}
