//! The events of a run: scans, decisions, bumps and the end.

use crate::Ending;
use covmap::Cell;
use covmap_plan::Decision;
use covmap_sonar::Scan;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// Event of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Event {
    /// The robot measured.
    Scan {
        /// The number of scans before this one.
        number: usize,
        /// The readings and the pose.
        scan: Scan,
    },
    /// The planner chose a view-point.
    Decision {
        /// The number of decisions before this one.
        number: usize,
        /// The robot's cell.
        from: Cell,
        /// The choice and its reasons.
        decision: Decision,
    },
    /// The robot bumped into something.
    Bump {
        /// The cell that the robot was driving to; its own cell if it was on the way to its centre.
        cell: Cell,
        /// The last place without contact \[m\].
        at: Point2<f64>,
        /// The place that the robot was driving to \[m\].
        towards: Point2<f64>,
    },
    /// The run is over.
    End {
        /// The ending.
        ending: Ending,
    },
}

/// Hash over the lines of a trace; equal runs have equal hashes.
#[derive(Debug, Clone, Default)]
pub struct TraceHasher(Sha256);

impl TraceHasher {
    /// Adds a line of the trace.
    pub fn add<T: Serialize>(&mut self, line: &T) {
        // Numbers are written with all their digits; a line that cannot be written adds no bytes.
        self.0.update(serde_json::to_vec(line).unwrap_or_default());
        self.0.update(b"\n");
    }

    /// Adds an event, without the five best candidates of a decision: they explain what was chosen, and runs
    /// that explain less are the same runs.
    pub fn add_event(&mut self, event: &Event) {
        match event {
            Event::Decision { number, from, decision } => {
                let decision = Decision { best: Vec::new(), ..decision.clone() };
                self.add(&Event::Decision { number: *number, from: *from, decision });
            }
            Event::Scan { .. } | Event::Bump { .. } | Event::End { .. } => self.add(event),
        }
    }

    /// Adds bytes that are not a line of the trace, such as those of the belief.
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Returns the hash as a hexadecimal number.
    pub fn finish(self) -> String {
        let mut text = String::new();
        for byte in self.0.finalize() {
            let _ = write!(text, "{byte:02x}");
        }
        text
    }
}
