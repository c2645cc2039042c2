//! The way of a robot from frame to frame of a log: driven legs, and jumps.

use crate::{LogFrame, Passed};
use nalgebra::{Isometry2, Point2, Vector2};

/// The shortest step of a path \[m\]: shorter ones are the trembling of a standing robot.
const SHORTEST_STEP: f64 = 0.01;
/// A step up to this length counts as driven, however long it took \[m\].
const SHORT_STEP: f64 = 1.0;
/// The way of a step longer than this is unknown \[m\].
const LONGEST_STEP: f64 = 5.0;
/// The largest speed of a robot \[m/s\]; in a faster step the pose was corrected, not driven.
const FASTEST: f64 = 2.0;
/// The largest angle between the robot's heading, at both ends, and a step longer than
/// [`SHORT_STEP`] in which the body kept to the straight line \[rad\].
const ASTRAY: f64 = 0.5;
/// Corrected poses may differ from the odometry between them by this \[m\] …
const CORRECTION: f64 = 0.5;
/// … plus this share of the odometry's way.
const DRIFT: f64 = 0.3;
/// Poses this near to each other \[m, rad\] are the same.
const SAME: f64 = 1e-6;

/// A step of the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Start \[m\].
    pub from: Point2<f64>,
    /// End \[m\].
    pub to: Point2<f64>,
    /// Whether the way is unknown: the step was not driven.
    pub jump: bool,
    /// Whether the body swept the straight line.
    pub swept: bool,
}

/// Follows the frames of a log.
#[derive(Debug, Default)]
pub struct Follower {
    /// The last frame: the robot's pose, and its pose by odometry.
    last: Option<[Isometry2<f64>; 2]>,
    /// Whether the odometry ever moved; an odometry that never moves is ignored.
    odometry_moves: bool,
    /// The end of the last leg.
    at: Option<Isometry2<f64>>,
}

impl Follower {
    /// Returns the legs to the next frame.
    pub fn follow(&mut self, frame: &LogFrame) -> Vec<Leg> {
        let pose = frame.scan.pose;
        let odometry = frame.way.last().map_or(pose, |passed| passed.pose);
        let corners = match self.last {
            None if is_same(&pose, &odometry) => frame.way.clone(),
            None => vec![Passed { pose, seconds: 0.0 }],
            Some(last) => self.corners(last, [pose, odometry], &frame.way),
        };
        self.last = Some([pose, odometry]);
        corners.into_iter().filter_map(|corner| self.step(corner)).collect()
    }

    /// Returns the legs after the last frame.
    pub fn rest(&mut self, way: &[Passed]) -> Vec<Leg> {
        let Some([pose, odometry]) = self.last else { return Vec::new() };
        let world_from_odometry = if is_same(&pose, &odometry) {
            Isometry2::identity()
        } else {
            pose * odometry.inverse()
        };
        let corner =
            |passed: &Passed| Passed { pose: world_from_odometry * passed.pose, ..*passed };
        way.iter().filter_map(|passed| self.step(corner(passed))).collect()
    }

