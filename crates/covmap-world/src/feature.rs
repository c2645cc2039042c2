//! Points where faces meet: concave corners, which answer every sonar, and convex edges.

use crate::error::{MAX_PAIRS, WorldError};
use crate::exposed::Exposed;
use crate::faces::{Face, Index};
use nalgebra::{Point2, Vector2};

/// Choice: faces that turn by less than 30° into each other make neither a corner nor an edge:
/// the sides of a circle are one round surface. This is the cosine of that turn.
const SHARP_COSINE: f64 = 0.866_025_403_784_438_6;
/// The sine of the angle below which faces count as parallel.
const PARALLEL: f64 = 1e-6;
/// Faces that come this near to each other meet [m].
const MEETING: f64 = 1e-7;

/// The kind of a meeting of faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// A concave corner.
    Corner,
    /// A convex edge.
    Edge,
    /// Faces that meet at too flat an angle for a corner; one of them ends there for the eye.
    Seam,
}

/// A point where faces meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Feature {
    pub(crate) at: Point2<f64>,
    pub(crate) kind: Kind,
}

/// Returns the feature at the joint of one side of an outline and the next.
pub(crate) fn of_joint(before: &Face, after: &Face) -> Option<Feature> {
    let (turn, cosine) = (before.along.perp(&after.along), before.along.dot(&after.along));
    let kind = if turn < 0.0 { Kind::Corner } else { Kind::Edge };
    (cosine < SHARP_COSINE).then_some(Feature { at: after.a, kind })
}

/// Returns the corners and seams between faces of different outlines.
///
/// These are crossings, and ends that stand on another face; each comes with the direction where
/// free space may be. Neighbours in an outline are left to [`of_joint`].
pub(crate) fn between(
    faces: &[Face],
    exposed: &[Exposed],
    index: &Index,
) -> Result<Vec<(Feature, Vector2<f64>)>, WorldError> {
    let mut found = Vec::new();
    let mut pairs = 0_usize;
    for (i, face) in faces.iter().enumerate() {
        let margin = Vector2::repeat(MEETING);
        let (low, high) = face.bounds();
        for j in index.meeting((low - margin, high + margin)).filter(|&j| j > i) {
            pairs += 1;
            if pairs > MAX_PAIRS {
                return Err(WorldError::TooDense);
            }
            found.extend(crossing((face, &exposed[i]), (&faces[j], &exposed[j])));
        }
    }
    Ok(found)
}

/// Returns the feature of two faces that meet where both are exposed, if part of each lies before
/// the other.
fn crossing(
    (one, exposed): (&Face, &Exposed),
    (other, other_exposed): (&Face, &Exposed),
) -> Option<(Feature, Vector2<f64>)> {
    let sine = one.along.perp(&other.along);
    if sine.abs() < PARALLEL {
        return None;
    }
    let s = (other.a - one.a).perp(&other.along) / sine;
    let t = (other.a - one.a).perp(&one.along) / sine;
    let within = |v: f64, face: &Face| (-MEETING..=face.length + MEETING).contains(&v);
    if !(within(s, one) && within(t, other) && exposed.holds(s) && other_exposed.holds(t)) {
        return None;
    }
    let before = |face: &Face, of: &Face| of.height(face.a).max(of.height(face.b)) > 10.0 * MEETING;
    let flat = one.along.dot(&other.along) > SHARP_COSINE;
    let kind = if flat { Kind::Seam } else { Kind::Corner };
    let feature = Feature { at: one.a + one.along * s, kind };
    let free = one.normal() + other.normal();
    (before(one, other) && before(other, one)).then_some((feature, free))
}
