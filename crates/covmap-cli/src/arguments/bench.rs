//! What `bench` can be told.

use super::files::Force;
use crate::bench::Point;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
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
