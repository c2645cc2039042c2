//! The ending of a run.

use serde::{Deserialize, Serialize};

/// Ending of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// No cell is open: the certificate gives the reason for each cell.
    Explored,
    /// The budget of scans is spent, and there is more to measure.
    BudgetSpent,
    /// No cell is open, but the robot could not leave the cell that it started in.
    StartBlocked,
    /// No cell is open, but in the end the robot could get no farther than it is wide, or could not move
    /// at all.
    BoxedIn,
    /// No cell is open, but no sensor received an echo in the whole run.
    NothingHeard,
    /// The hook stopped the run.
    Interrupted,
    /// The robot failed, and cells may still be open; [`Run::failure`](crate::Run::failure) holds the reason.
    RobotFailed,
}

impl Ending {
    /// Returns the ending in words for a user.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Explored => "explored: nothing is open",
            Self::BudgetSpent => "the budget of scans is spent, and something is still open",
            Self::StartBlocked => "nothing is open, but the robot could not leave its start",
            Self::BoxedIn => "nothing is open, but the robot is boxed in where it stands",
            Self::NothingHeard => "nothing is open, but no sensor ever answered",
            Self::Interrupted => "interrupted",
            Self::RobotFailed => "the robot failed, and something may still be open",
        }
    }
}
