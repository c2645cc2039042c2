//! Poses in the plane, as messages have them: with quaternions.

use crate::messages::Transform;
use nalgebra::{
    Complex, Isometry2, Isometry3, Quaternion, Translation2, Translation3, UnitComplex,
    UnitQuaternion,
};

/// Returns a transform as a motion in space; `None` if its numbers are none of a motion.
pub fn in_space(transform: &Transform) -> Option<Isometry3<f64>> {
    let [x, y, z, w] = transform.rotation;
    let rotation = Quaternion::new(w, x, y, z);
    let length = rotation.norm();
    let [px, py, pz] = transform.translation;
    let is_motion = (0.9..1.1).contains(&length) && [px, py, pz].iter().all(|v| v.is_finite());
    // A quaternion that is one but for rounding keeps its bits.
    let rotation = if (length - 1.0).abs() < 1e-12 { rotation } else { rotation / length };
    let unit = UnitQuaternion::new_unchecked(rotation);
    is_motion.then(|| Isometry3::from_parts(Translation3::new(px, py, pz), unit))
}

/// Returns the part of a motion that is in the plane: x, y, and the direction of the x axis.
pub fn in_plane(motion: &Isometry3<f64>) -> Isometry2<f64> {
    let at = motion.translation.vector;
    let q = motion.rotation.quaternion();
    // The direction of the x axis; without a tilt, of length w² + z².
    let (x, y) = (q.w * q.w + q.i * q.i - q.j * q.j - q.k * q.k, 2.0 * (q.w * q.k + q.i * q.j));
    let is_flat = q.i.abs() + q.j.abs() <= 0.0;
    let length = if is_flat { q.w * q.w + q.k * q.k } else { (x * x + y * y).sqrt() };
    let rotation =
        if length > 0.0 { Complex::new(x / length, y / length) } else { Complex::new(1.0, 0.0) };
    Isometry2::from_parts(Translation2::new(at.x, at.y), UnitComplex::new_unchecked(rotation))
}

/// Returns a pose in the plane as a message has it; [`in_plane`] makes the same pose of it, but for rounding.
pub fn planar(pose: &Isometry2<f64>) -> Transform {
    let at = pose.translation.vector;
    let (z, w) = libm::sincos(0.5 * pose.rotation.angle());
    Transform { translation: [at.x, at.y, 0.0], rotation: [0.0, 0.0, z, w] }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are exact")]
mod tests {
    use super::*;
    use nalgebra::Vector2;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    proptest! {
        #[test]
        fn a_pose_is_the_same_but_for_rounding(x in -1e3..1e3f64, angle in -PI..PI) {
            let pose = Isometry2::new(Vector2::new(x, -x), angle);
            let again = in_plane(&in_space(&planar(&pose)).unwrap());
            prop_assert_eq!(again.translation, pose.translation);
            let off = again.rotation.complex() - pose.rotation.complex();
            prop_assert!(off.re.abs().max(off.im.abs()) < 4.0 * f64::EPSILON, "{}", off);
        }
    }

    #[test]
    fn a_sensor_that_is_upside_down_keeps_its_direction() {
        // Half a turn around x, then a quarter around z: x → y.
        let upside_down = UnitQuaternion::from_euler_angles(PI, 0.0, 0.5 * PI);
        let pose = in_plane(&Isometry3::from_parts(Translation3::new(1.0, 2.0, 3.0), upside_down));
        assert!((pose.rotation.angle() - 0.5 * PI).abs() < 1e-12);
        assert_eq!(pose.translation.vector, Vector2::new(1.0, 2.0));
    }

    #[test]
    fn what_is_no_motion_is_refused() {
        let no = |rotation: [f64; 4], x: f64| {
            in_space(&Transform { translation: [x, 0.0, 0.0], rotation }).is_none()
        };
        assert!(no([0.0; 4], 0.0) && no([f64::NAN; 4], 0.0));
        assert!(no([0.0, 0.0, 0.0, 1.0], f64::INFINITY) && !no([0.0, 0.0, 0.0, 1.0], 0.0));
    }
}
