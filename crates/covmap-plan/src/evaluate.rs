//! Evaluating no more candidates than the choice needs.
//!
//! Every candidate has an upper bound of its E\[I\]; in the order of the bounds they are
//! evaluated until none that is left can be among the best. The result is as if all had been.

use crate::beam_cache::{BeamCache, Upto};
use crate::cells::Cells;
use crate::decision::Score;
use crate::{CandidateRecord, GAIN_TOLERANCE};
use covmap::Grid;

/// How many candidates a decision reports.
pub(crate) const REPORTED: usize = 5;
/// How many candidates are evaluated at once, at first.
const BATCH: usize = 32;

/// Who evaluates.
pub(crate) struct Evaluation<'a> {
    pub(crate) grid: &'a Grid,
    pub(crate) cells: &'a Cells,
    pub(crate) beams: &'a mut BeamCache,
    pub(crate) score: Score,
}

/// What the candidates are sorted by: first their gain, since Eq. (16) divides by the largest,
/// then their score.
#[derive(Clone, Copy)]
enum Rank {
    Gain,
    Score,
}

impl Evaluation<'_> {
    fn index(&self, record: &CandidateRecord) -> usize {
        self.grid.index(record.cell).unwrap_or(0)
    }

    /// Fills in the exact gains of all records.
    pub(crate) fn all(&mut self, records: &mut [CandidateRecord]) {
        let needed = vec![f64::NEG_INFINITY; records.len()];
        let all: Vec<usize> = (0..records.len()).collect();
        self.fill(records, &all, &needed, Upto::Gain);
    }

    /// Fills in gains and scores until the best are exact, and all that could be among them;
    /// the others keep an upper bound.
    pub(crate) fn best(&mut self, records: &mut [CandidateRecord]) {
        let all: Vec<usize> = (0..records.len()).collect();
        self.fill(records, &all, &vec![0.0; records.len()], Upto::Bound);
        if matches!(self.score, Score::Weighted(_)) {
            self.until_exact(records, Rank::Gain, 1);
        }
        self.until_exact(records, Rank::Score, REPORTED);
    }

    /// Evaluates candidates until the first `count` by rank are exact.
    fn until_exact(&mut self, records: &mut [CandidateRecord], rank: Rank, count: usize) {
        for batch in (0..).map(|round| BATCH << round.min(8)) {
            self.score.apply(records);
            let enough = self.rank_of_last(records, rank, count);
            let inexact = self.contenders(records, rank, enough);
            if inexact.is_empty() {
                return;
            }
            let needed = self.gains_for(records, rank, enough);
            self.fill(records, &inexact[..batch.min(inexact.len())], &needed, Upto::Gain);
        }
    }

    /// The rank that a candidate needs to belong to the first `count`, with what rounding
    /// may hide taken off.
    fn rank_of_last(&self, records: &[CandidateRecord], rank: Rank, count: usize) -> f64 {
        let exact = records.iter().filter(|r| self.beams.is_exact(self.index(r)));
        let mut known: Vec<f64> = exact.map(|r| rank.of(r)).collect();
        known.sort_by(|a, b| b.total_cmp(a));
        let uncertain = match rank {
            Rank::Gain => Score::Gain.uncertainty(records, GAIN_TOLERANCE),
            Rank::Score => self.score.uncertainty(records, GAIN_TOLERANCE),
        };
        known.get(count - 1).map_or(f64::NEG_INFINITY, |last| last - 4.0 * uncertain)
    }

    /// The candidates without an exact gain that may reach a rank, best first.
    fn contenders(&self, records: &[CandidateRecord], rank: Rank, enough: f64) -> Vec<usize> {
        let mut inexact: Vec<usize> = (0..records.len())
            .filter(|i| {
                rank.of(&records[*i]) >= enough && !self.beams.is_exact(self.index(&records[*i]))
            })
            .collect();
        let better = |a: &usize, b: &usize| rank.of(&records[*b]).total_cmp(&rank.of(&records[*a]));
        inexact.sort_by(|a, b| better(a, b).then(a.cmp(b)));
        inexact
    }

    /// The gain below which each candidate cannot reach a rank.
    fn gains_for(&self, records: &[CandidateRecord], rank: Rank, enough: f64) -> Vec<f64> {
        let max_gain = records.iter().map(|r| r.gain).fold(0.0, f64::max);
        let needed = |r: &CandidateRecord| match (rank, self.score) {
            (Rank::Score, Score::Weighted(alpha)) if alpha > 0.0 => {
                (enough + r.cost_term) * max_gain / alpha
            }
            (Rank::Score, Score::Weighted(_) | Score::Closest) => f64::NEG_INFINITY,
            (Rank::Gain, _) | (_, Score::Gain) => enough,
        };
        records.iter().map(needed).collect()
    }

    /// Brings the gains of some records up to date, each at least as far as to see whether it
    /// is below what is needed.
    fn fill(
        &mut self,
        records: &mut [CandidateRecord],
        which: &[usize],
        needed: &[f64],
        upto: Upto,
    ) {
        let mut least = vec![f64::INFINITY; self.grid.len()];
        for i in which {
            // What a record has now must not count as too little by rounding: each call
            // evaluates at least one beam of each, so that this ends.
            let has = records[*i].gain;
            least[self.index(&records[*i])] = needed[*i].min(has - 1e-9 * has.abs());
        }
        self.beams.refresh(self.cells, &least, upto);
        which.iter().for_each(|i| records[*i].gain = self.beams.gain(self.index(&records[*i])));
    }
}

impl Rank {
    fn of(self, record: &CandidateRecord) -> f64 {
        match self {
            Rank::Gain => record.gain,
            Rank::Score => record.score,
        }
    }
}