    /// Returns the poses that the robot passed, in the frame of the poses.
    fn corners(
        &mut self,
        [from, from_odometry]: [Isometry2<f64>; 2],
        [to, to_odometry]: [Isometry2<f64>; 2],
        way: &[Passed],
    ) -> Vec<Passed> {
        let starts = [from_odometry].into_iter().chain(way.iter().map(|passed| passed.pose));
        let steps: Vec<f64> = starts.zip(way).map(|(a, b)| distance(&a, &b.pose)).collect();
        let length: f64 = steps.iter().sum();
        self.odometry_moves |= length > SHORTEST_STEP;
        if is_same(&from, &from_odometry) && is_same(&to, &to_odometry) {
            return way.to_vec();
        }
        let seconds = way.iter().map(|passed| passed.seconds).sum();
        let straight = |seconds| vec![Passed { pose: to, seconds }];
        let jumps =
            steps.iter().zip(way).any(|(length, passed)| !is_drivable(*length, passed.seconds));
        if !self.odometry_moves || jumps {
            return straight(seconds);
        }
        // The odometry's way, placed at the robot's old pose, and bent to its new one.
        let world_from_odometry = from * from_odometry.inverse();
        let laid = world_from_odometry * to_odometry;
        let off = to.translation.vector - laid.translation.vector;
        if off.norm() > CORRECTION + DRIFT * length {
            // The odometry contradicts the poses.
            return straight(0.0);
        }
        let mut passed_length = 0.0;
        let bend = |(passed, step): (&Passed, &f64)| {
            passed_length += step;
            let mut pose = world_from_odometry * passed.pose;
            pose.translation.vector += off * (passed_length / length.max(SHORTEST_STEP)).min(1.0);
            Passed { pose, ..*passed }
        };
        let mut corners: Vec<Passed> = way.iter().zip(&steps).map(bend).collect();
        if let Some(last) = corners.last_mut() {
            last.pose = to;
        }
        corners
    }

    /// Returns the leg to a corner, if the corner is far enough.
    fn step(&mut self, corner: Passed) -> Option<Leg> {
        let Passed { pose, seconds } = corner;
        let first = self.at.is_none();
        let from = *self.at.get_or_insert(pose);
        let length = distance(&from, &pose);
        if !first && length < SHORTEST_STEP {
            return None;
        }
        // The time since the last corner; that corner is nearer to the last leg than a step.
        let jump = !is_drivable(length, seconds);
        let swept = length <= SHORT_STEP || (!jump && looks_along(&from, &pose));
        self.at = Some(pose);
        let [from, to] = [from, pose].map(|pose| Point2::from(pose.translation.vector));
        Some(Leg { from, to, jump, swept })
    }
}

/// Returns whether a robot can drive a length in a time; the time is 0 if it is not known.
fn is_drivable(length: f64, seconds: f64) -> bool {
    length <= SHORT_STEP || (length <= LONGEST_STEP && length <= FASTEST * seconds)
}

fn distance(a: &Isometry2<f64>, b: &Isometry2<f64>) -> f64 {
    (b.translation.vector - a.translation.vector).norm()
}

fn is_same(a: &Isometry2<f64>, b: &Isometry2<f64>) -> bool {
    distance(a, b) <= SAME && a.rotation.angle_to(&b.rotation).abs() <= SAME
}

