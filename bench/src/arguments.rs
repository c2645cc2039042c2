//! The arguments of `bench`.

use crate::growth::Point;
use clap::{Parser, ValueEnum};
use covmap_cli::Force;
use std::path::PathBuf;

const BENCH_EXAMPLES: &str = "\
Each row is a ratio of times: that of another way to the same answers, over ours. Both are measured
in one run, by the computing time of one core. A ratio below its target is marked `falls short`,
which is not an error. The last lines give the agreement of the answers, and the wall time of a
decision on all threads. The worlds are offices like scenarios/office.ron in cells of 0.1 m, partly
explored, with a fixed seed.

Examples:
  cargo xtask bench           the whole table, some minutes
  cargo xtask bench --quick   the same rows on small maps, some seconds: the targets are for the
                              large ones
";

/// Measures how fast decisions, updates and echoes are, as ratios.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask bench", after_help = BENCH_EXAMPLES)]
pub(crate) struct Bench {
    /// Smaller maps and samples: a look, not a measurement
    #[arg(long)]
    pub(crate) quick: bool,
    /// Only these rows
    #[arg(long, value_enum)]
    pub(crate) only: Option<Rows>,
    /// Measure instead the growth of a decision's time and memory: writes growth.csv, .svg and .png
    /// into this folder
    #[arg(long, value_name = "DIR", conflicts_with = "only")]
    pub(crate) growth: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    /// One point of --growth, in a process of its own
    #[arg(long, hide = true, value_name = "SIDE:BINS:RANGE")]
    pub(crate) point: Option<Point>,
}

/// The rows that `bench` measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Rows {
    /// Choosing view-points by information gain
    Decisions,
    /// Integrating scans
    Integrating,
    /// Distance fields
    Fields,
    /// Firing the ring
    Firing,
}
