//! The arguments of `campaign` and `collect`.

use super::values::named_file;
use clap::Args;
use covmap_campaign::Shard;
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(super) const CAMPAIGN_EXAMPLES: &str = "\
CAMPAIGN.ron names worlds, settings, strategies, starts and seeds; every combination is a run.
docs/guide.md describes the file; configs/fig7.ron is an example.

Each run is recorded when it is done. Started again, the campaign runs only what is missing, and
repeats runs with damaged results. Ctrl-C ends the campaign; finished runs stay.

The output folder holds
  runs.csv                  a line for each run: all numbers except times
  timings.csv               a line for each run: times
  summary.csv               mean, standard deviation, 95 % interval of the mean, n, n cut short
  campaign.json, runs/      the list of the runs, and a file for each finished run
While runs are missing, the names of the tables state it: runs-8-of-12.csv.

Examples:
  cargo xtask campaign configs/fig7.ron
  cargo xtask campaign configs/fig7.ron --shard 2/3 --out out/fig7-2

Exit codes: 0 done; 2 bad input, or a result that cannot be written; 130 interrupted with Ctrl-C.
";

pub(super) const COLLECT_EXAMPLES: &str = "\
All folders must come from one campaign and one version of covmap. The tables are the same as if
one machine had run everything.

Example:
  cargo xtask collect out/fig7-1 out/fig7-2 out/fig7-3 --out out/fig7
";

/// The arguments of `campaign`.
#[derive(Debug, Args)]
pub struct Campaign {
    /// Campaign to run (.ron)
    #[arg(value_name = "CAMPAIGN.ron")]
    pub(crate) file: PathBuf,
    /// Number of runs at the same time [default: one for each core]
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// Take the world called NAME from this file instead of the campaign's
    #[arg(long = "world", value_name = "NAME=FILE", value_parser = named_file)]
    pub(crate) worlds: Vec<(String, PathBuf)>,
    /// Only check the campaign, and print its number of runs
    #[arg(long)]
    pub(crate) check: bool,
    /// Only every N-th run, starting with the I-th
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub(crate) shard: Shard,
    /// Folder for the results [default: out/CAMPAIGN]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print only errors and notes
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The arguments of `collect`.
#[derive(Debug, Args)]
pub struct Collect {
    /// Folders that `campaign` wrote
    #[arg(value_name = "DIR", required = true)]
    pub(crate) dirs: Vec<PathBuf>,
    /// Folder for the results [default: the first DIR]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print only errors and notes
    #[arg(long)]
    pub(crate) quiet: bool,
}
