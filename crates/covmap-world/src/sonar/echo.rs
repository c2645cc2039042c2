//! The echo of a sonar: the nearest admissible point in its cone.
//!
//! Rays across the cone find surfaces, and follow mirrors. Rays at the nearest admissible point
//! of every face, past the ends of faces, and at corners and edges make the result independent of
//! the number of rays, except for echoes by way of mirrors.

use crate::faces::Face;
use crate::feature::Kind;
use crate::sonar::SonarPhysics;
use crate::sonar::physics::{MOST_BOUNCES, MOST_RAYS};
use crate::world::World;
use covmap_sonar::Beam;
use nalgebra::{Isometry2, Point2, Vector2};

/// Rays past the end of a face miss it by this angle [rad].
const PAST: f64 = 1e-7;
/// A hit this near before a point is the point itself [m].
const SAME_PLACE: f64 = 1e-7;
/// Rounding of angles [rad].
const ROUNDING: f64 = 1e-9;
/// Cones narrower than this are lines [rad].
const LINE: f64 = 1e-6;

/// One sonar in the world.
pub(crate) struct Echoes<'a> {
    world: &'a World,
    physics: &'a SonarPhysics,
    origin: Point2<f64>,
    axis: Vector2<f64>,
    half_angle: f64,
    max_range: f64,
}

/// A target in the cone, checked after the fan of rays.
#[derive(Clone, Copy)]
enum Target {
    /// A point that answers if it is visible.
    Point(Point2<f64>),
    /// The end of a face; a surface behind it may answer.
    End(Point2<f64>),
}

impl<'a> Echoes<'a> {
    pub(crate) fn new(
        world: &'a World,
        beam: &Beam,
        pose: &Isometry2<f64>,
        physics: &'a SonarPhysics,
    ) -> Self {
        let sensor = pose * beam.pose;
        Self {
            world,
            physics,
            origin: sensor.translation.vector.into(),
            axis: sensor.rotation * Vector2::x(),
            half_angle: beam.half_angle,
            max_range: beam.max_range,
        }
    }

    /// Returns the length of the shortest path to a surface that answers \[m\].
    pub(crate) fn nearest(&self) -> Option<f64> {
        if self.world.is_solid(self.origin) {
            return Some(0.0);
        }
        let mut best = f64::INFINITY;
        for angle in self.fan() {
            if let Some(path) = self.follow(angle, best.min(self.max_range)) {
                best = best.min(path);
            }
        }
        if self.half_angle > LINE {
            best = self.directed(best);
        }
        (best <= self.max_range).then_some(best)
    }

    /// Returns the angles from the axis of the rays across the cone: evenly spaced, with the axis
    /// and both sides.
    fn fan(&self) -> impl Iterator<Item = f64> + use<> {
        let rays = self.physics.cone_rays.min(MOST_RAYS);
        #[allow(clippy::cast_possible_truncation, reason = "at most 500")]
        let side = if self.half_angle > LINE { (rays / 2) as i32 } else { 0 };
        let step = self.half_angle / f64::from(side.max(1));
        (-side..=side).map(move |k| f64::from(k) * step)
    }

    /// Returns the unit vector at an angle from the axis.
    fn toward(&self, angle: f64) -> Vector2<f64> {
        let (sin, cos) = libm::sincos(angle);
        let (x, y) = (self.axis.x, self.axis.y);
        Vector2::new(x * cos - y * sin, x * sin + y * cos)
    }

    /// Returns the cone's half-angle at a range.
    fn half_angle_at(&self, range: f64) -> f64 {
        let shrunk = self.half_angle - self.physics.cone_shrink_per_metre * range;
        shrunk.max(self.physics.cone_min_half_angle.min(self.half_angle))
    }

    fn holds(&self, angle: f64, range: f64) -> bool {
        angle.abs() <= self.half_angle_at(range) + ROUNDING
    }

    /// Follows a ray over mirrors to the first surface that answers.
    fn follow(&self, angle: f64, limit: f64) -> Option<f64> {
        let (mut origin, mut direction) = (self.origin, self.toward(angle));
        let mut path = 0.0;
        for _ in 0..=self.physics.max_bounces.min(MOST_BOUNCES) {
            let hit = self.world.first_hit(origin, direction, limit - path)?;
            path += hit.distance;
            let face = &self.world.faces[hit.face];
            let (normal, into) = (face.normal(), direction.dot(&face.normal()));
            let cosine = libm::cos(self.physics.critical_angle(face.surface));
            if -into >= cosine {
                return self.holds(angle, path).then_some(path);
            }
            origin += direction * hit.distance;
            direction -= normal * (2.0 * into);
        }
        None
    }

