//! Driving: a disc that sweeps a straight segment.

use crate::faces::Face;
use crate::world::World;
use covmap_sonar::Drive;
use nalgebra::{Point2, Vector2};

/// A disc touches a solid that is nearer than its radius by this [m].
const CONTACT: f64 = 1e-9;
/// Driving stops this far before contact [m].
const HAIR: f64 = 1e-6;

impl World {
    /// Drives a disc straight from one point to another; the disc stops before it touches a
    /// solid.
    ///
    /// A disc that is in contact from the start may move away from the solid, or along it, but
    /// not nearer. A disc whose centre is in a solid does not move.
    pub fn drive(&self, from: Point2<f64>, to: Point2<f64>, radius: f64) -> Drive {
        let way = to - from;
        let length = way.norm();
        if length <= 0.0 {
            return Drive::Arrived;
        }
        if !length.is_finite() || self.is_solid(from) {
            return Drive::Bumped { at: from };
        }
        let direction = way / length;
        let margin = Vector2::repeat(radius);
        let swept = (from.inf(&to) - margin, from.sup(&to) + margin);
        let contact = self
            .faces_meeting(swept)
            .filter_map(|face| contact(&self.faces[face], from, direction, radius - CONTACT))
            .fold(f64::INFINITY, f64::min);
        if contact > length {
            Drive::Arrived
        } else {
            Drive::Bumped { at: from + direction * (contact - HAIR).max(0.0) }
        }
    }
}

/// Returns the distance that a disc travels until it touches a face.
///
/// The distance to a face is convex along a straight line: a disc never meets a face again that
/// it leaves.
fn contact(face: &Face, from: Point2<f64>, direction: Vector2<f64>, radius: f64) -> Option<f64> {
    let away = from - face.nearest(from);
    if away.norm() <= radius {
        let approaches = away.dot(&direction) < -CONTACT * away.norm();
        return approaches.then_some(0.0);
    }
    let side = [to_side(face, from, direction, radius)];
    let ends = [face.a, face.b].map(|end| to_disc(end, from, direction, radius));
    side.into_iter().chain(ends).flatten().min_by(f64::total_cmp)
}

/// Returns the distance to the line beside the face, between the face's ends.
fn to_side(face: &Face, from: Point2<f64>, direction: Vector2<f64>, radius: f64) -> Option<f64> {
    let (height, climb) = (face.height(from), direction.dot(&face.normal()));
    let approach = -climb * height.signum();
    if height.abs() < radius || approach <= 0.0 {
        return None;
    }
    let distance = (height.abs() - radius) / approach;
    let along = (from + direction * distance - face.a).dot(&face.along);
    (0.0..=face.length).contains(&along).then_some(distance)
}

/// Returns the distance to the circle around a point.
fn to_disc(
    center: Point2<f64>,
    from: Point2<f64>,
    direction: Vector2<f64>,
    radius: f64,
) -> Option<f64> {
    let to_center = center - from;
    let along = to_center.dot(&direction);
    let beside = to_center.perp(&direction);
    let half_chord = radius * radius - beside * beside;
    (along > 0.0 && half_chord > 0.0).then(|| (along - half_chord.sqrt()).max(0.0))
}
