//! The arguments of the paper's experiments.

use clap::Args;
use covmap_cli::{Force, named_file};
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(crate) const FIGURE_EXAMPLES: &str = "\
DIR/figureN.svg and .png are the figure, DIR/figureN*.csv the numbers behind it. Figures 5, 6 and 7
need campaigns; runs that are finished in DIR/campaigns are reused. Figure 5 repeats a recorded run
of each technique for its map; figure 7 (c) and (d) are the recorded paths.

`gain` draws the computation of the expected information gain, as in docs/gain.md, from a run in
scenarios/lab.ron: DIR/gain-*.svg and .png.

Examples:
  cargo xtask figure 1
  cargo xtask figure 7 --quick --out out/quick
  cargo xtask figure gain --out docs/images
";

pub(crate) const PAPER_EXAMPLES: &str = "\
The output folder holds
  report.html               all figures, tables and verdicts, in one file
  claims.json               the verdicts with their figures and tests
  figure*.svg, .png, .csv   the figures, and the numbers behind them
  campaigns/                the runs; started again, the command runs only what is missing

A claim is `reproduced`, `not reproduced` or `undecided`. configs/paper.ron decides; configs/b21r.ron
is a second column. The unit is a paired (start, seed). Starts are resampled; a number from fewer
than three starts decides nothing. All campaigns are checked before the first run.

Examples:
  cargo xtask paper --out out/paper
  cargo xtask paper --quick --out out/quick
  cargo xtask paper --world building=maps/ours.yaml

Exit codes: 0 done, whatever the verdicts; 2 bad input, or a result that cannot be written; 130
interrupted with Ctrl-C.
";

#[derive(Debug, Args)]
pub(crate) struct Figure {
    /// Number of the figure: 1, 2, 3, 5, 6 or 7 of the paper, or gain for the six of docs/gain.md
    #[arg(value_parser = ["1", "2", "3", "5", "6", "7", "gain"])]
    pub(crate) number: String,
    #[command(flatten)]
    pub(crate) common: Experiments,
}

#[derive(Debug, Args)]
pub(crate) struct PaperTable {
    /// Number of the table: only 1
    #[arg(value_parser = ["1"])]
    pub(crate) number: String,
    #[command(flatten)]
    pub(crate) common: Experiments,
}

#[derive(Debug, Args)]
pub(crate) struct Paper {
    #[command(flatten)]
    pub(crate) common: Experiments,
    /// Take the world called NAME of configs/worlds.ron from this file: a scenario, or a map of
    /// map_server, such as one of a real building
    #[arg(long = "world", value_name = "NAME=FILE", value_parser = named_file)]
    pub(crate) worlds: Vec<(String, PathBuf)>,
}

/// The settings of the paper's experiments.
#[derive(Debug, Args)]
pub(crate) struct Experiments {
    /// Fewer seeds, coarser cells, smaller worlds: a look, not a result
    #[arg(long)]
    pub(crate) quick: bool,
    /// Number of runs at the same time [default: one for each core]
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// Folder for the results; finished runs in it are reused
    #[arg(long, value_name = "DIR", default_value = "out/paper")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The arguments for another program.
#[derive(Debug, Args)]
pub(crate) struct Rest {
    /// Arguments of that program; `--help` lists them
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENTS")]
    pub(crate) rest: Vec<String>,
}