    /// Improves on the fan by rays at every target that may answer nearer.
    fn directed(&self, mut best: f64) -> f64 {
        let mut targets: Vec<(f64, Target)> = Vec::new();
        let bounds = self.bounds(best.min(self.max_range));
        let mut add = |point: Point2<f64>, target: fn(Point2<f64>) -> Target| {
            targets.push(((point - self.origin).norm(), target(point)));
        };
        for face in self.world.faces_meeting(bounds).map(|i| &self.world.faces[i]) {
            if face.height(self.origin) > 0.0 {
                self.nearest_admissible(face).into_iter().for_each(|p| add(p, Target::Point));
                add(face.a, Target::End);
                add(face.b, Target::End);
            }
        }
        for feature in self.world.feature_index.meeting(bounds) {
            let feature = self.world.features[feature];
            match feature.kind {
                Kind::Corner => add(feature.at, Target::Point),
                Kind::Edge if (feature.at - self.origin).norm() <= self.physics.edge_range => {
                    add(feature.at, Target::Point);
                }
                Kind::Edge => {}
                Kind::Seam => add(feature.at, Target::End),
            }
        }
        targets.sort_by(|(d, _), (e, _)| d.total_cmp(e));
        for (distance, target) in targets {
            if distance >= best.min(self.max_range) {
                break;
            }
            if let Some(answer) = self.answer(distance, target, best) {
                best = best.min(answer);
            }
        }
        best
    }

    fn answer(&self, distance: f64, target: Target, best: f64) -> Option<f64> {
        let (Target::Point(point) | Target::End(point)) = target;
        let to = point - self.origin;
        let angle = libm::atan2(self.axis.perp(&to), self.axis.dot(&to));
        if !self.holds(angle, distance) {
            return None;
        }
        match target {
            Target::Point(_) => {
                let way = distance - SAME_PLACE;
                let hidden = self.world.first_hit(self.origin, to / distance, way).is_some();
                (!hidden).then_some(distance)
            }
            Target::End(_) => [-PAST, PAST]
                .into_iter()
                .filter_map(|past| self.directly(angle + past, best.min(self.max_range)))
                .min_by(f64::total_cmp),
        }
    }

    /// Returns the distance at which a surface answers a ray without mirrors.
    fn directly(&self, angle: f64, limit: f64) -> Option<f64> {
        let direction = self.toward(angle);
        let hit = self.world.first_hit(self.origin, direction, limit)?;
        let face = &self.world.faces[hit.face];
        let cosine = libm::cos(self.physics.critical_angle(face.surface));
        let answers = -direction.dot(&face.normal()) >= cosine;
        (answers && self.holds(angle, hit.distance)).then_some(hit.distance)
    }

    /// Returns the nearest point of a face that lies in the cone and is met within the critical
    /// angle, whether it is visible or not.
    fn nearest_admissible(&self, face: &Face) -> Option<Point2<f64>> {
        let height = face.height(self.origin);
        let foot = (self.origin - face.a).dot(&face.along);
        let reach = height * libm::tan(self.physics.critical_angle(face.surface));
        let admissible = ((foot - reach).max(0.0), (foot + reach).min(face.length));
        let mut half_angle = self.half_angle;
        let mut nearest = None;
        // A cone that shrinks is narrower at the point than was assumed.
        for _ in 0..4 {
            let (from, to) = self.within_cone(face, half_angle, admissible)?;
            let point = face.a + face.along * foot.clamp(from, to);
            nearest = Some(point);
            half_angle = self.half_angle_at((point - self.origin).norm());
        }
        nearest
    }

    /// Returns the part of an interval of a face's line that lies in a cone.
    fn within_cone(
        &self,
        face: &Face,
        half_angle: f64,
        (mut from, mut to): (f64, f64),
    ) -> Option<(f64, f64)> {
        // Left of the right side, and right of the left side.
        let inward = [(self.toward(-half_angle), 1.0), (self.toward(half_angle), -1.0)];
        for (side, sign) in inward {
            let at_start = sign * side.perp(&(face.a - self.origin));
            let slope = sign * side.perp(&face.along);
            if slope > 0.0 {
                from = from.max(-at_start / slope);
            } else if slope < 0.0 {
                to = to.min(-at_start / slope);
            } else if at_start < 0.0 {
                return None;
            }
        }
        (from <= to).then_some((from, to))
    }

    /// Returns a box around the cone up to a range.
    fn bounds(&self, range: f64) -> (Point2<f64>, Point2<f64>) {
        let arc = self.fan().map(|angle| self.origin + self.toward(angle) * range);
        let (low, high) =
            arc.fold((self.origin, self.origin), |(low, high), p| (low.inf(&p), high.sup(&p)));
        let step = self.half_angle / (self.physics.cone_rays / 2).max(1) as f64;
        let bulge = Vector2::repeat(range * (1.0 - libm::cos(0.5 * step)));
        (low - bulge, high + bulge)
    }
}
