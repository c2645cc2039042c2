//! Drawings for a viewer.

use super::{Header, Pose, RosMessage};
use crate::{CdrError, CdrReader, CdrWriter};

/// What a marker shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MarkerShape {
    /// An arrow along the x axis of its pose.
    Arrow,
    /// A ball.
    #[default]
    Sphere,
    /// Lines from point to point.
    LineStrip,
    /// A cube on each point.
    CubeList,
    /// A text that faces the viewer.
    Text,
}

/// What to do with a marker.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MarkerAction {
    /// Show it, in place of an earlier one of the same namespace and number.
    #[default]
    Show,
    /// Remove all markers.
    RemoveAll,
}

/// `std_msgs/msg/ColorRGBA`: red, green, blue and opacity, each from 0 to 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ColorRgba(
    /// The four numbers.
    pub [f32; 4],
);

/// `visualization_msgs/msg/Marker`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marker {
    /// Time and frame.
    pub header: Header,
    /// The namespace.
    pub ns: String,
    /// The number in the namespace.
    pub id: i32,
    /// What it shows.
    pub shape: MarkerShape,
    /// What to do with it.
    pub action: MarkerAction,
    /// Its place.
    pub pose: Pose,
    /// Its size along x, y and z \[m\].
    pub scale: [f64; 3],
    /// Its colour.
    pub color: ColorRgba,
    /// The points of lines and lists \[m\].
    pub points: Vec<[f64; 3]>,
    /// The text.
    pub text: String,
}

impl Marker {
    fn write(&self, writer: &mut CdrWriter) {
        self.header.write(writer);
        writer.string(&self.ns);
        writer.i32(self.id);
        writer.i32(match self.shape {
            MarkerShape::Arrow => 0,
            MarkerShape::Sphere => 2,
            MarkerShape::LineStrip => 4,
            MarkerShape::CubeList => 6,
            MarkerShape::Text => 9,
        });
        writer.i32(match self.action {
            MarkerAction::Show => 0,
            MarkerAction::RemoveAll => 3,
        });
        self.pose.write(writer);
        writer.f64s(&self.scale);
        writer.f32s(&self.color.0);
        // The lifetime: for ever. The marker does not move with its frame.
        writer.i32(0);
        writer.u32(0);
        writer.u8(0);
        writer.list(&self.points, |w, point| w.f64s(point));
        // One colour for all points, no texture.
        writer.u32(0);
        writer.string("");
        Header::default().write(writer);
        writer.string("");
        writer.u32(0);
        writer.u32(0);
        writer.string(&self.text);
        // No mesh.
        writer.string("");
        writer.string("");
        writer.u32(0);
        writer.u8(0);
    }
}

/// `visualization_msgs/msg/MarkerArray`; it is written, and not read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MarkerArray {
    /// The markers.
    pub markers: Vec<Marker>,
}

impl RosMessage for MarkerArray {
    const TYPE: &'static str = "visualization_msgs/msg/MarkerArray";

    fn read(_: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Err(CdrError::End("markers"))
    }

    fn write(&self, writer: &mut CdrWriter) {
        writer.list(&self.markers, |w, marker| marker.write(w));
    }
}
