//! Outcomes of drives.

use nalgebra::Point2;

/// Outcome of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// The robot arrived at its goal.
    Arrived,
    /// The robot stopped before something solid.
    Bumped {
        /// The last place without contact, a micrometre before the contact \[m\].
        at: Point2<f64>,
    },
    /// A person or a device stopped the robot on the way, without contact. No simulated robot ends
    /// a drive so.
    Stopped {
        /// Place of the robot \[m\].
        at: Point2<f64>,
    },
}
