//! Which gains decide: all candidates are bounded, and those evaluated that may be the best.
//!
//! The bounds are found on probes and not proven ([`covmap_gain::GainCache::refresh_bounds`]). Where a gain that is
//! evaluated is above its bound, all candidates are evaluated; a candidate that was passed over
//! because its bound is too low, while all that were evaluated keep theirs, stays passed over.

use crate::decision::{REPORTED, Score};
use crate::{CandidateRecord, Planner};
use covmap_gain::{GAIN_TOLERANCE, ViewPoints};

/// So many candidates are evaluated first; then all that may still be better. To evaluate a few
/// more costs less than another turn.
const FIRST: usize = 64;

impl Planner {
    /// Fills in the scores of all records, with the gains of those that may have the largest gain,
    /// and may be among the best reported; for the others, with an upper bound in place of the
    /// gain. So whatever is close to the best by less than what the fast gains are off is evaluated.
    pub(crate) fn fill_deciding_gains(&mut self, records: &mut [CandidateRecord]) {
        let all = self.view_points(records);
        self.gains.refresh_bounds(&all);
        self.gains.take_exceeded();
        let largest = |records: &[CandidateRecord]| {
            GAIN_TOLERANCE * records.iter().map(|r| r.gain.abs()).fold(0.0, f64::max)
        };
        let score = self.score();
        if let Score::Weighted(_) = score {
            // Eq. (16) divides by the largest gain: this one first.
            self.settle(records, &all, 1, |record| record.gain, largest);
        }
        let off = |records: &[CandidateRecord]| score.uncertainty(records, GAIN_TOLERANCE);
        self.settle(records, &all, REPORTED, |record| record.score, off);
        if self.gains.take_exceeded() {
            self.gains.refresh_gains(&all);
            self.take_gains(records);
        }
    }

    /// Evaluates until no bound is among the `count` largest by a `key`, nor closer to them than
    /// both may be `off`.
    fn settle(
        &mut self,
        records: &mut [CandidateRecord],
        all: &ViewPoints,
        count: usize,
        key: impl Fn(&CandidateRecord) -> f64,
        off: impl Fn(&[CandidateRecord]) -> f64,
    ) {
        for turn in 0.. {
            let is_exact = self.take_gains(records);
            let mut doubtful = in_doubt(records, &is_exact, count, &key, off(records));
            if doubtful.is_empty() {
                return;
            }
            if turn == 0 && doubtful.len() > FIRST {
                let larger = |a: &usize, b: &usize| key(&records[*b]).total_cmp(&key(&records[*a]));
                doubtful.select_nth_unstable_by(FIRST, larger);
                doubtful.truncate(FIRST);
            }
            self.evaluate(records, &doubtful, all);
        }
    }

    /// Evaluates some records' gains, and those of their neighbours: side by side they cost nothing.
    fn evaluate(&mut self, records: &[CandidateRecord], places: &[usize], all: &ViewPoints) {
        let mut wanted = ViewPoints::new(&self.grid);
        let indices = places.iter().filter_map(|i| self.grid.index(records[*i].cell));
        indices.for_each(|index| wanted.insert_neighbours(all, index));
        self.gains.refresh_gains(&wanted);
    }

    /// Fills in gains, or bounds, and scores. Returns which are gains.
    fn take_gains(&self, records: &mut [CandidateRecord]) -> Vec<bool> {
        let take = |record: &mut CandidateRecord| {
            let Some(index) = self.grid.index(record.cell) else { return true };
            record.gain = self.gains.gain(index);
            self.gains.is_exact(index)
        };
        let is_exact = records.iter_mut().map(take).collect();
        self.score().apply(records);
        is_exact
    }
}

/// The places of the records with a bound that may be among the `count` largest by a `key`, if both
/// that and the keys of gains may be `off`.
fn in_doubt(
    records: &[CandidateRecord],
    is_exact: &[bool],
    count: usize,
    key: impl Fn(&CandidateRecord) -> f64,
    off: f64,
) -> Vec<usize> {
    let exact = records.iter().zip(is_exact).filter(|(_, exact)| **exact);
    let mut keys: Vec<f64> = exact.map(|(record, _)| key(record)).collect();
    keys.sort_unstable_by(|a, b| b.total_cmp(a));
    let least = keys.get(count - 1).map_or(f64::NEG_INFINITY, |k| k - 2.0 * off);
    (0..records.len()).filter(|i| !is_exact[*i] && key(&records[*i]) >= least).collect()
}
