//! No more memory than allowed: what would take more is refused before it takes any.

use anyhow::{Result, bail};
use covmap::{CoverageMap, Grid};
use covmap_lab::{Config, run_bytes};
use std::sync::atomic::{AtomicU64, Ordering};

const GIB: f64 = (1u64 << 30) as f64;

/// How many bytes are allowed: by default as many as `--memory` says in its help.
static LIMIT: AtomicU64 = AtomicU64::new(4 << 30);

/// Allows this many GiB from now on.
pub(crate) fn allow(gib: f64) {
    #[allow(clippy::cast_possible_truncation, reason = "saturates")]
    LIMIT.store((gib * GIB) as u64, Ordering::Relaxed);
}

/// Checks that a run with a configuration on a grid fits, and how many of it at the same time.
pub(crate) fn check_run(grid: &Grid, config: &Config, at_once: usize) -> Result<()> {
    let times = u64::try_from(at_once).unwrap_or(u64::MAX);
    let bytes = run_bytes(config, grid)?.saturating_mul(times);
    let several = if at_once > 1 { format!("{at_once} times ") } else { String::new() };
    let beams = config.build()?.0.beams().len();
    let resolution = config.resolution;
    check(bytes, || match grid.len() {
        // Of whatever world.
        1 => format!("the planner's tables for {beams} sensors in cells of {resolution} m"),
        _ => format!("{several}{} and a planner for {beams} sensors", map_of(grid, config)),
    })
}

/// How many runs with a configuration on a grid fit at the same time; at least one.
pub(crate) fn runs_at_once(grid: &Grid, config: &Config) -> Result<usize> {
    let fit = LIMIT.load(Ordering::Relaxed) / run_bytes(config, grid)?.max(1);
    Ok(usize::try_from(fit).unwrap_or(usize::MAX).max(1))
}

/// Checks that the map of a configuration on a grid fits.
pub(crate) fn check_map(grid: &Grid, config: &Config) -> Result<()> {
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

fn check(bytes: u64, what: impl Fn() -> String) -> Result<()> {
    let limit = LIMIT.load(Ordering::Relaxed);
    if bytes <= limit {
        return Ok(());
    }
    bail!(
        "{} would take about {} of memory, more than {}; use a coarser resolution, or allow more \
         with --memory",
        what(),
        amount(bytes),
        amount(limit)
    )
}

/// An amount of memory as one would say it.
fn amount(bytes: u64) -> String {
    let gib = bytes as f64 / GIB;
    if gib < 1.0 { format!("{:.0} MiB", 1024.0 * gib) } else { format!("{gib:.1} GiB") }
}
