//! Errors of a campaign.

use crate::RunKey;
use covmap_explore::ParameterError;
use covmap_io::{FileError, shown};
use covmap_lab::{Fault, LabError, OverrideError};
use covmap_plan::StrategyError;
use std::path::{Path, PathBuf};

/// Error in a campaign or in its results, in one sentence.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A world, a configuration or a run has a fault.
    #[error(transparent)]
    Lab(#[from] LabError),
    /// The threads of a campaign cannot be made.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A record cannot be written as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// A folder is not what it should be.
    #[error("{}: {fault}", shown(dir))]
    Folder {
        /// The folder, or a file in it.
        dir: PathBuf,
        /// The fault.
        fault: FolderFault,
    },
    /// The starts in a world cannot be found.
    #[error("{}: starts: {fault}", shown(file))]
    Starts {
        /// The world's file.
        file: PathBuf,
        /// The fault.
        fault: StartsFault,
    },
    /// The command line names a world that the campaign does not have.
    #[error("--world: the campaign has no world called {0:?}")]
    NoSuchWorld(String),
    /// None of the worlds is there.
    #[error("no world of the campaign is there, so there is nothing to run")]
    NoWorld,
    /// The number of seeds is out of its interval.
    #[error("seeds: {count} are asked for; the number must lie in 1..={most}")]
    Seeds {
        /// The number of seeds.
        count: usize,
        /// Largest allowed number.
        most: usize,
    },
    /// The seeds run out.
    #[error("seeds: there are not that many after {0}")]
    LastSeed(u64),
    /// The campaign's name cannot be a folder's.
    #[error("name: {0:?} cannot be the name of a folder; leave out slashes and dots")]
    FolderName(String),
    /// A name is too long, empty, or has control characters.
    #[error("{list}: {name:?} is no name: 1 to 100 characters are needed")]
    Name {
        /// The list with the name.
        list: &'static str,
        /// The name.
        name: String,
    },
    /// A list has no entry.
    #[error("{0}: at least one is needed")]
    Empty(&'static str),
    /// A list has an entry twice.
    #[error("{list}: {entry} stands there twice")]
    Twice {
        /// The list.
        list: &'static str,
        /// The entry.
        entry: String,
    },
    /// A number of a strategy is out of its range.
    #[error("strategies: {0}")]
    Strategy(#[from] StrategyError),
    /// A metric is none of the numbers of a run.
    #[error("metrics: {name:?} is none; they are {}", .known.join(", "))]
    Metric {
        /// The name in the campaign.
        name: String,
        /// Names of all metrics.
        known: &'static [&'static str],
    },
    /// A setting allows no scan.
    #[error("settings: {0}: max_scans: a run has at least 1 scan")]
    NoScan(String),
    /// A setting overrides the strategy, which campaigns list elsewhere.
    #[error(
        "settings: {setting}: overrides: {path:?} has no effect; name strategies in `strategies`"
    )]
    StrategyOverridden {
        /// The setting.
        setting: String,
        /// The path of the parameter.
        path: String,
    },
    /// A setting overrides a parameter in an impossible way.
    #[error("settings: {setting}: overrides: {error}")]
    Override {
        /// The setting.
        setting: String,
        /// The error of the override.
        error: OverrideError,
    },
    /// The campaign has too many runs.
    #[error("the campaign has more than {most} runs ({}); divide it into several", counted(*.runs))]
    ManyRuns {
        /// The number of runs; `None` if it is too large to count.
        runs: Option<usize>,
        /// Largest allowed number.
        most: usize,
    },
    /// A world is turned or shifted in an impossible way.
    #[error("worlds: {world}: {fault}")]
    Moved {
        /// The world.
        world: String,
        /// The fault.
        fault: Fault,
    },
    /// Two runs are the same.
    #[error("a run stands there twice: {0} is the same as {1}")]
    SameRun(Box<RunKey>, Box<RunKey>),
    /// A thread ended before its work.
    #[error("a worker stopped")]
    Worker,
}

/// Fault of a folder of results.
#[derive(Debug, thiserror::Error)]
pub enum FolderFault {
    /// Its format is that of another version.
    #[error("a campaign of format {found}; this covmap has {known}")]
    Format {
        /// Format of the folder.
        found: u32,
        /// Format that can be read.
        known: u32,
    },
    /// The folder is a link.
    #[error("is a symbolic link, into which no run is written")]
    Link,
    /// The folder holds other results.
    #[error(
        "holds the results of another campaign ({0}), or of this one before it was changed; name another folder with --out"
    )]
    OtherCampaign(String),
    /// The folder holds another campaign than the first of several folders.
    #[error("holds another campaign ({name}) than {} ({first_name})", shown(first))]
    Differs {
        /// Name of the campaign in the folder.
        name: String,
        /// The first folder.
        first: PathBuf,
        /// Name of the campaign in the first folder.
        first_name: String,
    },
    /// Another version made the folder than the first of several folders.
    #[error(
        "was made by covmap {version}, {} by {first_version}; results of different versions are not mixed",
        shown(first)
    )]
    OtherVersion {
        /// The version that made the folder.
        version: String,
        /// The first folder.
        first: PathBuf,
        /// The version that made the first folder.
        first_version: String,
    },
    /// The folder is not of a campaign, so covmap does not write into it.
    #[error("is no folder of a campaign; name another with --out")]
    Foreign,
    /// The folder is not of a campaign, so covmap does not read from it.
    #[error("is no folder of a campaign")]
    None,
    /// The folder has no paths of a run.
    #[error("has no paths of {0}; the campaign needs `keep_paths: true`")]
    NoPaths(Box<RunKey>),
    /// The file of a run is damaged.
    #[error("the file of {0} is damaged")]
    Damaged(Box<RunKey>),
    /// The folder's lock is not a lock of covmap.
    #[error("is no lock that covmap made; remove it")]
    Lock,
    /// Another process writes into the folder.
    #[error("another covmap is writing into this folder")]
    Busy,
}

/// Fault of the starts in a world.
#[derive(Debug, thiserror::Error)]
pub enum StartsFault {
    /// The list is empty.
    #[error("at least one is needed")]
    Empty,
    /// The number of starts is out of its interval.
    #[error("{count} cannot be drawn; the number must lie in 1..={most}")]
    Count {
        /// The number of starts.
        count: usize,
        /// Largest allowed number.
        most: usize,
    },
    /// The world has too few places.
    #[error("{count} cannot be drawn: only {there} places have room")]
    Room {
        /// The number of starts to draw.
        count: usize,
        /// The number of places with room.
        there: usize,
    },
    /// The robot is too large for the world.
    #[error("a robot of radius {0} m fits nowhere in this world")]
    Nowhere(f64),
    /// The grid of the world is impossible.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}

fn counted(runs: Option<usize>) -> String {
    runs.map_or("beyond counting".to_owned(), |runs| runs.to_string())
}

/// The result of work on a campaign.
pub type Result<T, E = CampaignError> = std::result::Result<T, E>;

/// Names the folder of a fault.
pub(crate) fn of_folder(dir: &Path, fault: FolderFault) -> CampaignError {
    CampaignError::Folder { dir: dir.to_owned(), fault }
}
