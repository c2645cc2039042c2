//! The cells in front of the ends of outcomes.

use covmap::lanes::Lanes;

/// The cells before the end of an outcome: their number, p_k, and L(k).
pub(super) struct Front {
    pub(super) cells: usize,
    pub(super) probability: Lanes,
    pub(super) any: Lanes,
}

/// Sums over the outcomes that end beyond a cell, and the gain of the cell by them, or a bound of
/// it.
pub(super) trait FrontSums {
    /// Adds an outcome, by p_k and L(k).
    fn add(&mut self, probability: &Lanes, any: &Lanes);

    /// Returns the gain of a cell by all outcomes so far, by f.
    fn of_cell(&self, place: (usize, isize), free: f32) -> Lanes;
}
