//! Where the robot can drive.

use serde::{Deserialize, Serialize};

/// Whether the robot can drive to the centre of a cell, as far as it knows; and if not, why.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reach {
    /// It can.
    Reached,
    /// It could stand there, but no way is open.
    CutOff,
    /// It bumped there.
    Bumped,
    /// A known cell under its body would be covered.
    Covered,
    /// The cell is unknown.
    Unknown,
}
