//! Filling a grid with the lengths of shortest ways.

use super::label::{self, Label, UNREACHED};
use super::steps::{STEPS, allowed, onward, steps_in};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// All eight neighbours are traversable.
const OPEN: u8 = u8::MAX;

/// Ways that spread over a grid.
///
/// Nothing is tried cell by cell: a straight way runs on until it is blocked, a diagonal one
/// likewise and sends straight ones off to both sides, and only where an obstacle ends beside
/// a way new ones begin. Those wait until all shorter ones are done. A way ends where another
/// was no longer, so what is left in the end are the shortest lengths, in whatever order the
/// ways ran.
pub(super) struct Spread<'a> {
    near: &'a [u8],
    /// From a cell to its neighbours in row-major order.
    offsets: [isize; 8],
    labels: Vec<Label>,
    turns: BinaryHeap<Reverse<Turn>>,
}

/// Steps that wait in a cell: the length of the way to it, the cell, the steps.
type Turn = (Label, u32, u8);

impl<'a> Spread<'a> {
    pub(super) fn new(near: &'a [u8], width: usize) -> Self {
        let width = width.cast_signed();
        Self {
            near,
            offsets: STEPS.map(|(dx, dy)| dy as isize * width + dx as isize),
            labels: vec![UNREACHED; near.len()],
            turns: BinaryHeap::new(),
        }
    }

    /// The labels of all cells, for ways from `source`.
    pub(super) fn from(mut self, source: u32) -> Vec<Label> {
        let at = source as usize;
        self.labels[at] = 0;
        self.turns.push(Reverse((0, source, allowed(self.near[at]))));
        while let Some(Reverse((length, at, turn))) = self.turns.pop() {
            let at = at as usize;
            if label::length(length) > label::length(self.labels[at]) {
                continue;
            }
            for step in steps_in(turn) {
                if step.is_multiple_of(2) {
                    self.straight(at, length, step);
                } else {
                    self.diagonal(at, length, step);
                }
            }
        }
        self.labels
    }

    fn diagonal(&mut self, mut at: usize, mut length: Label, step: usize) {
        let sides = [(step + 7) % 8, (step + 1) % 8];
        while allowed(self.near[at]) & (1 << step) != 0 {
            at = at.wrapping_add_signed(self.offsets[step]);
            length += label::DIAGONAL;
            if !label::improve(&mut self.labels[at], length, step) {
                return;
            }
            sides.into_iter().for_each(|side| self.straight(at, length, side));
        }
    }

    fn straight(&mut self, mut at: usize, mut length: Label, step: usize) {
        let mut near = self.near[at];
        while near & (1 << step) != 0 {
            at = at.wrapping_add_signed(self.offsets[step]);
            length += label::STRAIGHT;
            if !label::improve(&mut self.labels[at], length, step) {
                return;
            }
            near = self.near[at];
            if near != OPEN {
                let turn = onward(near, step) & !(1 << step);
                if turn != 0 {
                    #[allow(clippy::cast_possible_truncation, reason = "at most 2e7 cells")]
                    self.turns.push(Reverse((length, at as u32, turn)));
                }
            }
        }
    }
}
