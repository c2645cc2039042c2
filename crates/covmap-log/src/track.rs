//! The poses of the robot and their times: in the order of their lines, and in between.

use nalgebra::{Isometry2, Translation2};
use std::collections::VecDeque;

/// The longest time between two poses that allows poses in between \[s\].
pub(super) const LONGEST_GAP: f64 = 2.0;
/// The longest delay of a line after others of the same time \[s\]; a clock that is farther off has
/// leapt.
pub(super) const LATEST_LINE: f64 = 2.0;
/// The number of last poses that are remembered: 4 s at 1000 Hz.
const REMEMBERED: usize = 4096;

/// A time by the clock of the sensor, and by that of the logger \[s\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stamp {
    pub(super) time: f64,
    pub(super) logger: Option<f64>,
}

impl Stamp {
    /// Returns the time elapsed since another stamp \[s\]; 0 if neither clock tells.
    pub(super) fn since(&self, before: &Self) -> f64 {
        let elapsed = self.time - before.time;
        let by_logger = || Some(self.logger? - before.logger?);
        // A clock that was set does not tell.
        let tells = |seconds: &f64| *seconds > 0.0 && *seconds < 3600.0;
        Some(elapsed).filter(tells).or_else(|| by_logger().filter(tells)).unwrap_or(0.0)
    }
}

/// The robot's pose at a time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fix {
    pub(super) stamp: Stamp,
    pub(super) line: usize,
    pub(super) pose: Isometry2<f64>,
}

/// A pose, and the number of fixes before it.
pub(super) type Place = (Isometry2<f64>, usize);

/// Returns the pose a share of the way from `a` to `b`, on the straight line and the shorter turn.
fn between(a: &Isometry2<f64>, b: &Isometry2<f64>, share: f64) -> Isometry2<f64> {
    let place = a.translation.vector.lerp(&b.translation.vector, share);
    let turn = a.rotation.rotation_to(&b.rotation).powf(share);
    Isometry2::from_parts(Translation2::from(place), a.rotation * turn)
}

/// Returns the pose at a time \[s\] from `a` to `b`, if they are not too far apart.
pub(super) fn pose_between(a: &Fix, b: &Fix, time: f64) -> Option<Isometry2<f64>> {
    let (t0, t1) = (a.stamp.time, b.stamp.time);
    if time < t0 || time > t1 || t1 - t0 > LONGEST_GAP {
        return None;
    }
    match (time - t0, t1 - time) {
        (since, _) if since <= 0.0 => Some(a.pose),
        (_, left) if left <= 0.0 => Some(b.pose),
        (since, _) => Some(between(&a.pose, &b.pose, since / (t1 - t0))),
    }
}

/// The verdict on the second of three fixes in a row, by their times.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Middle {
    /// The second follows the first, or is the first of a clock that starts anew.
    Good,
    /// The third belongs before the second.
    Late,
    /// The clock leapt for the second.
    Glitch,
}

/// Judges the second of three fixes in a row.
///
/// If the first and the third are in order, and the second lies outside of them by more than
/// [`LATEST_LINE`], the second is a glitch.
pub(super) fn middle(first: f64, second: f64, third: f64) -> Middle {
    if first > third {
        return Middle::Good;
    }
    let (ahead, behind) = (second - third, first - second);
    match ahead.max(behind) {
        off if off > LATEST_LINE => Middle::Glitch,
        _ if ahead > 0.0 => Middle::Late,
        _ => Middle::Good,
    }
}

/// Counts the times that repeat the time of the line before.
#[derive(Debug, Default)]
pub(super) struct Ties {
    stamps: usize,
    tied: usize,
    last: Option<f64>,
}

impl Ties {
    /// Adds a time, and returns whether it is that of the line before.
    #[allow(clippy::float_cmp, reason = "the same digits")]
    pub(super) fn add(&mut self, time: f64) -> bool {
        let tied = self.last == Some(time);
        self.stamps += 1;
        self.tied += usize::from(tied);
        self.last = Some(time);
        tied
    }

    /// Returns whether the clock is too coarse to tell the lines apart.
    pub(super) fn is_coarse(&self) -> bool {
        self.tied > 0 && 4 * self.tied >= self.stamps
    }
}

/// The last fixes of a log that is read once.
#[derive(Debug, Default)]
pub(super) struct Track {
    fixes: VecDeque<Fix>,
    /// The number of forgotten fixes.
    forgotten: usize,
    pub(super) ties: Ties,
    /// The number of times that the clock started anew.
    pub(super) restarts: usize,
}

