//! What can be typed for campaigns.

use super::values::named_file;
use clap::Args;
use covmap_campaign::Shard;
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(super) const CAMPAIGN_EXAMPLES: &str = "\
CAMPAIGN.ron names worlds, settings, strategies, starts and seeds; every combination is a run.
What they are in a file is in docs/guide.md, and in configs/fig7.ron.

Each run is recorded when it is done. Begun again, the campaign goes on with what is missing;
damaged results are done again. Ctrl-C ends it, and what is done stays.

The folder that is written:
  runs.csv                  a line a run: all numbers but times
  timings.csv               a line a run: times
  summary.csv               mean, standard deviation, 95 % interval of the mean, n, n cut short
  campaign.json, runs/      the list of the runs, and a file for each that is done
As long as runs are missing, the names of the tables say so: runs-8-of-12.csv.

Examples:
  cargo xtask campaign configs/fig7.ron
  cargo xtask campaign configs/fig7.ron --shard 2/3 --out out/fig7-2

Exit codes: 0 done; 2 bad input, or a result that cannot be written; 130 interrupted with Ctrl-C.
";

pub(super) const COLLECT_EXAMPLES: &str = "\
All folders are of one campaign and one version of covmap. The tables are the same as if one
machine had run everything.

Example:
  cargo xtask collect out/fig7-1 out/fig7-2 out/fig7-3 --out out/fig7
";

/// What can be typed for `campaign`.
#[derive(Debug, Args)]
pub struct Campaign {
    /// What is run (.ron)
    #[arg(value_name = "CAMPAIGN.ron")]
    pub(crate) file: PathBuf,
    /// The number of runs at the same time [default: one for each core]
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// Takes the world called NAME from another file than the campaign says
    #[arg(long = "world", value_name = "NAME=FILE", value_parser = named_file)]
    pub(crate) worlds: Vec<(String, PathBuf)>,
    /// Only say how many runs there are, and whether all is well with them
    #[arg(long)]
    pub(crate) check: bool,
    /// Every N-th run only, from the I-th on
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub(crate) shard: Shard,
    /// Where the results go [default: out/CAMPAIGN]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print nothing but errors and notes
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What can be typed for `collect`.
#[derive(Debug, Args)]
pub struct Collect {
    /// Folders that `campaign` wrote
    #[arg(value_name = "DIR", required = true)]
    pub(crate) dirs: Vec<PathBuf>,
    /// Where the results go [default: the first DIR]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print nothing but errors and notes
    #[arg(long)]
    pub(crate) quiet: bool,
}
