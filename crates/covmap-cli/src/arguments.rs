//! What can be typed.

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
pub(crate) use files::{Beside, Log, Model, Truth};
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
  0    explored: no cell is open (explore); done (the others)
  2    bad input: an argument or a file, or something that cannot be written
  3    the budget of scans is spent (--max-scans)
  4    the robot could not leave its start, was boxed in, heard no echo at all, or failed
  130  interrupted with Ctrl-C; what there was is written all the same
  141  nobody read on what was printed";

const EXPLORE_EXAMPLES: &str = "\
The folder that is written:
  summary.json              the numbers of the run
  trace.jsonl               every scan and every decision, a line each
  belief.bin                the whole posterior of every cell
  map.pgm, map.yaml         the map for ROS map_server: free where that is certain
  coverage.png              the most likely coverage, with the path
  entropy.png               what is left uncertain
  truth.png                 the exact coverage of every cell
  occupancy.png             the log-odds occupancy grid of the same scans
  partial.png, .svg         truth, coverage and occupancy where walls cut through cells
  certificate.png, .csv     why there is nothing left to do, cell by cell
  reliability.svg, .png     whether the map knows how right it is
It is DIR.partial while it is being written, with a valid trace at any time. The same run
replaces its own DIR; that of another run is replaced with --force only, and any other never.

Examples:
  cargo xtask explore scenarios/office.ron
  cargo xtask explore scenarios/lab.ron --strategy IG --resolution 0.2 --seed 7
  cargo xtask explore building.yaml --config configs/sonar8.ron --start 12.5,-3,90
  cargo xtask explore scenarios/hall.ron --while-driving 0.5 --max-scans 200 --out out/hall
";

const EXPLAIN_EXAMPLES: &str = "\
The trace is replayed up to the decision; then the gains of all candidates are computed. The
five best are printed with both terms of Eq. (16), and DIR/explain-N.png shows E[I] over all
candidates, the five best, and the way to the one that was chosen.

Example:
  cargo xtask explain out/office-IG_CL-0.1-1 --step 12
";

const MAP_EXAMPLES: &str = "\
LOG is one of
  a text log of CARMEN, plain or packed with gzip: PARAM, ODOM, SONAR, FLASER, ROBOTLASER1
  a folder with od.txt (t x y theta: ms, mm, mm, 1/10 degree), sonar.txt (t s0 s1 ...: ms,
  mm) and laser.txt (t r0 ... r360: ms, mm, from -90 degrees in steps of 1/2)
The geometry of the sensors is the log's, where it has one; the configuration's ring is taken
for sonar.txt, and for what SONAR does not say, the shortest and longest range. A laser is a
ring of lines. Where the sensors do not look straight out from the robot's centre, sectors
become cones.

Frames that are damaged are skipped and counted; the last lines of the report say how many and
why. The poses are taken as they are: odometry drifts, --poses corrects it. Where they jump by
more than 1 m, nothing is known of the way.

The folder that is written, as by `explore`:
  summary.json              the numbers of the map
  belief.bin                the whole posterior of every cell
  map.pgm, map.yaml         the map for ROS map_server: free where that is certain
  coverage.png              the most likely coverage, with the path
  entropy.png               what is left uncertain
  occupancy.png             the log-odds occupancy grid of the same scans

Examples:
  cargo xtask map corridor.log.gz
  cargo xtask map sonar8/test1 --poses sonar8/test1_poses_corrected.txt
  cargo xtask map sonar8/test1 --sensor laser --resolution 0.05 --out out/laser
  cargo xtask map corridor.log.gz --config out/fit/config.ron --read-out out/fit/read_out.ron

Exit codes: 0 done; 2 bad input, or a folder that cannot be written; 130 interrupted with Ctrl-C,
with the map of what was read.
";

const SURVEY_EXAMPLES: &str = "\
The walls (each with the front that the laser saw, and a thickness), the posts, and a list of
solids that is empty: correct them by hand. A picture beside the file shows them with all echoes:
walls red on black, posts orange, what nothing explains and is therefore not scored pink, what no
laser saw blue.

Example:
  cargo xtask survey robot/test1 --poses robot/test1_poses.txt --out truth.ron
";

const COMPARE_EXAMPLES: &str = "\
FIT.ron is a file for `fit`. Every method is tuned on `training` with `evaluations` maps, once for its
own posteriors and once for a calibration table, and checked on `held_out`; then the other way
round. The methods: coverage maps by the update of the configuration with all of `axes` fitted, read
with a prior, and unfitted; by the other update with all its parameters fitted; by Eq. (9) with γ and
σ fitted; log-odds occupancy; Beta counting; a forward model on the same histograms (CRM); two constants.
Intervals come from resampling blocks of the trajectories.

The folder that is written: compare.csv, and compare.json with the tuned parameters.

Example:
  cargo xtask compare configs/fit/b21r.ron --out out/compare
";

