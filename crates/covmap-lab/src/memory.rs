//! No more memory than allowed: what would take more is refused before it takes any.
//!
//! The limit is the process's, as the memory is.

use crate::error::{MemoryError, Result};
use crate::{Config, ConfigError};
use covmap::{CoverageMap, Grid};
use covmap_plan::planner_bytes;
use std::sync::atomic::{AtomicU64, Ordering};

const GIB: f64 = (1u64 << 30) as f64;

/// How many bytes are allowed: by default as many as `--memory` says in its help.
static LIMIT: AtomicU64 = AtomicU64::new(4 << 30);

/// Allows this many GiB from now on.
pub fn allow(gib: f64) {
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    LIMIT.store((gib * GIB) as u64, Ordering::Relaxed);
}

/// Checks that `at_once` runs with a configuration on a grid fit into the memory that is allowed.
///
/// # Errors
/// If they do not, or if the configuration is invalid.
pub fn check_run(grid: &Grid, config: &Config, at_once: usize) -> Result<()> {
    let times = u64::try_from(at_once).unwrap_or(u64::MAX);
    let bytes = run_bytes(config, grid)?.saturating_mul(times);
    let several = if at_once > 1 { format!("{at_once} times ") } else { String::new() };
    let beams = config.build()?.0.beams().len();
    let resolution = config.resolution;
    Ok(check(bytes, || match grid.len() {
        // Of whatever world.
        1 => format!("the planner's tables for {beams} sensors in cells of {resolution} m"),
        _ => format!("{several}{} and a planner for {beams} sensors", map_of(grid, config)),
    })?)
}

/// How many runs with a configuration on a grid fit at the same time; at least one.
///
/// # Errors
/// If the configuration is invalid.
pub fn runs_at_once(grid: &Grid, config: &Config) -> Result<usize> {
    let fit = LIMIT.load(Ordering::Relaxed) / run_bytes(config, grid)?.max(1);
    Ok(usize::try_from(fit).unwrap_or(usize::MAX).max(1))
}

/// Checks that the map of a configuration on a grid fits.
///
/// # Errors
/// If it does not.
pub fn check_map(grid: &Grid, config: &Config) -> Result<(), MemoryError> {
    // Beside it the occupancy map, what is written, and what is drawn.
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
