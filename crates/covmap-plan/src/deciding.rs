//! The gains that decide: the planner bounds all candidates, and evaluates those that may be the best.
//!
//! The bounds are measured on probes and not proven ([`covmap_gain::GainCache::refresh_bounds`]). If an
//! evaluated gain exceeds its bound, the planner evaluates all candidates. If none does, a candidate that
//! was left out because its bound is too low stays left out.

use crate::decision::{Contest, REPORTED};
use crate::parameters::LeastChange;
use crate::{CandidateRecord, Planner};
use covmap::CoverageMap;
use covmap_gain::{BeamStencil, GAIN_TOLERANCE, ViewPoints, expected_changes};
use rayon::prelude::*;

/// Largest number of candidates evaluated in the first turn; it doubles with each turn, as a few more
/// evaluations cost less than another turn.
const FIRST: usize = 64;

impl Planner {
    /// Passes over candidates until the best ones promise enough. This keeps the order of the strategy:
    /// only candidates from which a scan would be in vain are passed over.
    pub(crate) fn fill_and_pass_over(
        &mut self,
        map: &CoverageMap,
        contest: &mut Contest<'_>,
        least: Option<LeastChange>,
    ) {
        if contest.scoring.uses_gain() {
            let all = self.view_points(&contest.records);
            self.gains.refresh_bounds(&all);
        } else if least.is_none() {
            return;
        }
        if let Some(least) = least {
            self.known_in_vain(contest, least).into_iter().for_each(|i| contest.pass_over(i));
        }
        loop {
            self.fill_deciding_gains(contest);
            let vain = match least {
                None => return,
                Some(least) if self.gains.tells_cells_apart() => self.known_in_vain(contest, least),
                Some(least) => self.best_in_vain(map, contest, least),
            };
            if vain.is_empty() {
                return;
            }
            vain.into_iter().for_each(|place| contest.pass_over(place));
        }
    }

    /// The places of the candidates whose promise, or its bound, is not enough; none if the gains do not
    /// tell the cells apart.
    fn known_in_vain(&self, contest: &Contest<'_>, least: LeastChange) -> Vec<usize> {
        let index = |place: &usize| self.grid.index(contest.records[*place].cell);
        let is_in_vain = |i: usize| self.gains.promise(i) < least.scan;
        contest.left().filter(|place| index(place).is_some_and(is_in_vain)).collect()
    }

    /// The places of the best candidates that are evaluated and do not promise enough by the literal
    /// equations, which are too slow for all candidates.
    fn best_in_vain(
        &self,
        map: &CoverageMap,
        contest: &Contest<'_>,
        least: LeastChange,
    ) -> Vec<usize> {
        let records = &contest.records;
        let is_in_vain = |place: &usize| {
            let index = self.grid.index(records[*place].cell);
            index.is_some_and(|i| self.gains.is_exact(i) && !self.promises(map, i, least))
        };
        let mut places: Vec<usize> = contest.left().collect();
        let better =
            |a: &usize, b: &usize| records[*b].score.total_cmp(&records[*a].score).then(a.cmp(b));
        places.sort_by(better);
        places.truncate(REPORTED);
        places.into_par_iter().filter(is_in_vain).collect()
    }

    /// Leaves out the candidates that would measure in vain.
    pub(crate) fn leave_out_vain(
        &mut self,
        map: &CoverageMap,
        candidates: &mut Vec<usize>,
        least: Option<LeastChange>,
    ) {
        let Some(least) = least else { return };
        self.gains.refresh_gains(&ViewPoints::of(&self.grid, candidates.iter().copied()));
        let promises = |index: &usize| self.promises(map, *index, least);
        *candidates = candidates.par_iter().copied().filter(promises).collect();
    }

    /// Whether a scan from a view-point is expected to tell enough about the cells that are reasons to go
    /// there. The gain of the view-point must be up to date.
    pub(crate) fn promises(&self, map: &CoverageMap, index: usize, least: LeastChange) -> bool {
        if self.gains.tells_cells_apart() {
            return self.gains.promise(index) >= least.scan;
        }
        let (view_point, stencil) = (self.grid.cell(index), self.stencil());
        let prediction = self.prediction_at(view_point);
        let of_beam = |beam: &BeamStencil| -> f64 {
            let changes = expected_changes(map, &self.model, stencil, beam, prediction, view_point);
            let reasons = beam.cells.iter().zip(changes).filter(|(met, change)| {
                let cell = self.grid.index(view_point.offset(met.dx, met.dy));
                #[allow(clippy::cast_possible_truncation, reason = "limits are f32")]
                let distance = met.cell_distance as f32;
                *change >= least.cell && cell.is_some_and(|cell| self.is_reason(cell, distance))
            });
            reasons.map(|(_, change)| change).sum()
        };
        stencil.beams.iter().map(of_beam).sum::<f64>() >= least.scan
    }

