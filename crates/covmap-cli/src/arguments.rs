//! The arguments of the program.

mod campaigns;
mod effort;
mod files;
mod memory;
mod read_out;
mod safe_map;
mod settings;
mod values;

pub(crate) use campaigns::{Campaign, Collect};
pub use files::Force;
pub(crate) use files::{Bag, BagParts, Beside, Log, Model, Truth};
pub(crate) use read_out::ReadOutFile;
pub(crate) use safe_map::SafeMap;
pub(crate) use settings::Settings;
pub use values::named_file;

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use covmap_campaign::VERSION;
use covmap_model::Registers;
use covmap_plan::Strategy;
use effort::EffortName;
use nalgebra::{Isometry2, Point2};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use values::{every, every_degrees, place, resolution, start, while_driving};

const EXIT_CODES: &str = "\
Exit codes:
  0    explored: no cell is open (explore); done (all other commands)
  2    bad input: an argument or a file, or something that cannot be written
  3    the budget of scans is spent (--max-scans)
  4    the robot could not leave its start, was boxed in, heard no echo at all, or failed
  130  interrupted with Ctrl-C; what there was is written all the same
  141  the reader of the output closed it early, as `head` does";

const EXPLORE_EXAMPLES: &str = "\
The output folder DIR holds
  summary.json              the numbers of the run
  trace.jsonl               every scan, decision and bump, a line each
  belief.bin                the whole posterior of every cell
  map.pgm, map.yaml         the map for ROS map_server; free cells are certain
  coverage.png              the most likely coverage, with the path
  entropy.png               what is left uncertain
  truth.png                 the exact coverage of every cell
  errors.png                the map against the truth: missed walls, phantoms and bumps
  occupancy.png             the log-odds occupancy grid of the same scans
  partial.png, .svg         truth, coverage and occupancy where walls cut through cells
  certificate.png, .csv     why there is nothing left to do, cell by cell
  reliability.svg, .png     whether the map knows how right it is
While a run writes, the folder is DIR.partial, with a valid trace at any time. A run replaces its
own DIR. It replaces the DIR of another run only with --force, and any other folder never.

Examples:
  cargo xtask explore scenarios/office.ron
  cargo xtask explore scenarios/lab.ron --strategy IG --resolution 0.2 --seed 7
  cargo xtask explore building.yaml --config configs/sonar8.ron --start 12.5,-3,90
  cargo xtask explore scenarios/hall.ron --while-driving 0.5 --max-scans 200 --out out/hall
";

const EXPLAIN_EXAMPLES: &str = "\
The command replays the trace up to the decision, and computes the gains of all candidates. It
prints the five best with both terms of Eq. (16). DIR/explain-N.png shows E[I] over all
candidates, the five best, and the way to the chosen one.

Example:
  cargo xtask explain out/office-IG_CL-0.1-1 --step 12
";

const MAP_EXAMPLES: &str = "\
LOG is one of
  a bag of ROS 2, FILE.mcap: sensor_msgs/Range, or LaserScan with --sensor laser; the places of
  the sensors and of the robot from /tf and /tf_static, or from nav_msgs/Odometry
  a CARMEN text log, plain or packed with gzip: PARAM, ODOM, SONAR, FLASER, ROBOTLASER1
  a folder with od.txt (t x y theta: ms, mm, mm, 1/10 degree), sonar.txt (t s0 s1 ...: ms,
  mm) and laser.txt (t r0 ... r360: ms, mm, from -90 degrees in steps of 1/2)
The sensor geometry of the log takes precedence. The configuration's ring serves sonar.txt, and
gives the shortest and longest ranges of SONAR if the log does not state them. A laser is a ring
of lines. If the sensors do not point straight out from the robot's centre, sectors become cones.

Damaged frames are skipped; the last lines of the report give their number and the reasons. The
poses are used as they are: odometry drifts, and --poses corrects it. If a step is longer than 1 m
and the robot cannot have driven it, its way stays unknown.

The output folder, like that of `explore`, holds
  summary.json              the numbers of the map
  readings.csv              the number of readings of each kind, for every sensor
  belief.bin                the whole posterior of every cell
  map.pgm, map.yaml         the map for ROS map_server; free cells are certain
  coverage.png              the most likely coverage, with the path
  entropy.png               what is left uncertain
  occupancy.png             the log-odds occupancy grid of the same scans

