//! Fills a grid with the lengths of shortest ways.

use super::label::{self, Label, UNREACHED};
use super::pruning::{OPEN, onward, steps_in};
use covmap::{STEPS, Steps};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Ways that spread over a grid.
///
/// Ways do not spread cell by cell. A straight way runs on until it is blocked; so does a diagonal way,
/// and sends straight ways off to both sides. New ways begin only where an obstacle ends beside a way,
/// and wait until all shorter ways are done. A way ends in a cell that another way of at most its length
/// has reached, so the labels are the shortest lengths in the end, in whatever order the ways ran.
pub(super) struct Spread<'a> {
    steps: &'a Steps,
    masks: &'a [u16],
    /// Offsets from a cell's row-major index to those of its neighbours.
    offsets: [isize; 8],
    labels: Vec<Label>,
    turns: BinaryHeap<Reverse<Turn>>,
}

/// Steps that wait in a cell: the length of the way to the cell, the cell, the steps.
type Turn = (Label, u32, u8);

impl<'a> Spread<'a> {
    pub(super) fn new(steps: &'a Steps) -> Self {
        let width = steps.grid().width().cast_signed();
        Self {
            steps,
            masks: steps.masks(),
            offsets: STEPS.map(|(dx, dy)| dy as isize * width + dx as isize),
            labels: vec![UNREACHED; steps.grid().len()],
            turns: BinaryHeap::new(),
        }
    }

    /// The labels of all cells, for ways from `source`.
    pub(super) fn from(mut self, source: u32) -> Vec<Label> {
        let at = source as usize;
        self.labels[at] = 0;
        self.turns.push(Reverse((0, source, self.steps.from(at))));
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
        let tried = sides.iter().fold(1 << step, |set, side| set | 1 << side);
        while self.masks[at] & (1 << step) != 0 {
            at = at.wrapping_add_signed(self.offsets[step]);
            length += label::DIAGONAL;
            if !label::improve(&mut self.labels[at], length, step) {
                return;
            }
            sides.into_iter().for_each(|side| self.straight(at, length, side));
            self.turn(at, length, step, tried);
        }
    }

    fn straight(&mut self, mut at: usize, mut length: Label, step: usize) {
        while self.masks[at] & (1 << step) != 0 {
            at = at.wrapping_add_signed(self.offsets[step]);
            length += label::STRAIGHT;
            if !label::improve(&mut self.labels[at], length, step) {
                return;
            }
            self.turn(at, length, step, 1 << step);
        }
    }

    /// Makes the steps wait that go on after a step, except those `tried` at once.
    #[inline]
    fn turn(&mut self, at: usize, length: Label, step: usize, tried: u8) {
        let mask = self.masks[at];
        if mask == OPEN {
            return;
        }
        let turn = onward(mask, step) & !tried;
        if turn != 0 {
            #[allow(clippy::cast_possible_truncation, reason = "at most 2e7 cells")]
            self.turns.push(Reverse((length, at as u32, turn)));
        }
    }
}
