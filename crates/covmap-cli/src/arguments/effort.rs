//! The effort of a run, as an argument.

use clap::ValueEnum;
use covmap_plan::Effort;

/// The effort of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum EffortName {
    /// The floor plan, with two thirds of the scans of standard
    Quick,
    /// The default
    Standard,
    /// The best map
    Thorough,
}

impl EffortName {
    pub(crate) fn effort(self) -> Effort {
        match self {
            Self::Quick => Effort::Quick,
            Self::Standard => Effort::Standard,
            Self::Thorough => Effort::Thorough,
        }
    }
}
