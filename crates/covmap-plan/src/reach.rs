//! The reach of the robot.

use serde::{Deserialize, Serialize};

/// Whether the robot can drive to the centre of a cell, as far as the planner knows, and if not, why.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reach {
    /// The robot can drive there.
    Reached,
    /// The robot could stand there, but no way is open.
    CutOff,
    /// The robot bumped there.
    Bumped,
    /// A known cell under its body would be covered.
    Covered,
    /// The cell is unknown.
    Unknown,
}
