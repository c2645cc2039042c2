//! Why an experiment fails.

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

/// Why an experiment cannot be done, in one sentence.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// A campaign.
    #[error(transparent)]
    Campaign(#[from] CampaignError),
    /// A world, a configuration, a fit or a run.
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
    /// Something that the experiments always have is not there.
    #[error("{0} is missing")]
    Missing(&'static str),
    /// A recorded run comes out otherwise when it is repeated.
    #[error("{}: {key}: is another run now; remove the folder to run it again", shown(dir))]
    OtherRun {
        /// The folder of its campaign.
        dir: PathBuf,
        /// Which run.
        key: Box<RunKey>,
    },
    /// The audience stopped it.
    #[error("interrupted; what is done stays, and the same command goes on with it")]
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
