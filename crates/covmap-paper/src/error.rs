//! Errors of the experiments.

use covmap::{GridError, MapError};
use covmap_campaign::{CampaignError, RunKey};
use covmap_explore::MissionError;
use covmap_gain::BeamError;
use covmap_io::{FileError, shown};
use covmap_lab::{ConfigError, LabError, SetupError};
use covmap_model::ModelError;
use covmap_sonar::RingError;
use covmap_world::WorldError;
use std::num::TryFromIntError;
use std::path::PathBuf;

/// Why an experiment fails, in one sentence.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// A campaign fails.
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    /// A world, a configuration, a fit or a run fails.
    #[error(transparent)]
    Lab(#[from] LabError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The claims cannot be written as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The threads cannot be made.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The sensor model is too large for the tables of the gain.
    #[error(transparent)]
    Beam(#[from] BeamError),
    /// A number is too large.
    #[error(transparent)]
    Number(#[from] TryFromIntError),
    /// A part that the experiments always have is missing.
    #[error("{0} is missing")]
    Missing(&'static str),
    /// A recorded run differs when it is repeated.
    #[error("{}: {key}: differs from its record; remove the folder to run it again", shown(dir))]
    OtherRun {
        /// The folder of its campaign.
        dir: PathBuf,
        /// The key of the run.
        key: Box<RunKey>,
    },
    /// The audience stopped the experiments.
    #[error("interrupted; finished runs stay, and the same command continues with them")]
    Interrupted,
}

/// The result of an experiment.
pub type Result<T, E = PaperError> = std::result::Result<T, E>;

macro_rules! of_the_lab {
    ($($part:ty),*) => {
        $(impl From<$part> for PaperError {
            fn from(error: $part) -> Self {
                Self::Lab(error.into())
            }
        })*
    };
}
of_the_lab!(
    ConfigError,
    GridError,
    MapError,
    MissionError,
    ModelError,
    RingError,
    SetupError,
    WorldError
);
