//! Frames of a CARMEN log, until their poses are known.

use super::device::Measured;
use super::skipped::{Damage, leapt};
use super::track::{Fix, LATEST_LINE, Place, Ties, Track};
use super::way::Way;
use super::{Account, Passed, SkipReason};
use nalgebra::Isometry2;
use std::collections::VecDeque;
use std::path::Path;

/// The largest number of frames that wait for the odometry after them.
const MOST_WAITING: usize = 256;
/// The number of last frames among which those with poses of their own are sorted by time.
const SORTED: usize = 8;
/// Fewer frames than this with another clock than the fixes count as leaps of the clock.
const FEWEST_APART: usize = 4;
/// The largest delay of a frame \[s\]; a later frame means that the clock starts anew.
const LATEST_FRAME: f64 = 60.0;

enum State {
    Open,
    /// The number of fixes before the frame.
    Known(usize),
    Lost(Damage),
}

struct Waiting {
    frame: Measured,
    /// The frame's pose by odometry, if it has a pose of its own.
    odometry: Option<Isometry2<f64>>,
    /// Whether the order of lines placed the frame, not its time.
    by_order: bool,
    /// Whether the frame has another clock than the fix before it.
    apart: bool,
    state: State,
}

/// The waiting frames of a log, in the order of their lines.
#[derive(Default)]
pub(super) struct Queue {
    track: Track,
    waiting: VecDeque<Waiting>,
    ties: Ties,
    /// The number of frames, and the number of those with another clock than the fixes.
    frames: usize,
    apart: usize,
    way: Way,
    /// Time and pose of the last frame taken out.
    last: Option<(f64, Isometry2<f64>)>,
}

impl Queue {
    /// Returns the number of times that the clock of the poses started anew.
    pub(super) fn restarts(&self) -> usize {
        self.track.restarts
    }

    /// Returns the poses that the robot passed after the last frame.
    pub(super) fn rest(&mut self) -> Vec<Passed> {
        self.way.rest()
    }

    /// Adds a pose of the robot, and returns the line before it if that line's clock leapt.
    pub(super) fn push_fix(&mut self, fix: Fix) -> Option<(usize, Damage)> {
        let wrong = self.track.push(fix);
        if let Some(wrong) = &wrong {
            self.way.take_back(wrong.line);
        }
        self.way.push(self.track.count() - 1, &fix);
        let needs_order = self.needs_order();
        for waiting in self.waiting.iter_mut().filter(|one| matches!(one.state, State::Open)) {
            let time = waiting.frame.stamp.time;
            match (place(&self.track, needs_order, waiting, false), &wrong) {
                (Some(found), _) => settle(waiting, found),
                (None, Some(wrong)) if (time - wrong.stamp.time).abs() <= LATEST_LINE => {
                    waiting.state = State::Lost(leapt(time));
                }
                (None, _) if self.track.is_past(time) && !waiting.apart => {
                    waiting.state = State::Lost(lost(time));
                }
                (None, _) => {}
            }
        }
        wrong.map(|wrong| (wrong.line, leapt(wrong.stamp.time)))
    }

    /// Adds a frame that takes its pose from the fixes around it.
    pub(super) fn push(&mut self, mut frame: Measured) {
        frame.tied = self.ties.add(frame.stamp.time);
        let apart = self.track.is_apart(&frame.stamp);
        self.frames += 1;
        self.apart += usize::from(apart);
        let (odometry, by_order, state) = (None, false, State::Open);
        self.waiting.push_back(Waiting { frame, odometry, by_order, apart, state });
    }

    /// Returns whether times cannot place frames, because they are too coarse, or of different
    /// clocks.
    fn needs_order(&self) -> bool {
        let different = self.apart >= FEWEST_APART && 4 * self.apart >= self.frames;
        different || self.ties.is_coarse() || self.track.ties.is_coarse()
    }

    /// Adds a frame with a pose of its own, and one by odometry.
    pub(super) fn push_posed(&mut self, frame: Measured, odometry: Isometry2<f64>) {
        let time = frame.stamp.time;
        let state = State::Known(self.track.place(time));
        let odometry = Some(odometry);
        let at = self.position(time);
        let (by_order, apart) = (false, false);
        self.waiting.insert(at, Waiting { frame, odometry, by_order, apart, state });
    }

    /// Returns the place of a time among the last frames.
    fn position(&self, time: f64) -> usize {
        let times = |at: usize| self.waiting.get(at).map(|one| one.frame.stamp.time);
        let end = self.waiting.len();
        let is_later = |at: &usize| {
            times(*at).is_some_and(|other| other > time && other - time <= LATEST_FRAME)
        };
        let later = (0..end).rev().take(SORTED).take_while(is_later).count();
        let at = end - later;
        let before = at.checked_sub(1).and_then(times).or(self.last.map(|(time, _)| time));
        if before.is_none_or(|before| before <= time) { at } else { end }
    }

    /// Returns the first frame, if its pose is known.
    pub(super) fn pop(
        &mut self,
        ended: bool,
        path: &Path,
        account: &mut Account,
    ) -> Option<Measured> {
        loop {
            let full = self.waiting.len() > MOST_WAITING;
            let sorted = ended || self.waiting.len() > SORTED;
            let mut first = self.waiting.pop_front()?;
            if matches!(first.state, State::Open) && (ended || full) {
                match place(&self.track, self.needs_order(), &first, true) {
                    Some(found) => settle(&mut first, found),
                    None => first.state = State::Lost(lost(first.frame.stamp.time)),
                }
            }
            match first.state {
                State::Known(before) if sorted || first.odometry.is_none() => {
                    return Some(self.take(first, before, account));
                }
                State::Lost(damage) => first.frame.skip(path, damage, account),
                State::Open | State::Known(_) => {
                    self.waiting.push_front(first);
                    return None;
                }
            }
        }
    }

    fn take(&mut self, first: Waiting, before: usize, account: &mut Account) -> Measured {
        let Waiting { mut frame, odometry, by_order, .. } = first;
        let (stamp, pose) = (frame.stamp, frame.pose.unwrap_or_default());
        frame.way = self.way.to(before, stamp, odometry.unwrap_or(pose));
        let moved = self.last.is_some_and(|(_, last)| last != pose);
        account.placed_by_order += usize::from(by_order && moved);
        if odometry.is_some() && self.last.is_some_and(|(last, _)| last - stamp.time > LATEST_FRAME)
        {
            account.restarts += 1;
        }
        self.last = Some((stamp.time, pose));
        frame
    }
}

/// Returns the place of a frame by the fixes so far, and whether the order of lines gave it.
fn place(
    track: &Track,
    needs_order: bool,
    waiting: &Waiting,
    ended: bool,
) -> Option<(Place, bool)> {
    let Measured { stamp, line, tied, .. } = &waiting.frame;
    let by_order = *tied || needs_order;
    let found = if by_order { track.at_line(*line, stamp) } else { track.at(stamp.time, ended) };
    found.map(|place| (place, by_order))
}

fn settle(waiting: &mut Waiting, ((pose, before), by_order): (Place, bool)) {
    waiting.frame.pose = Some(pose);
    waiting.by_order = by_order;
    waiting.state = State::Known(before);
}

fn lost(time: f64) -> Damage {
    Damage::new(SkipReason::NoPose, format!("there is no pose around the time {time} s"))
}