    /// Fills in the scores of all records: with the gains of those that may have the largest gain or
    /// may be among the best reported, with upper bounds for the others. Every candidate whose distance
    /// to the best is within the error of the fast gains is evaluated.
    fn fill_deciding_gains(&mut self, contest: &mut Contest<'_>) {
        let all = self.view_points(&contest.records);
        self.take_gains(contest);
        self.gains.take_exceeded();
        if !contest.needs_all_gains() {
            if contest.scoring.uses_gain() {
                // Eq. (16) divides by the largest gain, as does the report of IG: the largest comes first.
                let largest = |contest: &Contest<'_>| {
                    let gains = contest.records.iter().map(|r| r.gain.abs());
                    GAIN_TOLERANCE * gains.fold(0.0, f64::max)
                };
                self.settle(contest, &all, 1, |record| record.gain, largest);
            }
            let off = |contest: &Contest<'_>| contest.uncertainty();
            self.settle(contest, &all, REPORTED, |record| record.score, off);
        }
        // The evaluated gains may turn out not to be positive, and bounds then do not tell the best.
        let exceeded = contest.scoring.uses_gain() && self.gains.take_exceeded();
        if exceeded || contest.needs_all_gains() {
            self.gains.refresh_gains(&all);
            self.take_gains(contest);
        }
    }

    /// Evaluates records until no bound is among the `count` largest by a `key`, or within the error
    /// `off` of both.
    fn settle(
        &mut self,
        contest: &mut Contest<'_>,
        all: &ViewPoints,
        count: usize,
        key: impl Fn(&CandidateRecord) -> f64,
        off: impl Fn(&Contest<'_>) -> f64,
    ) {
        for turn in 0.. {
            let is_exact = self.take_gains(contest);
            let off = off(contest);
            let records = &contest.records;
            let mut doubtful = in_doubt(records, &is_exact, count, &key, off);
            if doubtful.is_empty() {
                return;
            }
            let most = FIRST << turn.min(20);
            if doubtful.len() > most {
                let larger = |a: &usize, b: &usize| key(&records[*b]).total_cmp(&key(&records[*a]));
                doubtful.select_nth_unstable_by(most, larger);
                doubtful.truncate(most);
            }
            self.evaluate(records, &doubtful, all);
        }
    }

    /// Evaluates the gains of some records and of their neighbours, which cost nothing extra.
    fn evaluate(&mut self, records: &[CandidateRecord], places: &[usize], all: &ViewPoints) {
        let mut wanted = ViewPoints::new(&self.grid);
        let indices = places.iter().filter_map(|i| self.grid.index(records[*i].cell));
        indices.for_each(|index| wanted.insert_neighbours(all, index));
        self.gains.refresh_gains(&wanted);
    }

    /// Fills in gains or bounds, and scores. Returns for each record whether it holds a gain.
    fn take_gains(&self, contest: &mut Contest<'_>) -> Vec<bool> {
        let weighs = contest.scoring.uses_gain();
        let take = |record: &mut CandidateRecord| {
            let Some(index) = self.grid.index(record.cell) else { return true };
            let is_exact = self.gains.is_exact(index);
            record.gain = if is_exact || weighs { self.gains.gain(index) } else { 0.0 };
            is_exact
        };
        let is_exact = contest.records.iter_mut().map(take).collect();
        contest.apply();
        is_exact
    }
}

/// The places of the records with a bound that may be among the `count` largest by a `key`, if the
/// keys of bounds and of gains may both be `off`. A record with the key −∞ does not take part.
fn in_doubt(
    records: &[CandidateRecord],
    is_exact: &[bool],
    count: usize,
    key: impl Fn(&CandidateRecord) -> f64,
    off: f64,
) -> Vec<usize> {
    let takes_part = |i: &usize| key(&records[*i]) > f64::NEG_INFINITY;
    let exact = (0..records.len()).filter(|i| is_exact[*i] && takes_part(i));
    let mut keys: Vec<f64> = exact.map(|i| key(&records[i])).collect();
    keys.sort_unstable_by(|a, b| b.total_cmp(a));
    let least = keys.get(count - 1).map_or(f64::NEG_INFINITY, |k| k - 2.0 * off);
    let doubtful = |i: &usize| !is_exact[*i] && takes_part(i) && key(&records[*i]) >= least;
    (0..records.len()).filter(doubtful).collect()
}
