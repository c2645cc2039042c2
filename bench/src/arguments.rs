//! What can be typed.

use crate::growth::Point;
use clap::{Parser, ValueEnum};
use covmap_cli::Force;
use std::path::PathBuf;

const BENCH_EXAMPLES: &str = "\
Each row is a ratio, measured on one core in one run, by the time that the core computes: how many
times as long the other way takes to the same answers. Behind a ratio below its target stands
`falls short`; that is no error. The last lines say how well the answers agree, and how long a
decision takes on all threads, by the clock. The worlds are offices like scenarios/office.ron in
cells of 0.1 m, partly explored, with a fixed seed.

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
    /// These rows alone
    #[arg(long, value_enum)]
    pub(crate) only: Option<Rows>,
    /// How time and memory of a decision grow instead: writes growth.csv, .svg and .png into
    /// this folder
    #[arg(long, value_name = "DIR", conflicts_with = "only")]
    pub(crate) growth: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    /// One point of --growth, by a process of its own
    #[arg(long, hide = true, value_name = "SIDE:BINS:RANGE")]
    pub(crate) point: Option<Point>,
}

/// What `bench` measures.
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
