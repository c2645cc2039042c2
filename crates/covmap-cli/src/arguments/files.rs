//! The arguments of the commands that write files.

use super::values::{range, resolution};
use clap::Args;
use covmap_io::Replace;
use covmap_log::BagOptions;
use std::path::PathBuf;

pub(super) const LOG_EXAMPLES: &str = "\
Each scan of the trace becomes a line ODOM and a line SONAR of the same time. No echo is written as
the longest range, and a missing reading as 0. Read back, the log gives the same scans.

A bag, FILE.mcap, has for each sonar a topic with sensor_msgs/Range, /tf, /tf_static and /odom; of a
run also /map, /entropy, /certificate, /path and /candidates, with the reason of each decision.
FILE.foxglove.json beside it is a layout for Foxglove. Read back, a bag gives the same scans, in
single precision.

Examples:
  cargo xtask log out/lab-IG_CL-0.1-1 --out lab.log
  cargo xtask log out/lab-IG_CL-0.1-1 --out lab.mcap
  cargo xtask log sonar8/test1 --poses sonar8/test1_poses_corrected.txt --out test1.mcap
";

pub(super) const TRUTH_EXAMPLES: &str = "\
Columns: x, y (centre of the cell, in metres), coverage (exact, in [0, 1]). The cells come row by
row from the lower left, on the grid of `explore`, with its margin around the world.

Example:
  cargo xtask truth scenarios/office.ron --resolution 0.05 --out truth.csv
";

pub(super) const MODEL_EXAMPLES: &str = "\
Columns: cell_distance (from the sensor, in metres), coverage (of each bin), probability (that the
cell has this coverage). The distances run in steps of r/10 from r/2 to 0.2 m behind the end cell, or
to the last cell that the echo updates.

Example:
  cargo xtask model --range 1.0 --out model.csv
";

pub(super) const BESIDE_EXAMPLES: &str = "\
The output folder holds runs.csv, with a line for each run, runs.svg and runs.png. The class mean is
the mean of the log-likelihoods of free cells, partly covered cells, and the first layer of solid
cells. A line joins the runs of one strategy.

Example:
  cargo xtask explore scenarios/lab.ron --effort quick
  cargo xtask explore scenarios/lab.ron --effort thorough
  cargo xtask beside out/lab-*-quick out/lab-*-thorough
";

/// Whether different results may be replaced.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Force {
    /// Replace existing results: a file with other contents, or the folder of another run of covmap
    #[arg(long)]
    force: bool,
}

impl Force {
    /// Returns the permission to replace results.
    pub fn replace(self) -> Replace {
        Replace::if_forced(self.force)
    }
}

/// The arguments of `beside`.
#[derive(Debug, Args)]
pub struct Beside {
    /// Folders that `explore` wrote
    #[arg(value_name = "RUN", required = true)]
    pub(crate) runs: Vec<PathBuf>,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "out/beside")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The arguments of `log`.
#[derive(Debug, Args)]
pub struct Log {
    /// Folder of a run of `explore` (or DIR.partial, while the run writes it); or a log of sonars that
    /// becomes a bag
    pub(crate) dir: PathBuf,
    /// File for the log: FILE.mcap is a bag of ROS 2, any other name a CARMEN log
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Configuration of the sonars, of a log that does not state them [default: configs/sonar8.ron for a
    /// folder, configs/b21r.ron for a CARMEN log; both are built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// File of poses that replace the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
}

/// The arguments of `bag`.
#[derive(Debug, Args)]
pub struct Bag {
    /// A bag of ROS 2: an MCAP file
    pub(crate) bag: PathBuf,
}

/// What is read from a bag.
#[derive(Debug, Args)]
pub(crate) struct BagParts {
    /// Topics of a bag whose sensors make the map [default: all of the kind of --sensor]
    #[arg(long = "topic", value_name = "NAME")]
    topics: Vec<String>,
    /// Frame of the map, in a bag [default: `map` if the robot hangs on it, else the root of its frames]
    #[arg(long, value_name = "FRAME")]
    map_frame: Option<String>,
    /// Frame of the robot's centre, in a bag
    #[arg(long, value_name = "FRAME", default_value = "base_link")]
    base_frame: String,
}

impl BagParts {
    pub(crate) fn options(&self) -> BagOptions {
        BagOptions {
            topics: self.topics.clone(),
            map_frame: self.map_frame.clone(),
            base_frame: self.base_frame.clone(),
        }
    }
}

/// The arguments of `truth`.
#[derive(Debug, Args)]
pub struct Truth {
    /// A scenario (.ron), or a map of ROS map_server (.yaml with its .pgm or .png)
    pub(crate) world: PathBuf,
    /// Side of a cell in metres
    #[arg(long, value_name = "M", value_parser = resolution, default_value = "0.1")]
    pub(crate) resolution: f64,
    /// File for the table
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}

/// The arguments of `model`.
#[derive(Debug, Args)]
pub struct Model {
    /// Configuration of robot, sonar, sensor model and planner [default: configs/b21r.ron, built
    /// in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// Range d of the echo in metres, up to the usable range of the model
    #[arg(long, value_name = "M", value_parser = range)]
    pub(crate) range: f64,
    /// File for the table
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
}
