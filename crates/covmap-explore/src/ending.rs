//! How a run ends.

use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// No cell is open: the certificate says why of each.
    Explored,
    /// The budget of scans is spent, and something is still open.
    BudgetSpent,
    /// Nothing is open, but the robot could not leave the cell that it started in.
    StartBlocked,
    /// Nothing is open, but in the end the robot could reach no more than what one scan spends,
    /// or could not move at all.
    BoxedIn,
    /// Nothing is open, but no sensor answered in the whole run: there was not one echo.
    NothingHeard,
    /// The hook stopped the run.
    Interrupted,
    /// The robot failed, and something may still be open: [`Run::failure`](crate::Run::failure) says why.
    RobotFailed,
}

impl Ending {
    /// The ending as a user reads it.
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
