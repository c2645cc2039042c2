//! Worlds as files describe them.

use serde::{Deserialize, Serialize};

/// A world as a file describes it: an extent with obstacles in it.
///
/// The origin is the lower left corner of the extent; everything outside of the extent is solid.
/// Obstacles may overlap each other and reach beyond the extent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// The world's name, which also names the results of a run in it.
    pub name: String,
    /// The world's size.
    pub extent: Extent,
    /// The robot's start; without it the robot starts at the roomiest place. A file gives the
    /// start without `Some`.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub start: Option<Start>,
    /// The obstacles, in any order.
    pub obstacles: Vec<Obstacle>,
}

/// Reads and writes a value without wrapping it in `Some`.
mod bare {
    use super::Start;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        start: &Option<Start>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        match start {
            Some(start) => start.serialize(to),
            None => to.serialize_none(),
        }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Option<Start>, D::Error> {
        Start::deserialize(from).map(Some)
    }
}

/// The size of a world.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Extent {
    /// Along x \[m\].
    pub width: f64,
    /// Along y \[m\].
    pub height: f64,
}

/// The robot's start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Distance from the left border of the extent \[m\].
    pub x: f64,
    /// Distance from the lower border of the extent \[m\].
    pub y: f64,
    /// Heading from the x axis, counter-clockwise \[rad\].
    pub heading: f64,
}

/// A solid that stands in the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// The obstacle's outline.
    pub shape: Shape,
    /// The obstacle's answer to a sonar.
    pub surface: Surface,
}

/// The answer of a surface to a sonar.
///
/// The critical angles are in [`SonarPhysics`](crate::SonarPhysics).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Surface {
    /// Scatters sound, and answers up to a large angle from its normal.
    Rough,
    /// Mirrors sound, and answers only near its normal.
    Smooth,
}

/// The outline of an obstacle; lengths in metres, angles in radians counter-clockwise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// A rectangle, turned about its centre.
    Rectangle {
        /// Centre \[m\].
        center: (f64, f64),
        /// Full width and height before the turn \[m\].
        size: (f64, f64),
        /// Angle of the turn \[rad\].
        angle: f64,
    },
    /// A simple polygon, of either winding \[m\].
    Polygon(Vec<(f64, f64)>),
    /// A straight wall with flat ends.
    Wall {
        /// One end of the wall's middle line \[m\].
        from: (f64, f64),
        /// The other end of the middle line \[m\].
        to: (f64, f64),
        /// Full thickness \[m\].
        thickness: f64,
    },
    /// A regular polygon of 64 sides with its vertices on the circle, the first at angle 0.
    Circle {
        /// Centre \[m\].
        center: (f64, f64),
        /// Radius \[m\].
        radius: f64,
    },
}

impl Shape {
    /// Returns the word that names the shape in a file.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Rectangle { .. } => "Rectangle",
            Self::Polygon(_) => "Polygon",
            Self::Wall { .. } => "Wall",
            Self::Circle { .. } => "Circle",
        }
    }
}
