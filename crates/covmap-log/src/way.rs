//! The way of a robot between two of its frames.

use super::track::{Fix, Stamp};
use nalgebra::Isometry2;
use std::collections::VecDeque;

/// The shortest step \[m\]: shorter ones are the trembling of a standing robot.
const SHORTEST_STEP: f64 = 0.01;
/// The largest number of poses kept between two frames; of more, every second is kept.
const MOST: usize = 4096;

/// A pose that the robot passed between two frames, by its odometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passed {
    /// `world_from_robot` by odometry, whose frame may differ from that of the scan's pose.
    pub pose: Isometry2<f64>,
    /// The time since the pose before \[s\]; 0 if the clocks do not tell.
    pub seconds: f64,
}

/// The fixes passed since the last frame.
#[derive(Debug, Default)]
pub(super) struct Way {
    /// Each fix, with the number of fixes before it.
    fixes: VecDeque<(usize, Fix)>,
    /// The stamp of the last fix or frame taken out.
    last: Option<Stamp>,
}

impl Way {
    /// Adds the next fix, which has `number` fixes before it.
    pub(super) fn push(&mut self, number: usize, fix: &Fix) {
        let place = |fix: &Fix| fix.pose.translation.vector;
        let moved = |(_, last): &(usize, Fix)| (place(fix) - place(last)).norm() >= SHORTEST_STEP;
        if !self.fixes.back().is_none_or(moved) {
            return;
        }
        if self.fixes.len() == MOST {
            let mut keeps = false;
            self.fixes.retain(|_| {
                keeps = !keeps;
                keeps
            });
        }
        self.fixes.push_back((number, *fix));
    }

    /// Removes the fix of a line, if it is the last.
    pub(super) fn take_back(&mut self, line: usize) {
        if self.fixes.back().is_some_and(|(_, fix)| fix.line == line) {
            self.fixes.pop_back();
        }
    }

    /// Returns the way to a frame with a pose by odometry and a number of fixes before it.
    pub(super) fn to(&mut self, before: usize, stamp: Stamp, pose: Isometry2<f64>) -> Vec<Passed> {
        let mut way = self.until(before);
        way.push(self.step(stamp, pose));
        way
    }

    /// Returns the way after the last frame.
    pub(super) fn rest(&mut self) -> Vec<Passed> {
        self.until(usize::MAX)
    }

    fn until(&mut self, before: usize) -> Vec<Passed> {
        let end = self.fixes.partition_point(|(number, _)| *number < before);
        let fixes: Vec<Fix> = self.fixes.drain(..end).map(|(_, fix)| fix).collect();
        fixes.iter().map(|fix| self.step(fix.stamp, fix.pose)).collect()
    }

    fn step(&mut self, stamp: Stamp, pose: Isometry2<f64>) -> Passed {
        let seconds = self.last.replace(stamp).map_or(0.0, |last| stamp.since(&last));
        Passed { pose, seconds }
    }
}
