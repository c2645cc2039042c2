//! Where the robot was, and when: poses in the order of time, and between them.

use super::fields::Fields;
use super::lines::Lines;
use super::skipped::Damage;
use super::{LogError, SkipReason, Skipped};
use nalgebra::{Isometry2, Translation2};
use std::collections::VecDeque;
use std::f64::consts::PI;
use std::path::Path;

/// Poses farther apart in time than this have nothing to say about what is between them \[s\].
const LONGEST_GAP: f64 = 2.0;
/// So many of the last poses are remembered.
const REMEMBERED: usize = 64;

/// What is known of a time.
pub(super) enum At {
    Pose(Isometry2<f64>),
    /// It is later than all poses so far.
    Later,
    /// There are no poses close before and after it.
    Unknown,
}

/// The last poses.
#[derive(Default)]
pub(super) struct Track {
    poses: VecDeque<(f64, Isometry2<f64>)>,
}

impl Track {
    /// Adds a pose at a time \[s\].
    pub(super) fn push(&mut self, time: f64, pose: Isometry2<f64>) -> Result<(), Damage> {
        if let Some((last, _)) = self.poses.back().filter(|(last, _)| time < *last) {
            return Err(backwards(time, *last));
        }
        if self.poses.len() == REMEMBERED {
            self.poses.pop_front();
        }
        self.poses.push_back((time, pose));
        Ok(())
    }

    /// The pose at a time \[s\]: recorded, or between the two around it, on the straight line
    /// and the shorter turn.
    pub(super) fn at(&self, time: f64) -> At {
        let after = self.poses.partition_point(|(t, _)| *t < time);
        let Some((t1, b)) = self.poses.get(after) else { return At::Later };
        if *t1 <= time {
            return At::Pose(*b);
        }
        match after.checked_sub(1).map(|before| self.poses[before]) {
            Some((t0, a)) if t1 - t0 <= LONGEST_GAP => {
                At::Pose(between(&a, b, (time - t0) / (t1 - t0)))
            }
            _ => At::Unknown,
        }
    }
}

/// The pose a share of the way from `a` to `b`.
fn between(a: &Isometry2<f64>, b: &Isometry2<f64>, share: f64) -> Isometry2<f64> {
    let place = a.translation.vector.lerp(&b.translation.vector, share);
    let turn = a.rotation.rotation_to(&b.rotation).powf(share);
    Isometry2::from_parts(Translation2::from(place), a.rotation * turn)
}

pub(super) fn backwards(time: f64, last: f64) -> Damage {
    Damage::new(SkipReason::Backwards, format!("time: {time} s comes after {last} s"))
}

/// The units of a file of poses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    per_metre: f64,
    per_radian: f64,
}

impl Units {
    /// Of `od.txt`: millimetres and tenths of a degree.
    pub(super) const ODOMETRY: Self = Self { per_metre: 1e3, per_radian: 1800.0 / PI };
    /// Of corrected poses: metres and radians.
    pub(super) const CORRECTED: Self = Self { per_metre: 1.0, per_radian: 1.0 };
}

/// A file with a time in milliseconds and a pose in each line, read no farther than asked.
pub(super) struct PoseFile {
    lines: Lines,
    units: Units,
    track: Track,
    ended: bool,
}

impl PoseFile {
    pub(super) fn open(path: &Path, units: Units) -> Result<Self, LogError> {
        Ok(Self::new(Lines::open(path)?, units))
    }

    pub(super) fn new(lines: Lines, units: Units) -> Self {
        Self { lines, units, track: Track::default(), ended: false }
    }

    /// The pose at a time \[s\], if it is known. Times must not run backwards far.
    pub(super) fn at(
        &mut self,
        time: f64,
        skipped: &mut Skipped,
    ) -> Result<Option<Isometry2<f64>>, LogError> {
        loop {
            match self.track.at(time) {
                At::Pose(pose) => return Ok(Some(pose)),
                At::Unknown => return Ok(None),
                At::Later if self.ended => return Ok(None),
                At::Later => self.read_on(skipped)?,
            }
        }
    }

    fn read_on(&mut self, skipped: &mut Skipped) -> Result<(), LogError> {
        if !self.lines.advance()? {
            self.ended = true;
            return Ok(());
        }
        let parsed = self.parse().and_then(|(time, pose)| self.track.push(time, pose));
        if let Err(damage) = parsed {
            skipped.add_pose(self.lines.path(), self.lines.line(), &damage);
        }
        Ok(())
    }

    fn parse(&self) -> Result<(f64, Isometry2<f64>), Damage> {
        let text = self.lines.text();
        let mut fields = Fields::new(&text);
        let Units { per_metre, per_radian } = self.units;
        let time = fields.time("time", 1e3)?;
        let pose = fields.pose(["x", "y", "theta"], per_metre, per_radian)?;
        if fields.left() > 0 {
            let fault = format!("theta: is followed by {} fields more", fields.left());
            return Err(Damage::new(SkipReason::Unreadable, fault));
        }
        Ok((time, pose))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(x: f64, degrees: f64) -> Isometry2<f64> {
        Isometry2::new([x, 0.0].into(), degrees.to_radians())
    }

    fn at(track: &Track, time: f64) -> Option<Isometry2<f64>> {
        match track.at(time) {
            At::Pose(pose) => Some(pose),
            At::Later | At::Unknown => None,
        }
    }

    #[test]
    fn a_pose_between_two_is_on_the_line_and_on_the_shorter_turn() {
        let mut track = Track::default();
        track.push(10.0, pose(1.0, 170.0)).unwrap();
        track.push(11.0, pose(3.0, -170.0)).unwrap();
        let middle = at(&track, 10.5).unwrap();
        assert!((middle.translation.x - 2.0).abs() < 1e-12);
        assert!((middle.rotation.angle().abs() - PI).abs() < 1e-9);
        assert_eq!(at(&track, 10.0), Some(pose(1.0, 170.0)));
        assert_eq!(at(&track, 11.0), Some(pose(3.0, -170.0)));
        assert!(matches!(track.at(9.9), At::Unknown) && matches!(track.at(11.1), At::Later));
    }

    #[test]
    fn long_gaps_are_not_bridged_and_time_does_not_run_backwards() {
        let mut track = Track::default();
        track.push(10.0, pose(0.0, 0.0)).unwrap();
        track.push(13.0, pose(1.0, 0.0)).unwrap();
        assert!(matches!(track.at(11.0), At::Unknown));
        assert_eq!(track.push(12.0, pose(0.5, 0.0)).unwrap_err().reason, SkipReason::Backwards);
        assert_eq!(at(&track, 13.0), Some(pose(1.0, 0.0)));
    }
}
