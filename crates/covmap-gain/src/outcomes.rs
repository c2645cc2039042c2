//! Questions to an evaluator: some beams of some rows of view-points, with their likely outcomes.

use covmap::lanes::{LANES, Lanes};
use std::ops::Range;

/// One beam of one group of view-points.
#[derive(Debug, Clone)]
pub(crate) struct GroupBeam {
    /// The group's place in its row.
    pub(crate) group: usize,
    pub(crate) beam: usize,
    /// The beam's own outcomes among those of the row.
    pub(crate) outcomes: Range<usize>,
}

/// Beams of one row of view-points whose gains are asked for.
#[derive(Debug, Clone, Default)]
pub(crate) struct AskedRow {
    /// The row of the grid.
    pub(crate) y: usize,
    pub(crate) beams: Vec<GroupBeam>,
    /// By [`Stencil::outcome`](crate::Stencil::outcome)'s index: the likely outcomes of the first
    /// beam in ascending order, then those of the next, and so on.
    pub(crate) outcomes: Vec<usize>,
    /// p(d | c) of each of these, from each view-point of the group; 0 for view-points that do not
    /// ask.
    pub(crate) probabilities: Vec<Lanes>,
}

/// Expected gain of one of these beams from each view-point of its group, or upper bounds of it.
/// The values of view-points that did not ask mean nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BeamAnswer {
    /// E\[I\] \[nats\].
    pub(crate) gain: Lanes,
    /// Expected gain of the cells that are reasons to measure, of those that gain enough \[nats\];
    /// infinite if the evaluation does not tell the cells apart.
    pub(crate) promise: Lanes,
}

impl BeamAnswer {
    /// Creates an answer that is the same from all view-points.
    pub(crate) fn all(gain: f32, promise: f32) -> Self {
        Self { gain: [gain; LANES], promise: [promise; LANES] }
    }
}

/// The answer for each beam of an [`AskedRow`].
pub(crate) type RowGains = Vec<BeamAnswer>;
