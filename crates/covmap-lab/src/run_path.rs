//! The robot's path between the scans of a run, from the run's trace.

use crate::TraceHeader;
use covmap::{Cell, Grid};
use covmap_explore::{Event, standing_place};
use nalgebra::{Isometry2, Point2};
use std::collections::VecDeque;

/// Lengths that differ by less than this are the same \[m\].
const SAME: f64 = 1e-6;

/// The path of a run, followed event by event.
#[derive(Debug)]
pub struct RunPath {
    grid: Grid,
    /// Speed \[m/s\].
    speed: f64,
    /// Start pose, with the heading that the robot keeps in the run.
    start: Isometry2<f64>,
    at: Point2<f64>,
    /// Length of the driven path \[m\].
    length: f64,
    /// The cells that the robot is driving to.
    ahead: VecDeque<Cell>,
    /// Whether the robot went to the centre of the cell that it started in, or found that it cannot.
    settled: bool,
    /// Whether the robot cannot get there: the start replaces that centre.
    cramped: bool,
    /// Corners of the path since the last scan, each with the length of the path up to it.
    passed: Vec<(f64, Point2<f64>)>,
}

impl RunPath {
    /// Follows a run from its start.
    pub fn new(header: &TraceHeader) -> Self {
        Self {
            grid: header.grid,
            speed: header.config.robot.speed,
            start: header.start,
            at: header.start.translation.vector.into(),
            length: 0.0,
            ahead: VecDeque::new(),
            settled: false,
            cramped: false,
            passed: Vec::new(),
        }
    }

    /// Takes over the next event. For a scan, returns the time \[s\] and pose of each corner that the robot
    /// passed since the last scan.
    pub fn follow(&mut self, event: &Event) -> Vec<(f64, Isometry2<f64>)> {
        match event {
            Event::Decision { from, decision, .. } => {
                let own = (!self.settled).then_some(*from);
                self.settled = true;
                self.ahead = own.into_iter().chain(decision.path.iter().copied()).collect();
                Vec::new()
            }
            Event::Bump { cell, at, .. } => {
                while let Some(next) = self.ahead.pop_front().filter(|next| next != cell) {
                    self.drive(self.place(next));
                }
                self.ahead.clear();
                self.cramped |= self.length <= 0.0 && self.is_start(*cell);
                let home = self.at;
                self.drive(*at);
                self.drive(home);
                Vec::new()
            }
            Event::Scan { scan, .. } => {
                let driven = scan.time * self.speed;
                while let Some(center) = self.ahead.front().map(|cell| self.place(*cell)) {
                    if self.length + (center - self.at).norm() > driven + SAME {
                        break;
                    }
                    self.ahead.pop_front();
                    self.drive(center);
                }
                (self.at, self.length) = (scan.pose.translation.vector.into(), driven);
                // A corner that is not before the scan is the place of the scan.
                let before = |(length, _): &(f64, Point2<f64>)| *length < driven - SAME;
                let passed = std::mem::take(&mut self.passed);
                passed.into_iter().filter(before).map(|passed| self.timed(passed)).collect()
            }
            Event::End { .. } => Vec::new(),
        }
    }

    /// Returns the times and poses of the corners that the robot passed after its last scan.
    pub fn rest(&mut self) -> Vec<(f64, Isometry2<f64>)> {
        let passed = std::mem::take(&mut self.passed);
        passed.into_iter().map(|passed| self.timed(passed)).collect()
    }

    fn is_start(&self, cell: Cell) -> bool {
        self.grid.cell_at(self.start.translation.vector.into()) == Some(cell)
    }

    fn place(&self, cell: Cell) -> Point2<f64> {
        standing_place(&self.grid, self.start.translation.vector.into(), self.cramped, cell)
    }

    fn drive(&mut self, to: Point2<f64>) {
        self.length += (to - self.at).norm();
        self.at = to;
        self.passed.push((self.length, to));
    }

    fn timed(&self, (length, at): (f64, Point2<f64>)) -> (f64, Isometry2<f64>) {
        (length / self.speed, Isometry2::from_parts(at.coords.into(), self.start.rotation))
    }
}
