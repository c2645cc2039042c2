//! How a drive ends.

use nalgebra::Point2;

/// How a drive ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// At its goal.
    Arrived,
    /// Before something solid.
    Bumped {
        /// The last place without contact, a micrometre before it \[m\].
        at: Point2<f64>,
    },
    /// On the way, touching nothing: somebody or something stopped the robot there. No simulated robot
    /// does.
    Stopped {
        /// Where it stands \[m\].
        at: Point2<f64>,
    },
}