impl Track {
    /// Adds a fix, and returns the one before it if the clock leapt for that one.
    pub(super) fn push(&mut self, fix: Fix) -> Option<Fix> {
        if self.fixes.back().is_none_or(|last| last.pose != fix.pose) {
            self.ties.add(fix.stamp.time);
        }
        let mut leapt = None;
        let mut at = self.fixes.len();
        let mut last = self.fixes.iter().rev();
        if let (Some(&b), Some(&a)) = (last.next(), last.next()) {
            match middle(a.stamp.time, b.stamp.time, fix.stamp.time) {
                Middle::Glitch => leapt = self.fixes.pop_back(),
                Middle::Late => at -= 1,
                Middle::Good if b.stamp.time < a.stamp.time => self.restarts += 1,
                Middle::Good => {}
            }
        }
        self.fixes.insert(at.min(self.fixes.len()), fix);
        if self.fixes.len() > REMEMBERED {
            self.fixes.pop_front();
            self.forgotten += 1;
        }
        leapt
    }

    /// Returns whether a time is of another clock than the last fix, though the logger had both at
    /// once.
    pub(super) fn is_apart(&self, stamp: &Stamp) -> bool {
        let Some(last) = self.fixes.back() else { return false };
        let elapsed = |a: Option<f64>, b: Option<f64>| Some(b? - a?);
        let at_once = elapsed(last.stamp.logger, stamp.logger)
            .is_some_and(|seconds| (0.0..=LATEST_LINE).contains(&seconds));
        // A logger whose clock stands still does not tell.
        let first = self.fixes.front().and_then(|first| first.stamp.logger);
        let runs = elapsed(first, last.stamp.logger).is_some_and(|seconds| seconds > 0.0);
        at_once && runs && (stamp.time - last.stamp.time).abs() > LATEST_LINE
    }

    /// Returns the number of all fixes.
    pub(super) fn count(&self) -> usize {
        self.forgotten + self.fixes.len()
    }

    /// Returns whether all fixes that matter to a time were read: two in order, both later.
    pub(super) fn is_past(&self, time: f64) -> bool {
        let mut last = self.fixes.iter().rev().map(|fix| fix.stamp.time);
        let (Some(b), Some(a)) = (last.next(), last.next()) else { return false };
        time < a && a <= b
    }

    /// Returns the pose at a time \[s\]: recorded, or interpolated between the two around it.
    ///
    /// Unless the log has ended, the clock may have leapt for the last fix, and the search covers
    /// the recent fixes only. At the end the search covers all remembered fixes.
    #[allow(clippy::float_cmp, reason = "a recorded time is found by its digits")]
    pub(super) fn at(&self, time: f64, ended: bool) -> Option<Place> {
        let last = self.fixes.len().checked_sub(1)?;
        for (i, b) in self.fixes.iter().enumerate().rev() {
            let a = i.checked_sub(1).map(|before| &self.fixes[before]);
            if b.stamp.time == time && (i < last || ended) {
                return Some((b.pose, self.forgotten + i));
            }
            if let Some(pose) = a.and_then(|a| pose_between(a, b, time)) {
                return Some((pose, self.forgotten + i));
            }
            let is_first_of_a_clock = a.is_some_and(|a| a.stamp.time > b.stamp.time);
            let is_old = self.fixes[last].stamp.time - b.stamp.time > LATEST_LINE;
            if !ended && (is_first_of_a_clock || is_old || b.stamp.time < time) {
                return None;
            }
        }
        None
    }

    /// Returns the pose at a line, by the order of lines, and by the logger's clock between two
    /// fixes.
    #[allow(clippy::float_cmp, reason = "the same digits")]
    pub(super) fn at_line(&self, line: usize, stamp: &Stamp) -> Option<Place> {
        let after = self.fixes.partition_point(|fix| fix.line < line);
        let next = self.fixes.get(after);
        let Some(before) = after.checked_sub(1).map(|before| &self.fixes[before]) else {
            let next = next.filter(|next| next.stamp.time == stamp.time)?;
            return Some((next.pose, self.forgotten + after));
        };
        let logger = |fix: &Fix| fix.stamp.logger;
        // The logger's time since the fix before, and that between both fixes.
        let (since, gap) = match (logger(before), stamp.logger, next.and_then(logger)) {
            (Some(t0), Some(t), Some(t1)) if t0 <= t && t <= t1 => (t - t0, t1 - t0),
            (Some(t0), Some(t), _) => ((t - t0).max(0.0), 0.0),
            _ => (0.0, 0.0),
        };
        if since > 0.0 && gap.max(since) > LONGEST_GAP {
            return None;
        }
        let pose = match next {
            Some(next) if since > 0.0 && gap > 0.0 => {
                between(&before.pose, &next.pose, since / gap)
            }
            _ => before.pose,
        };
        Some((pose, self.forgotten + after))
    }

