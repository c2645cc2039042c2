//! The scans that a survey uses, as echoes in the world.

use super::{SurveyError, SurveyParameters};
use covmap_sonar::{Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2, Vector2};

/// The largest distance of a robot from the origin [m].
const FARTHEST: f64 = 1e5;
/// The largest number of echoes of a survey.
pub(super) const MAX_ECHOES: usize = 20_000_000;

/// A beam that met something.
#[derive(Debug, Clone, Copy)]
pub(super) struct Echo {
    /// The beam's index in its ring.
    pub(super) beam: usize,
    /// The place of the sensor.
    pub(super) eye: Point2<f64>,
    /// The source of the echo.
    pub(super) at: Point2<f64>,
}

/// The echoes of a scan, in the order of its beams.
pub(super) type View = Vec<Echo>;

/// Returns whether a pose is valid.
pub(super) fn is_pose(pose: &Isometry2<f64>) -> bool {
    let rotation = [pose.rotation.re, pose.rotation.im];
    pose.translation.vector.iter().all(|v| v.abs() <= FARTHEST)
        && rotation.iter().all(|v| v.is_finite())
}

/// Returns the origin and the direction of a beam.
pub(super) fn axis(
    pose: &Isometry2<f64>,
    robot_from_sensor: &Isometry2<f64>,
) -> (Point2<f64>, Vector2<f64>) {
    let sensor = pose * robot_from_sensor;
    (sensor.translation.vector.into(), sensor.rotation * Vector2::x())
}

/// Returns the views of all scans that are used: those between which the robot moved.
pub(super) fn views<'a>(
    scans: impl IntoIterator<Item = (&'a SonarRing, &'a Scan)>,
    parameters: &SurveyParameters,
) -> Result<Vec<View>, SurveyError> {
    let mut views = Vec::new();
    let mut last: Option<Isometry2<f64>> = None;
    let mut echoes = 0;
    for (ring, scan) in scans {
        if !is_pose(&scan.pose) || last.is_some_and(|last| is_near(&last, &scan.pose, parameters)) {
            continue;
        }
        last = Some(scan.pose);
        let view = view(ring, scan, parameters.max_range);
        echoes += view.len();
        if echoes > MAX_ECHOES {
            return Err(SurveyError::TooManyEchoes);
        }
        views.push(view);
    }
    Ok(views)
}

fn is_near(last: &Isometry2<f64>, pose: &Isometry2<f64>, parameters: &SurveyParameters) -> bool {
    let moved = (pose.translation.vector - last.translation.vector).norm();
    let turned = last.rotation.angle_to(&pose.rotation).abs();
    moved < parameters.min_move && turned < parameters.min_turn
}

fn view(ring: &SonarRing, scan: &Scan, max_range: f64) -> View {
    let echo = |(number, (beam, range)): (usize, (&covmap_sonar::Beam, &Range))| match *range {
        Range::Echo(range) if range > 0.0 && range <= max_range => {
            let (eye, direction) = axis(&scan.pose, &beam.pose);
            Some(Echo { beam: number, eye, at: eye + direction * range })
        }
        _ => None,
    };
    ring.beams().iter().zip(&scan.ranges).enumerate().filter_map(echo).collect()
}
