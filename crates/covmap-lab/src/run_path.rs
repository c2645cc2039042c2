//! Where the robot of a run drove between its scans, from the run's trace.

use crate::TraceHeader;
use covmap::{Cell, Grid};
use covmap_explore::{Event, standing_place};
use nalgebra::{Isometry2, Point2};
use std::collections::VecDeque;

/// Lengths that differ by less are the same \[m\].
const SAME: f64 = 1e-6;

/// Follows the events of a run.
#[derive(Debug)]
pub struct RunPath {
    grid: Grid,
    /// Metres in a second.
    speed: f64,
    /// In the run the robot keeps its heading.
    start: Isometry2<f64>,
    at: Point2<f64>,
    /// How far it drove \[m\].
    length: f64,
    /// The cells to which it drives.
    ahead: VecDeque<Cell>,
    /// It went to the centre of the cell that it started in, or found that it cannot.
    settled: bool,
    /// It cannot: the start stands for that centre.
    cramped: bool,
    /// Where it passed since the last scan, and how far it had driven.
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

    /// Takes in the next event; gives where the robot passed since the last scan, if it is one:
    /// time \[s\] and pose of each corner.
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
                // What is not before the scan is where it was taken.
                let before = |(length, _): &(f64, Point2<f64>)| *length < driven - SAME;
                let passed = std::mem::take(&mut self.passed);
                passed.into_iter().filter(before).map(|passed| self.timed(passed)).collect()
            }
            Event::End { .. } => Vec::new(),
        }
    }

    /// Where the robot passed after its last scan.
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