Examples:
  cargo xtask map corridor.log.gz
  cargo xtask map drive.mcap --topic /scan --sensor laser --base-frame base_footprint
  cargo xtask map sonar8/test1 --poses sonar8/test1_poses_corrected.txt
  cargo xtask map sonar8/test1 --sensor laser --resolution 0.05 --out out/laser
  cargo xtask map corridor.log.gz --config out/fit/config.ron --read-out out/fit/read_out.ron

Exit codes: 0 done; 2 bad input, or a folder that cannot be written; 130 interrupted with Ctrl-C,
with the map of the frames up to then.
";

const BAG_EXAMPLES: &str = "\
Example:
  cargo xtask bag drive.mcap
";

const SURVEY_EXAMPLES: &str = "\
The survey has the walls (each with the front that the laser saw, and a thickness), the posts, and
an empty list of solids; correct it by hand. A picture beside the file shows the survey with all
echoes: walls red on black, posts orange, cells with unexplained echoes pink (these are not
scored), cells that no laser saw blue.

Example:
  cargo xtask survey robot/test1 --poses robot/test1_poses.txt --out truth.ron
";

const COMPARE_EXAMPLES: &str = "\
FIT.ron is a file for `fit`. The command tunes every method on `training` with `evaluations` maps,
once for the method's own posteriors and once for a calibration table, and checks the method on
`held_out`; then it swaps the two sets. The methods are
  coverage maps by the update of the configuration: with all of `axes` fitted, read with a prior,
      and unfitted; by the other update with all its parameters fitted; by Eq. (9) with γ and σ
      fitted
  log-odds occupancy, Beta counting, and a forward model on the same histograms (CRM)
  two constants
Intervals come from resampling blocks of the trajectories.

The output folder holds compare.csv, and compare.json with the tuned parameters.

Example:
  cargo xtask compare configs/fit/b21r.ron --out out/compare
";

