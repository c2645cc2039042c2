//! What happens in a run: every scan and every decision.

use crate::Ending;
use covmap::Cell;
use covmap_plan::Decision;
use covmap_sonar::Scan;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// What happens in a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Event {
    /// The robot measured.
    Scan {
        /// How many scans there were before.
        number: usize,
        /// What it measured, and where.
        scan: Scan,
    },
    /// The planner chose.
    Decision {
        /// How many decisions there were before.
        number: usize,
        /// The cell the robot was in.
        from: Cell,
        /// What it chose, and why.
        decision: Decision,
    },
    /// The robot bumped into something.
    Bump {
        /// The cell that it was entering; its own, if it did not get to its centre.
        cell: Cell,
        /// The last place without contact \[m\].
        at: Point2<f64>,
        /// Where it was driving \[m\].
        towards: Point2<f64>,
    },
    /// The run is over.
    End {
        /// How it ended.
        ending: Ending,
    },
}

/// A hash over a trace, line by line: the same for the same run.
#[derive(Debug, Clone, Default)]
pub struct TraceHasher(Sha256);

impl TraceHasher {
    /// Adds a line of the trace.
    pub fn add<T: Serialize>(&mut self, line: &T) {
        // Numbers are written with all their digits; what cannot be written cannot differ.
        self.0.update(serde_json::to_vec(line).unwrap_or_default());
        self.0.update(b"\n");
    }

    /// Adds bytes that are no line of the trace, such as those of the belief.
    pub fn add_bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The hash as a hexadecimal number.
    pub fn finish(self) -> String {
        let mut text = String::new();
        for byte in self.0.finalize() {
            let _ = write!(text, "{byte:02x}");
        }
        text
    }
}
