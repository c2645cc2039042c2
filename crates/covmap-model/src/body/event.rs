//! What happened to a body, to be integrated again.

use super::Body;
use covmap::{Change, CoverageMap};
use nalgebra::{Point2, Vector2};

/// What happened to the body of a robot: with it a map can be built again from a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyEvent {
    /// It was all the way between two points \[m\] and touched nothing.
    Moved {
        /// Where the way began.
        from: Point2<f64>,
        /// Where it ended.
        to: Point2<f64>,
    },
    /// With its centre at a point \[m\] it touched something when it drove on in a direction.
    Touched {
        /// Where the centre was.
        at: Point2<f64>,
        /// Where it drove.
        direction: Vector2<f64>,
    },
}

impl Body {
    /// Integrates what happened: [`Body::moved`] or [`Body::touched`]. Returns what changed, in
    /// row-major order.
    pub fn happened(&mut self, map: &mut CoverageMap, event: &BodyEvent) -> Vec<Change> {
        match *event {
            BodyEvent::Moved { from, to } => self.moved(map, from, to),
            BodyEvent::Touched { at, direction } => self.touched(map, at, direction),
        }
    }
}
