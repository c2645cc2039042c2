//! Events of a body, which can be integrated again.

use super::Body;
use covmap::{Change, CoverageMap};
use nalgebra::{Point2, Vector2};

/// An event of the robot's body; a record of events allows a map to be rebuilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyEvent {
    /// The body moved between two points \[m\] and touched nothing.
    Moved {
        /// Start of the way.
        from: Point2<f64>,
        /// End of the way.
        to: Point2<f64>,
    },
    /// The body, with its centre at a point \[m\], touched something when it drove on in a
    /// direction.
    Touched {
        /// Centre of the body.
        at: Point2<f64>,
        /// Direction of the drive.
        direction: Vector2<f64>,
    },
}

impl Body {
    /// Integrates an event by [`Body::moved`] or [`Body::touched`]. Returns the changes, in
    /// row-major order.
    pub fn happened(&mut self, map: &mut CoverageMap, event: &BodyEvent) -> Vec<Change> {
        match *event {
            BodyEvent::Moved { from, to } => self.moved(map, from, to),
            BodyEvent::Touched { at, direction } => self.touched(map, at, direction),
        }
    }
}
