//! Errors of the laboratory and its files.

use crate::{ConfigError, OverrideError, SetupError};
use covmap::{GridError, MapError, ReadOutError};
use covmap_explore::{MissionError, ParameterError};
use covmap_fit::{AxisError, FitError};
use covmap_io::{FileError, MapServerError, shown};
use covmap_log::{BagWriterError, LogError};
use covmap_model::ModelError;
use covmap_plan::{PlannerError, StrategyError};
use covmap_sonar::RingError;
use covmap_survey::SurveyError;
use covmap_world::WorldError;
use std::path::{Path, PathBuf};

/// Error of the laboratory, in one sentence that names the file if there is one.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A map of map_server cannot be read or written.
    #[error(transparent)]
    MapServer(#[from] MapServerError),
    /// A log cannot be read.
    #[error("{error}{}", .other_sensor.map_or(String::new(), |name| format!("; try --sensor {name}")))]
    Log {
        /// The error of the log.
        error: LogError,
        /// The sensor that the log has instead.
        other_sensor: Option<&'static str>,
    },
    /// A file or its content cannot be used.
    #[error("{}: {fault}", shown(file))]
    In {
        /// The file or folder.
        file: PathBuf,
        /// The fault.
        fault: Fault,
    },
    /// A fault without a file.
    #[error(transparent)]
    Fault(#[from] Fault),
}

/// A fault, without the name of its file.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// A bag cannot be written.
    #[error(transparent)]
    Bag(#[from] BagWriterError),
    /// A configuration is invalid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The parameters of a robot.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A mission in a world.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A mission.
    #[error(transparent)]
    Mission(#[from] MissionError),
    /// A world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A sensor model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A ring of sensors.
    #[error(transparent)]
    Ring(#[from] RingError),
    /// Parameters of a planner.
    #[error(transparent)]
    Planner(#[from] PlannerError),
    /// A strategy.
    #[error(transparent)]
    Strategy(#[from] StrategyError),
    /// A grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A coverage map.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A read-out.
    #[error(transparent)]
    ReadOut(#[from] ReadOutError),
    /// A survey of a building.
    #[error(transparent)]
    Survey(#[from] SurveyError),
    /// A free parameter of a fit.
    #[error(transparent)]
    Axis(#[from] AxisError),
    /// A fit.
    #[error("the fit cannot begin: {0}")]
    Fit(#[from] FitError),
    /// A parameter that is set by its path.
    #[error("explorer_overrides: {0}")]
    Override(#[from] OverrideError),
    /// Too much memory.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// A part of a file.
    #[error("{part}: {fault}")]
    Part {
        /// Name of the part.
        part: &'static str,
        /// The fault of the part.
        fault: Box<Fault>,
    },
    /// A length is too many cells: tables of these cells would fill the memory.
    #[error(
        "{field}: {length} m are more than {most} cells of {resolution} m; use a coarser resolution"
    )]
    TooManyCells {
        /// Name of the configuration's field.
        field: &'static str,
        /// The length \[m\].
        length: f64,
        /// Largest allowed length in cells.
        most: f64,
        /// Side of a cell \[m\].
        resolution: f64,
    },
    /// No area of a map is free.
    #[error("nothing of the map is free ({0}); look at `negate` and at the thresholds")]
    NothingFree(String),
    /// The file is no world.
    #[error("{0}")]
    NoWorld(String),
    /// The log has scans of too many different rings.
    #[error("line {line}: more than {most} different sensors")]
    ManySensors {
        /// Line with the one sensor too many.
        line: usize,
        /// Largest number of sensors that are read.
        most: usize,
    },
    /// The log has no scan.
    #[error("is empty")]
    NoScans,
    /// The file was changed while it was read.
    #[error("was changed while it was read")]
    Changed,
    /// The log has more readings than are held in memory.
    #[error(
        "line {line}: more than {most} readings are not held at the same time; cut the log, or thin it out"
    )]
    ManyReadings {
        /// Line with the one reading too many.
        line: usize,
        /// Largest number of readings that are held.
        most: usize,
    },
    /// The robot's path does not fit into a grid.
    #[error("the robot was between ({:.1}, {:.1}) and ({:.1}, {:.1}): {error}", low.0, low.1, high.0, high.1)]
    Extent {
        /// Lower left corner of the robot's path \[m\].
        low: (f64, f64),
        /// Upper right corner of the robot's path \[m\].
        high: (f64, f64),
        /// The error of the grid.
        error: GridError,
    },
    /// A number is out of its range.
    #[error("{field}: {value} must lie in {low}..={high}")]
    Range {
        /// Name of the field.
        field: &'static str,
        /// Value of the field.
        value: usize,
        /// Smallest allowed value.
        low: usize,
        /// Largest allowed value.
        high: usize,
    },
    /// A field must not be negative, or not be infinite.
    #[error("{field} must be {must}")]
    Number {
        /// Names of the field or fields.
        field: &'static str,
        /// Condition that the numbers must fulfil.
        must: &'static str,
    },
    /// A map of map_server is to be turned or shifted.
    #[error("only scenarios can be turned and shifted")]
    MapMoved,
    /// A fit has nothing to fit to.
    #[error("training needs at least one entry")]
    NoTraining,
    /// The explorer of a fit has another robot than the configuration that is fitted.
    #[error(
        "explorer: {} has another robot than {}; the model is of one ring of sensors",
        shown(explorer),
        shown(config)
    )]
    OtherRobot {
        /// File of the explorer.
        explorer: PathBuf,
        /// File of the configuration that is fitted.
        config: PathBuf,
    },
    /// The folder has no trace.
    #[error("{0}")]
    NoTrace(&'static str),
    /// The trace has no decision with this number.
    #[error("there is no decision {step}: the trace has {}", decisions_in_words(*.decisions))]
    NoDecision {
        /// The decision that was asked for, counted from 0.
        step: usize,
        /// The number of decisions.
        decisions: usize,
    },
    /// The trace has no header.
    #[error("the trace is empty")]
    EmptyTrace,
    /// The trace was written by another version.
    #[error("a trace of version {found}; this covmap reads {oldest} to {newest}")]
    TraceVersion {
        /// Version of the trace.
        found: u32,
        /// Oldest version that can be read.
        oldest: u32,
        /// Newest version that can be read.
        newest: u32,
    },
    /// A scan of a trace does not fit the ring.
    #[error("scan {number} has {ranges} ranges, but the ring has {beams} sensors")]
    Ranges {
        /// Number of the scan.
        number: usize,
        /// The number of ranges of the scan.
        ranges: usize,
        /// The number of sensors of the ring.
        beams: usize,
    },
    /// The replay of a trace differs from it.
    #[error(
        "line {line}: the replay differs from here on; the trace was changed, or written by another version of covmap"
    )]
    Differs {
        /// First line that differs.
        line: usize,
    },
    /// A place is outside of the map.
    #[error("({x}, {y}) is not in the map")]
    NotInMap {
        /// x of the place \[m\].
        x: f64,
        /// y of the place \[m\].
        y: f64,
    },
    /// A file was written by another version.
    #[error("another version wrote it")]
    OtherVersion,
}

/// Error of work that would take more memory than is allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{what} would take about {} of memory, more than {}; use a coarser resolution, or allow more with --memory",
    amount(*bytes),
    amount(*limit)
)]
pub struct MemoryError {
    /// The work or the data, in words.
    pub what: String,
    /// Estimated memory \[bytes\].
    pub bytes: u64,
    /// Allowed memory \[bytes\].
    pub limit: u64,
}

/// An amount of memory in words.
fn amount(bytes: u64) -> String {
    let gib = bytes as f64 / f64::from(1 << 30);
    if gib < 1.0 { format!("{:.0} MiB", 1024.0 * gib) } else { format!("{gib:.1} GiB") }
}

fn decisions_in_words(decisions: usize) -> String {
    match decisions {
        0 => "none at all".to_owned(),
        1 => "one, number 0".to_owned(),
        _ => format!("{decisions}, numbered 0 to {}", decisions - 1),
    }
}

/// The result of work with files of the laboratory.
pub type Result<T, E = LabError> = std::result::Result<T, E>;

/// Names the file of a fault.
pub fn about<E: Into<Fault>>(file: &Path) -> impl Fn(E) -> LabError {
    move |fault| LabError::In { file: file.to_owned(), fault: fault.into() }
}

impl From<LogError> for LabError {
    fn from(error: LogError) -> Self {
        Self::Log { error, other_sensor: None }
    }
}

/// Errors of parts are errors of the laboratory, without a file.
macro_rules! of_parts {
    ($($part:ty),*) => {
        $(impl From<$part> for LabError {
            fn from(error: $part) -> Self {
                Self::Fault(error.into())
            }
        })*
    };
}
of_parts!(
    ConfigError,
    ParameterError,
    SetupError,
    MissionError,
    WorldError,
    ModelError,
    RingError,
    GridError,
    MapError,
    ReadOutError,
    SurveyError,
    MemoryError,
    FitError
);
