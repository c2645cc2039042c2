//! The cells in front of the ends of outcomes.

use covmap::lanes::Lanes;

/// The cells before the end of an outcome: how many, p_k, and L(k).
pub(super) struct Front {
    pub(super) cells: usize,
    pub(super) probability: Lanes,
    pub(super) any: Lanes,
}

/// Sums over the outcomes that end beyond a cell, and what the cell gains by them, or a bound of it.
pub(super) trait FrontSums {
    /// Adds an outcome, by p_k and L(k).
    fn add(&mut self, probability: &Lanes, any: &Lanes);

    /// What a cell gains by all outcomes so far, by f.
    fn of_cell(&self, place: (usize, isize), free: f32) -> Lanes;
}