    /// Returns the number of fixes before a time, which must be a recent one.
    pub(super) fn place(&self, time: f64) -> usize {
        let later = |fix: &&Fix| {
            let ahead = fix.stamp.time - time;
            ahead > 0.0 && ahead <= LATEST_LINE
        };
        self.count() - self.fixes.iter().rev().take_while(later).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn fix(time: f64, x: f64, degrees: f64) -> Fix {
        let pose = Isometry2::new([x, 0.0].into(), degrees.to_radians());
        Fix { stamp: Stamp { time, logger: None }, line: 0, pose }
    }

    fn track(fixes: &[(f64, f64)]) -> Track {
        let mut track = Track::default();
        for (line, (time, x)) in fixes.iter().enumerate() {
            track.push(Fix { line, ..fix(*time, *x, 0.0) });
        }
        track
    }

    fn x_at(track: &Track, time: f64) -> Option<f64> {
        track.at(time, false).map(|(pose, _)| pose.translation.x)
    }

    #[test]
    fn a_pose_between_two_is_on_the_line_and_on_the_shorter_turn() {
        let (a, b) = (fix(10.0, 1.0, 170.0), fix(11.0, 3.0, -170.0));
        let middle = pose_between(&a, &b, 10.5).unwrap();
        assert!((middle.translation.x - 2.0).abs() < 1e-12);
        assert!((middle.rotation.angle().abs() - PI).abs() < 1e-9);
        assert_eq!(pose_between(&a, &b, 10.0), Some(a.pose));
        assert_eq!(pose_between(&a, &b, 11.0), Some(b.pose));
        assert_eq!(pose_between(&a, &b, 9.9), None);
        assert_eq!(pose_between(&a, &fix(13.0, 3.0, 0.0), 10.5), None, "a gap is not bridged");
    }

    #[test]
    fn one_wrong_reading_of_a_clock_is_given_back() {
        let mut track = track(&[(10.0, 0.0), (10.5, 0.5), (86_410.5, 0.9)]);
        assert_eq!(x_at(&track, 86_410.5), None, "nobody knows yet");
        let leapt = track.push(fix(11.0, 1.0, 0.0)).unwrap();
        assert!((leapt.stamp.time - 86_410.5).abs() < 1e-9);
        assert!((x_at(&track, 10.75).unwrap() - 0.75).abs() < 1e-12);
        assert!(track.push(fix(-86_400.0, 1.2, 0.0)).is_none());
        assert!(track.push(fix(11.5, 1.5, 0.0)).is_some(), "behind, too");
        assert_eq!(track.restarts, 0);
    }

    #[test]
    fn a_clock_that_starts_anew_is_followed() {
        let track = track(&[(20.0, 0.0), (20.5, 0.5), (0.25, 1.0), (0.75, 2.0)]);
        assert!((x_at(&track, 0.5).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(track.restarts, 1);
        // 20.2 s was long ago; at the end the search covers all remembered fixes.
        assert_eq!(x_at(&track, 20.2), None);
        assert!((track.at(20.25, true).unwrap().0.translation.x - 0.25).abs() < 1e-12);
        // A time before the new beginning is not taken from the old run.
        assert!(!track.is_past(0.75) && track.is_past(0.1));
        assert_eq!(x_at(&track, 0.1), None);
    }

    #[test]
    fn a_line_that_is_late_is_put_where_it_belongs() {
        let track = track(&[(1.0, 1.0), (1.4, 1.4), (1.2, 1.2), (1.6, 1.6)]);
        assert!((x_at(&track, 1.3).unwrap() - 1.3).abs() < 1e-12);
        assert!((x_at(&track, 1.1).unwrap() - 1.1).abs() < 1e-12);
        assert_eq!(track.place(1.3), 2);
    }

    #[test]
    fn a_clock_is_coarse_if_every_fourth_time_is_that_before() {
        let mut ties = Ties::default();
        let mut add = |time| {
            ties.add(time);
            ties.is_coarse()
        };
        assert!(!add(1.0) && add(1.0) && add(2.0) && add(3.0) && !add(4.0) && !add(5.0));
    }
}
