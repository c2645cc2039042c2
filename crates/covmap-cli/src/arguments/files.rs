//! What can be typed for the commands that write one file.

use super::values::{range, resolution};
use clap::Args;
use covmap_io::Replace;
use std::path::PathBuf;

pub(super) const LOG_EXAMPLES: &str = "\
Each scan of the trace becomes a line ODOM and a line SONAR of the same time; no echo is the
longest range, a missing reading 0. Read back, the log gives the same scans.

Example:
  cargo xtask log out/lab-IG_CL-0.1-1 --out lab.log
";

pub(super) const TRUTH_EXAMPLES: &str = "\
Columns: x, y (the centre of the cell, in metres), coverage (in [0, 1], exact). Row by row from
the lower left, on the grid that `explore` uses, with its margin around the world.

Example:
  cargo xtask truth scenarios/office.ron --resolution 0.05 --out truth.csv
";

pub(super) const MODEL_EXAMPLES: &str = "\
Columns: cell_distance (from the sensor, in metres), coverage (of each bin), probability (that
the cell has it, Eq. 9). From r/2 to the last cell that an echo updates, in steps of r/10.

Example:
  cargo xtask model --range 1.0 --out model.csv
";

pub(super) const BESIDE_EXAMPLES: &str = "\
The folder that is written: runs.csv, with a line for each run, runs.svg and runs.png. The class mean
is that of the log-likelihoods of free cells, partly covered ones, and the first layer of solid ones;
runs of one strategy are joined by a line.

Example:
  cargo xtask explore scenarios/lab.ron --effort quick
  cargo xtask explore scenarios/lab.ron --effort thorough
  cargo xtask beside out/lab-*-quick out/lab-*-thorough
";

/// Whether results may be replaced that are not the same.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Force {
    /// Replace what is there: a file that holds something else, a folder of another run of covmap
    #[arg(long)]
    force: bool,
}

impl Force {
    /// What may be replaced.
    pub fn replace(self) -> Replace {
        Replace::if_forced(self.force)
    }
}

/// What can be typed for `beside`.
#[derive(Debug, Args)]
pub struct Beside {
    /// Folders that `explore` wrote
    #[arg(value_name = "RUN", required = true)]
    pub(crate) runs: Vec<PathBuf>,
    /// Where the results go
    #[arg(long, value_name = "DIR", default_value = "out/beside")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What can be typed for `log`.
#[derive(Debug, Args)]
pub struct Log {
    /// The folder that `explore` wrote (or the DIR.partial that it is writing)
    pub(crate) dir: PathBuf,
    /// The log that is written
    #[arg(long, value_name = "FILE.log")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}

/// What can be typed for `truth`.
#[derive(Debug, Args)]
pub struct Truth {
    /// A scenario (.ron), or a map of ROS map_server (.yaml with its .pgm or .png)
    pub(crate) world: PathBuf,
    /// Side of a cell in metres
    #[arg(long, value_name = "M", value_parser = resolution, default_value = "0.1")]
    pub(crate) resolution: f64,
    /// The table that is written
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}

/// What can be typed for `model`.
#[derive(Debug, Args)]
pub struct Model {
    /// Robot, sonar, sensor model and planner [default: configs/b21r.ron, built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// The range d of the echo in metres, up to the usable range of the model
    #[arg(long, value_name = "M", value_parser = range)]
    pub(crate) range: f64,
    /// The table that is written
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}