const FIT_EXAMPLES: &str = "\
FIT.ron names a configuration, training examples, held-out examples, and the free parameters with
their bounds; see configs/fit/*.ron. The robot explores the world of each example, to its
certificate or for a given number of scans. The example is the robot's scans and contacts, and the
exact coverage of the measured cells. The search maximises the mean log-likelihood of these
coverages; then the command fits a read-out to the resulting maps.

The output folder holds
  config.ron     the fitted configuration, for `explore --config`
  read_out.ron   the calibrated reading of its maps, for `explore --read-out` and `map --read-out`
  fit.json       every evaluation, the profiles, and the scores before and after
  search.svg, profiles.svg, reliability.svg, and each as .png

Example:
  cargo xtask fit configs/fit/b21r.ron --out out/fit
";

const READINGS_EXAMPLES: &str = "\
Examples:
  cargo xtask survey LOG --out out/truth.ron
  cargo xtask readings LOG --truth out/truth.ron --out out/readings
  cargo xtask readings LOG --truth out/truth.ron --fit 300 --out out/fitted
      also writes config.ron, with the sonars fitted to those of the log
";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  covmap completions bash > ~/.local/share/bash-completion/completions/covmap
  covmap completions zsh > ~/.zfunc/_covmap
  covmap completions fish > ~/.config/fish/completions/covmap.fish
";

/// Explores unknown environments with coverage maps (Stachniss & Burgard, 2003).
///
/// A simulated robot with a ring of sonars explores a world, until a certificate states for every
/// cell why there is nothing left to do.
#[derive(Debug, Parser)]
#[command(name = "covmap", version = VERSION, after_help = EXIT_CODES)]
pub(crate) struct Arguments<C: Subcommand> {
    #[command(subcommand)]
    pub(crate) command: C,
    #[command(flatten)]
    pub(crate) memory: memory::Memory,
}

impl<C: Subcommand> Arguments<C> {
    /// Parses the arguments for a program of this name; the examples in its help use that name,
    /// too.
    pub(crate) fn typed(name: &str) -> Result<Self, clap::Error> {
        let mut command = named(Self::command().bin_name(name), name);
        let mut matches = command.try_get_matches_from_mut(std::env::args_os())?;
        Self::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
    }
}

/// Returns a command, and all commands below it, with examples for a program of this name.
fn named(command: clap::Command, name: &str) -> clap::Command {
    let own = command.get_after_help().map(|help| help.to_string().replace("cargo xtask", name));
    let command = own.into_iter().fold(command, clap::Command::after_help);
    command.mut_subcommands(|below| named(below, name))
}

/// The commands of the program.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Explores a world to its end, and writes the map, the pictures and the numbers.
    #[command(after_help = format!("{EXPLORE_EXAMPLES}\n{EXIT_CODES}"))]
    Explore(Explore),
    /// Explains a decision of a run, in words and as a picture.
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(Explain),
    /// Compares runs of `explore` side by side: a table, and accuracy over scans and metres.
    #[command(after_help = files::BESIDE_EXAMPLES)]
    Beside(Beside),
    /// Builds a map from the log of a real robot.
    #[command(after_help = MAP_EXAMPLES)]
    Map(Map),
    /// Writes a run as a CARMEN log, or a run or a log as a bag of ROS 2.
    #[command(after_help = files::LOG_EXAMPLES)]
    Log(Log),
    /// Lists the topics, frames and numbers of messages of a bag of ROS 2.
    #[command(after_help = BAG_EXAMPLES)]
    Bag(Bag),
    /// Writes the exact coverage of every cell of a world.
    #[command(after_help = files::TRUTH_EXAMPLES)]
    Truth(Truth),
    /// Writes the answer of the sensor model to one echo: the numbers of Fig. 3.
    #[command(after_help = files::MODEL_EXAMPLES)]
    Model(Model),
    /// Fits the sensor model to the truth by local search, and writes a configuration.
    #[command(after_help = FIT_EXAMPLES)]
    Fit(Fit),
    /// Compares coverage maps with other methods, tuned alike, on truth held out from the tuning.
    #[command(after_help = COMPARE_EXAMPLES)]
    Compare(Fit),
    /// Finds the walls of a building in the laser scans of a log: the truth for scoring maps.
    #[command(after_help = SURVEY_EXAMPLES)]
    Survey(Survey),
    /// Compares the readings of simulated sonars with those of a real robot, and fits them.
    #[command(after_help = READINGS_EXAMPLES)]
    Readings(Readings),
    /// Runs worlds × settings × strategies × starts × seeds, and resumes where it was stopped.
    #[command(after_help = campaigns::CAMPAIGN_EXAMPLES)]
    Campaign(Campaign),
    /// Merges the folders of a campaign that several machines ran.
    #[command(after_help = campaigns::COLLECT_EXAMPLES)]
    Collect(Collect),
    /// Writes completions for a shell to source.
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions(Completions),
}

/// The arguments of `completions`.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

/// The arguments of `explore`.
#[derive(Debug, Args)]
pub struct Explore {
    /// A scenario (.ron), or a map of ROS map_server (.yaml with its .pgm or .png)
    pub(crate) world: PathBuf,
    /// Configuration of robot, sonar, sensor model and planner [default: configs/b21r.ron, built
    /// in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// Strategy that chooses view-points: CL, IG, IG_WIN:R (radius in metres), IG_CL:A (weight of
    /// the gain), COUNT:N (scans), COUNT:N:D0 (metres) [default: from the configuration, IG_CL:0.1]
    #[arg(long, value_name = "NAME")]
    pub(crate) strategy: Option<Strategy>,
    /// Effort of measuring before a cell counts as known [default: from the configuration,
    /// standard]
    #[arg(long, value_name = "EFFORT")]
    pub(crate) effort: Option<EffortName>,
    #[command(flatten)]
    pub(crate) settings: Settings,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Side of a cell in metres [default: from the configuration, 0.1]
    #[arg(long, value_name = "M", value_parser = resolution)]
    pub(crate) resolution: Option<f64>,
    /// Also measure on the way, at intervals of M metres [default: at view-points only]
    #[arg(long, value_name = "M", value_parser = while_driving)]
    pub(crate) while_driving: Option<f64>,
    /// Stop after this number of scans [default: no limit]
    #[arg(long, value_name = "N")]
    pub(crate) max_scans: Option<NonZeroUsize>,
    /// Start of the robot: x and y in metres, and the heading in degrees, counter-clockwise from
    /// the x axis [default: from the scenario, or the roomiest place]
    #[arg(long, value_name = "X,Y,DEG", value_parser = start, allow_hyphen_values = true)]
    pub(crate) start: Option<Isometry2<f64>>,
    /// Widest vector registers to use, for comparison: all give the same bits [default: the fastest
    /// of this machine]
    #[arg(long, value_name = "KIND")]
    pub(crate) registers: Option<WidestRegisters>,
    #[command(flatten)]
    pub(crate) read_out: ReadOutFile,
    #[command(flatten)]
    pub(crate) safe_map: SafeMap,
    /// Folder for the results [default: out/WORLD-STRATEGY-SEED, followed by all other settings, as
    /// in out/lab-IG-1-r0.2]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The widest vector registers to use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum WidestRegisters {
    Scalar,
    Avx2,
    Avx512,
}

impl WidestRegisters {
    pub(crate) fn limit(self) {
        let registers = match self {
            Self::Scalar => Registers::Scalar,
            Self::Avx2 => Registers::Avx2,
            Self::Avx512 => Registers::Avx512,
        };
        registers.limit();
    }
}

/// The arguments of `explain`.
#[derive(Debug, Args)]
pub struct Explain {
    /// Folder of a run of `explore` (or DIR.partial, while the run writes it)
    pub(crate) dir: PathBuf,
    /// Number of the decision, counted from 0 as in the trace
    #[arg(long, value_name = "N", required_unless_present = "cell")]
    pub(crate) step: Option<usize>,
    /// Explain the cell at this place instead, in metres: its state, and the change to expect from
    /// one more scan
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true, conflicts_with = "step")]
    pub(crate) cell: Option<Point2<f64>>,
    #[command(flatten)]
    pub(crate) force: Force,
}

/// The kind of sensors that are read from a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SensorName {
    Sonar,
    Laser,
}

/// The arguments of `map`.
#[derive(Debug, Args)]
pub struct Map {
    /// A CARMEN log, or a folder with od.txt, sonar.txt and laser.txt
    pub(crate) log: PathBuf,
    /// Configuration of resolution, robot and sensor model [default: configs/laser.ron for a laser,
    /// configs/sonar8.ron for the sonars of a folder, configs/b21r.ron for those of a CARMEN log;
    /// all are built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// File of poses that replace the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    /// Kind of sensors that make the map
    #[arg(long, value_enum, default_value = "sonar")]
    pub(crate) sensor: SensorName,
    /// Side of a cell in metres [default: from the configuration, 0.1]
    #[arg(long, value_name = "M", value_parser = resolution)]
    pub(crate) resolution: Option<f64>,
    #[command(flatten)]
    pub(crate) settings: Settings,
    /// Use a frame if the robot moved this far since the last frame used, or turned: standing still
    /// is no evidence. 0 uses every frame
    #[arg(long, value_name = "M", value_parser = every, default_value = "0.05")]
    pub(crate) every: f64,
    /// ... or turned by this angle in degrees
    #[arg(long, value_name = "DEG", value_parser = every_degrees, default_value = "5")]
    pub(crate) every_degrees: f64,
    #[command(flatten)]
    pub(crate) bag: BagParts,
    #[command(flatten)]
    pub(crate) read_out: ReadOutFile,
    #[command(flatten)]
    pub(crate) safe_map: SafeMap,
    /// Folder for the results [default: out/LOG-SENSOR, followed by all other settings, as in
    /// out/test1-laser-r0.05]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The arguments of `fit` and `compare`.
#[derive(Debug, Args)]
pub struct Fit {
    /// File that defines the fit (.ron)
    #[arg(value_name = "FIT.ron")]
    pub(crate) file: PathBuf,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The arguments of `survey`.
#[derive(Debug, Args)]
pub struct Survey {
    /// A CARMEN log, or a folder with od.txt and laser.txt
    pub(crate) log: PathBuf,
    /// File of poses that replace the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    /// File for the survey; its picture has the same name with .png
    #[arg(long, value_name = "FILE.ron")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The arguments of `readings`.
#[derive(Debug, Args)]
pub struct Readings {
    /// A CARMEN log, or a folder with od.txt, sonar.txt and laser.txt
    pub(crate) log: PathBuf,
    /// Survey of the place where the log was recorded, made by the command `survey`
    #[arg(long, value_name = "FILE.ron")]
    pub(crate) truth: PathBuf,
    /// File of poses that replace the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    /// Configuration of the robot and of the physics of its sonars [default: configs/sonar8.ron,
    /// built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// Fit the physics by a local search with this number of evaluations; 0 only compares
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) fit: usize,
    /// Use a frame if the robot moved this far since the last frame used, or turned
    #[arg(long, value_name = "M", value_parser = every, default_value = "0.05")]
    pub(crate) every: f64,
    /// ... or turned by this angle in degrees
    #[arg(long, value_name = "DEG", value_parser = every_degrees, default_value = "5")]
    pub(crate) every_degrees: f64,
    /// Folder for the results
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print only errors
    #[arg(long)]
    pub(crate) quiet: bool,
}
