//! Worlds as they are written in a file.

use serde::{Deserialize, Serialize};

/// A world as it is written in a file: an extent with obstacles in it.
///
/// The origin is the lower left corner of the extent; everything outside of the extent is
/// solid. Obstacles may overlap each other and reach beyond the extent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// The world's name, which also names the results of a run in it.
    pub name: String,
    /// Its size.
    pub extent: Extent,
    /// Where the robot starts; without it the roomiest place is taken. In a file it stands as
    /// it is, without `Some`.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub start: Option<Start>,
    /// What stands in it, in any order.
    pub obstacles: Vec<Obstacle>,
}

/// Reads and writes what is there without wrapping it in `Some`.
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

/// Where the robot starts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// From the left border of the extent \[m\].
    pub x: f64,
    /// From its lower border \[m\].
    pub y: f64,
    /// From the x axis, counter-clockwise \[rad\].
    pub heading: f64,
}

/// Something solid that stands in the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Its outline.
    pub shape: Shape,
    /// How it answers a sonar.
    pub surface: Surface,
}

/// How a surface answers a sonar; the critical angles are in
/// [`SonarPhysics`](crate::SonarPhysics).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Surface {
    /// It scatters, and answers up to a large angle from its normal.
    Rough,
    /// It mirrors, and answers only near its normal.
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
        /// Full width and height before it is turned \[m\].
        size: (f64, f64),
        /// By how much it is turned \[rad\].
        angle: f64,
    },
    /// A simple polygon, of either winding \[m\].
    Polygon(Vec<(f64, f64)>),
    /// A straight wall with flat ends.
    Wall {
        /// One end of its middle line \[m\].
        from: (f64, f64),
        /// The other end \[m\].
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
    /// The word that names the shape in a file.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Rectangle { .. } => "Rectangle",
            Self::Polygon(_) => "Polygon",
            Self::Wall { .. } => "Wall",
            Self::Circle { .. } => "Circle",
        }
    }
}