const FIT_EXAMPLES: &str = "\
FIT.ron names a configuration, examples to fit to, examples held out, and the free parameters
with their bounds; see configs/fit/*.ron. The robot explores each example's world with the given
configuration, to its certificate or for so many scans; what it measured and touched, and the exact
coverage of the cells that it measured, is the example. The search maximises the mean log-likelihood
of these coverages; then a read-out is fitted to the maps that come out.

The folder that is written:
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
      also writes config.ron, whose sonars are the most like those of the log
";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  covmap completions bash > ~/.local/share/bash-completion/completions/covmap
  covmap completions zsh > ~/.zfunc/_covmap
  covmap completions fish > ~/.config/fish/completions/covmap.fish
";

/// Explores unknown environments with coverage maps (Stachniss & Burgard, 2003).
///
/// A simulated robot with a ring of sonars explores a world until a certificate says of every
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
    /// What was typed for a program of this name; its help says that name in the examples, too.
    pub(crate) fn typed(name: &str) -> Result<Self, clap::Error> {
        let mut command = named(Self::command().bin_name(name), name);
        let mut matches = command.try_get_matches_from_mut(std::env::args_os())?;
        Self::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
    }
}

/// A command, and all below it, with examples of a program of this name.
fn named(command: clap::Command, name: &str) -> clap::Command {
    let own = command.get_after_help().map(|help| help.to_string().replace("cargo xtask", name));
    let command = own.into_iter().fold(command, clap::Command::after_help);
    command.mut_subcommands(|below| named(below, name))
}

/// What the program does.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Explores a world to its end, and writes the map, the pictures and the numbers.
    #[command(after_help = format!("{EXPLORE_EXAMPLES}\n{EXIT_CODES}"))]
    Explore(Explore),
    /// Says and draws why a decision of a run was taken.
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(Explain),
    /// Lays runs of `explore` side by side: a table, and accuracy over scans and metres.
    #[command(after_help = files::BESIDE_EXAMPLES)]
    Beside(Beside),
    /// Makes the map of what a real robot recorded.
    #[command(after_help = MAP_EXAMPLES)]
    Map(Map),
    /// Writes the scans of a run as a log of CARMEN.
    #[command(after_help = files::LOG_EXAMPLES)]
    Log(Log),
    /// Writes the exact coverage of every cell of a world.
    #[command(after_help = files::TRUTH_EXAMPLES)]
    Truth(Truth),
    /// Writes what the sensor model makes of one echo: the numbers of Fig. 3.
    #[command(after_help = files::MODEL_EXAMPLES)]
    Model(Model),
    /// Fits the sensor model to the truth by local search, and writes a configuration.
    #[command(after_help = FIT_EXAMPLES)]
    Fit(Fit),
    /// Compares coverage maps with other methods, tuned alike, on truth that they were not fitted to.
    #[command(after_help = COMPARE_EXAMPLES)]
    Compare(Fit),
    /// Finds the walls of a building in the laser scans of a log: the truth to score maps with.
    #[command(after_help = SURVEY_EXAMPLES)]
    Survey(Survey),
    /// Compares the readings of simulated sonars with those of a real robot, and fits them.
    #[command(after_help = READINGS_EXAMPLES)]
    Readings(Readings),
    /// Runs worlds × settings × strategies × starts × seeds, and goes on where it was stopped.
    #[command(after_help = campaigns::CAMPAIGN_EXAMPLES)]
    Campaign(Campaign),
    /// Merges the folders of a campaign that several machines ran.
    #[command(after_help = campaigns::COLLECT_EXAMPLES)]
    Collect(Collect),
    /// Writes the completions of a shell, to be sourced by it.
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions(Completions),
}

/// What can be typed for `completions`.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

/// What can be typed for `explore`.
#[derive(Debug, Args)]
pub struct Explore {
    /// A scenario (.ron), or a map of ROS map_server (.yaml with its .pgm or .png)
    pub(crate) world: PathBuf,
    /// Robot, sonar, sensor model and planner [default: configs/b21r.ron, built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// How view-points are chosen: CL, IG, IG_WIN:R (radius in metres), IG_CL:A (weight of the
    /// gain), COUNT:N (scans), COUNT:N:D0 (metres) [default: as the configuration says,
    /// IG_CL:0.1]
    #[arg(long, value_name = "NAME")]
    pub(crate) strategy: Option<Strategy>,
    /// How much is measured before a cell is known well enough [default: as the configuration says,
    /// standard]
    #[arg(long, value_name = "EFFORT")]
    pub(crate) effort: Option<EffortName>,
    #[command(flatten)]
    pub(crate) settings: Settings,
    /// Seed of the noise
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Side of a cell in metres [default: as the configuration says, 0.1]
    #[arg(long, value_name = "M", value_parser = resolution)]
    pub(crate) resolution: Option<f64>,
    /// Measure also on the way, at this distance in metres [default: at view-points only]
    #[arg(long, value_name = "M", value_parser = while_driving)]
    pub(crate) while_driving: Option<f64>,
    /// End after this number of scans [default: no limit]
    #[arg(long, value_name = "N")]
    pub(crate) max_scans: Option<NonZeroUsize>,
    /// Where the robot starts: metres, metres, and degrees counter-clockwise from the x axis
    /// [default: where the scenario says, or in the roomiest place]
    #[arg(long, value_name = "X,Y,DEG", value_parser = start, allow_hyphen_values = true)]
    pub(crate) start: Option<Isometry2<f64>>,
    /// The widest vector registers that are used, to compare: all give the same bits [default:
    /// the fastest of this machine]
    #[arg(long, value_name = "KIND")]
    pub(crate) registers: Option<WidestRegisters>,
    #[command(flatten)]
    pub(crate) read_out: ReadOutFile,
    #[command(flatten)]
    pub(crate) safe_map: SafeMap,
    /// Where the results go [default: out/WORLD-STRATEGY-SEED, and
    /// what else was typed, as in out/lab-IG-1-r0.2]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// The widest vector registers that are used.
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

/// What can be typed for `explain`.
#[derive(Debug, Args)]
pub struct Explain {
    /// The folder that `explore` wrote (or the DIR.partial that it is writing)
    pub(crate) dir: PathBuf,
    /// The number of the decision, counted from 0 as in the trace
    #[arg(long, value_name = "N", required_unless_present = "cell")]
    pub(crate) step: Option<usize>,
    /// Tell instead what became of the cell at this place, in metres, and what one more scan could change
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true, conflicts_with = "step")]
    pub(crate) cell: Option<Point2<f64>>,
    #[command(flatten)]
    pub(crate) force: Force,
}

/// Which sensors of a log are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SensorName {
    Sonar,
    Laser,
}

/// What can be typed for `map`.
#[derive(Debug, Args)]
pub struct Map {
    /// A CARMEN log, or a folder with od.txt, sonar.txt and laser.txt
    pub(crate) log: PathBuf,
    /// Resolution, robot and sensor model [default: configs/laser.ron for a laser,
    /// configs/sonar8.ron for the sonars of a folder, configs/b21r.ron for those of a CARMEN
    /// log; all are built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// Poses instead of the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    /// Which sensors make the map
    #[arg(long, value_enum, default_value = "sonar")]
    pub(crate) sensor: SensorName,
    /// Side of a cell in metres [default: as the configuration says, 0.1]
    #[arg(long, value_name = "M", value_parser = resolution)]
    pub(crate) resolution: Option<f64>,
    #[command(flatten)]
    pub(crate) settings: Settings,
    /// A frame is used if the robot moved this far since the last one used, or turned:
    /// standing still is no evidence. 0 uses every frame
    #[arg(long, value_name = "M", value_parser = every, default_value = "0.05")]
    pub(crate) every: f64,
    /// ... or turned by this angle in degrees
    #[arg(long, value_name = "DEG", value_parser = every_degrees, default_value = "5")]
    pub(crate) every_degrees: f64,
    #[command(flatten)]
    pub(crate) read_out: ReadOutFile,
    #[command(flatten)]
    pub(crate) safe_map: SafeMap,
    /// Where the results go [default: out/LOG-SENSOR, and what else was
    /// typed, as in out/test1-laser-r0.05]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What can be typed for `fit`.
#[derive(Debug, Args)]
pub struct Fit {
    /// What is fitted to what (.ron)
    #[arg(value_name = "FIT.ron")]
    pub(crate) file: PathBuf,
    /// Where the results go
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What can be typed for `survey`.
#[derive(Debug, Args)]
pub struct Survey {
    /// A CARMEN log, or a folder with od.txt and laser.txt
    pub(crate) log: PathBuf,
    /// Poses instead of the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    /// The file that is written; the picture has its name with .png
    #[arg(long, value_name = "FILE.ron")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What can be typed for `readings`.
#[derive(Debug, Args)]
pub struct Readings {
    /// A CARMEN log, or a folder with od.txt, sonar.txt and laser.txt
    pub(crate) log: PathBuf,
    /// The survey of the place where the log was recorded, from `cargo xtask survey`
    #[arg(long, value_name = "FILE.ron")]
    pub(crate) truth: PathBuf,
    /// Poses instead of the log's: lines `t_ms x_m y_m theta_rad` in the order of time
    #[arg(long, value_name = "FILE")]
    pub(crate) poses: Option<PathBuf>,
    /// Robot and physics of the sonars [default: configs/sonar8.ron, built in]
    #[arg(long, value_name = "FILE")]
    pub(crate) config: Option<PathBuf>,
    /// Fit the physics by a local search with this number of evaluations; 0 compares only
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) fit: usize,
    /// A frame is used if the robot moved this far since the last one used, or turned
    #[arg(long, value_name = "M", value_parser = every, default_value = "0.05")]
    pub(crate) every: f64,
    /// ... or turned by this angle in degrees
    #[arg(long, value_name = "DEG", value_parser = every_degrees, default_value = "5")]
    pub(crate) every_degrees: f64,
    /// Where the results go
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) force: Force,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}