/// Returns whether the robot faces along the line between two poses, or back, at both ends.
fn looks_along(from: &Isometry2<f64>, to: &Isometry2<f64>) -> bool {
    let line = (to.translation.vector - from.translation.vector).normalize();
    [from, to]
        .iter()
        .all(|pose| (pose.rotation * Vector2::x()).dot(&line).abs() >= libm::cos(ASTRAY))
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_sonar::{Range, Scan, SonarRing};
    use std::sync::Arc;

    fn at(x: f64, y: f64) -> Isometry2<f64> {
        Isometry2::translation(x, y)
    }

    /// Returns a frame at a pose; the odometry passed some places, each half a second after the last.
    fn frame(pose: Isometry2<f64>, way: &[Isometry2<f64>], seconds: f64) -> LogFrame {
        let ring = Arc::new(SonarRing::new(SonarRing::b21r().beams()[..1].to_vec()).unwrap());
        let scan = Scan { pose, time: 0.0, ranges: vec![Range::Missing] };
        let way = way.iter().map(|pose| Passed { pose: *pose, seconds }).collect();
        LogFrame { scan, ring, way, line: 1 }
    }

    /// Returns the driven length \[m\], the number of jumps, and the number of swept legs.
    fn follow(frames: &[LogFrame]) -> (f64, usize, usize) {
        let mut follower = Follower::default();
        let legs: Vec<Leg> = frames.iter().flat_map(|frame| follower.follow(frame)).collect();
        let driven = legs.iter().filter(|leg| !leg.jump).map(|leg| (leg.to - leg.from).norm());
        let count = |is: fn(&Leg) -> bool| legs.iter().filter(|leg| is(leg)).count();
        (driven.sum(), count(|leg| leg.jump), count(|leg| leg.swept))
    }

    #[track_caller]
    fn check(frames: &[LogFrame], (length, jumps, swept): (f64, usize, usize)) {
        let found = follow(frames);
        assert!((found.0 - length).abs() < 1e-9, "{found:?}");
        assert_eq!((found.1, found.2), (jumps, swept), "{found:?}");
    }

    #[test]
    fn keyframes_are_driven_if_their_time_allows_it() {
        let keyframes =
            |seconds| [0.0, 1.05, 2.1].map(|x| frame(at(x, 0.0), &[at(x, 0.0)], seconds)).to_vec();
        check(&keyframes(2.1), (2.1, 0, 3));
        check(&keyframes(0.1), (0.0, 2, 1));
        check(&keyframes(0.0), (0.0, 2, 1));
        // The robot stood for a long time, and did not drive then.
        let stood = [0.0, 0.0, 0.0, 4.0].map(|x| frame(at(x, 0.0), &[at(x, 0.0)], 1.0));
        check(&stood, (0.0, 1, 1));
        let far = [0.0, 6.0].map(|x| frame(at(x, 0.0), &[at(x, 0.0)], 60.0));
        check(&far, (0.0, 1, 1));
    }

    #[test]
    fn across_its_heading_the_body_of_a_robot_is_not_known_to_have_been() {
        let aside = [0.0, 1.5].map(|y| frame(at(0.0, y), &[at(0.0, y)], 3.0));
        check(&aside, (1.5, 0, 1));
    }

    #[test]
    fn the_way_is_that_of_the_odometry() {
        // The way leads round a corner.
        let round = [at(2.0, 0.0), at(2.0, 1.0), at(2.0, 2.0)];
        let frames = [frame(at(0.0, 0.0), &[at(0.0, 0.0)], 0.0), frame(round[2], &round, 2.0)];
        check(&frames, (4.0, 0, 4));
        // The same in a corrected frame, turned by 90° and drifted by 0.1 m.
        let turned = |pose: Isometry2<f64>| Isometry2::rotation(std::f64::consts::FRAC_PI_2) * pose;
        let end = at(0.1, 0.0) * turned(round[2]);
        let frames = [frame(turned(at(0.0, 0.0)), &[at(0.0, 0.0)], 0.0), frame(end, &round, 2.0)];
        let (length, jumps, swept) = follow(&frames);
        assert!((length - 4.0).abs() < 0.1 && (jumps, swept) == (0, 4), "{length}");
    }

    #[test]
    fn what_the_odometry_does_not_know_of_is_a_jump() {
        let way = |x: f64| [at(x, 0.0)];
        let frames = [
            frame(at(5.0, 5.0), &way(0.0), 1.0),
            frame(at(5.5, 5.0), &way(0.5), 1.0),
            frame(at(7.0, 6.5), &way(0.6), 2.0),
        ];
        check(&frames, (0.5, 1, 2));
        // An odometry that never moves is ignored.
        let frames = [frame(at(5.0, 5.0), &way(0.0), 1.0), frame(at(6.5, 5.0), &way(0.0), 1.0)];
        check(&frames, (1.5, 0, 2));
        // The odometry was reset.
        let reset = [at(4.0, 0.0), at(0.0, 0.0), at(0.1, 0.0)];
        let frames = [frame(at(3.9, 0.0), &way(3.9), 1.0), frame(at(0.1, 0.0), &reset, 0.1)];
        check(&frames, (0.2, 1, 3));
    }

    #[test]
    fn a_robot_that_stands_drives_nothing() {
        let tremble = [0.0, 0.004, -0.004, 0.004].map(|x| frame(at(x, 0.0), &[at(x, 0.0)], 1.0));
        check(&tremble, (0.0, 0, 1));
    }
}
