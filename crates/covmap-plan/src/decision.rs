//! Choosing one of the candidates: Eq. (12), (15) and (16).

use covmap::Cell;
use serde::{Deserialize, Serialize};

/// How many candidates a decision reports.
pub(crate) const REPORTED: usize = 5;

/// A candidate view-point with all that speaks for and against it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CandidateRecord {
    /// The view-point l.
    pub cell: Cell,
    /// E\[I(l)\] \[nats\].
    pub gain: f64,
    /// d_c(l, x) \[m\]; for IG_CL with what turns cost, `planner.turn_cost`.
    pub cost: f64,
    /// The first term of Eq. (16); for other strategies with α = 1.
    pub gain_term: f64,
    /// The second term of Eq. (16), without its sign.
    pub cost_term: f64,
    /// What the strategy maximises: the negative cost for CL, the gain for IG and IG_WIN,
    /// the bracket of Eq. (16) for IG_CL.
    pub score: f64,
}

/// A decision that explains itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// The chosen view-point.
    pub target: Cell,
    /// The corners of the way there, cells between whose centres it leads straight, without the one the
    /// robot is in, with the target; empty if the robot stays in its cell.
    pub path: Vec<Cell>,
    /// The cells of the passage that the robot tries, though they look blocked: it can reach
    /// no candidate but beyond them. Mostly none.
    pub passage: Vec<Cell>,
    /// No scan is worth its while: this one looks at what keeps the robot off more ground.
    pub towards_ground: bool,
    /// The number of candidates, |L(c)|.
    pub candidates: usize,
    /// How many of them have E\[I\] < 0, of those that were evaluated: of most candidates an upper
    /// bound tells that others are better.
    pub negative_gains: usize,
    /// How many were so close to the best that the literal equations decided between them.
    pub decided_by_oracle: usize,
    /// The five best.
    pub best: Vec<CandidateRecord>,
}

/// How a strategy scores candidates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Score {
    /// argmin d_c, Eq. (12).
    Closest,
    /// argmax E\[I\], Eq. (15).
    Gain,
    /// Eq. (16) with the weight α.
    Weighted(f64),
}

impl Score {
    /// Fills in the terms and the scores:
    ///
    /// ```text
    /// α · E\[I(l)\] / max E\[I(l')\] − d_c(l, x) / max d_c(l', x)
    /// ```
    ///
    /// with both maxima over the same candidates. Choice: where no gain is positive the
    /// first term is 0 for all, and where all costs are 0 the second.
    pub(crate) fn apply(self, candidates: &mut [CandidateRecord]) {
        let largest = |f: fn(&CandidateRecord) -> f64| candidates.iter().map(f).fold(0.0, f64::max);
        let (max_gain, max_cost) = (largest(|c| c.gain), largest(|c| c.cost));
        let share = |value: f64, max: f64| if max > 0.0 { value / max } else { 0.0 };
        let alpha = if let Score::Weighted(alpha) = self { alpha } else { 1.0 };
        for candidate in candidates {
            candidate.gain_term = alpha * share(candidate.gain, max_gain);
            candidate.cost_term = share(candidate.cost, max_cost);
            candidate.score = match self {
                Score::Closest => -candidate.cost,
                Score::Gain => candidate.gain,
                Score::Weighted(_) => candidate.gain_term - candidate.cost_term,
            };
        }
    }

    /// How much a score may be off if every gain may be off by `tolerance` times the largest
    /// absolute gain.
    pub(crate) fn uncertainty(self, candidates: &[CandidateRecord], tolerance: f64) -> f64 {
        let largest = candidates.iter().map(|c| c.gain.abs()).fold(0.0, f64::max);
        let positive = candidates.iter().map(|c| c.gain).fold(0.0, f64::max);
        match self {
            Score::Closest => 0.0,
            Score::Gain => tolerance * largest,
            Score::Weighted(alpha) if positive > 0.0 => {
                // The numerator and the denominator may both be off.
                alpha * tolerance * largest / positive * (1.0 + largest / positive)
            }
            Score::Weighted(_) => 0.0,
        }
    }
}

/// The candidates of a decision, in row-major order of cells, and which of them are passed over:
/// they count for the maxima of Eq. (16), but are not chosen.
#[derive(Debug)]
pub(crate) struct Contest {
    pub(crate) records: Vec<CandidateRecord>,
    pub(crate) score: Score,
    passed_over: Vec<bool>,
}

impl Contest {
    pub(crate) fn new(records: Vec<CandidateRecord>, score: Score) -> Self {
        let passed_over = vec![false; records.len()];
        let mut contest = Self { records, score, passed_over };
        contest.apply();
        contest
    }

    /// Scores anew.
    pub(crate) fn apply(&mut self) {
        self.score.apply(&mut self.records);
        for (record, passed_over) in self.records.iter_mut().zip(&self.passed_over) {
            if *passed_over {
                record.score = f64::NEG_INFINITY;
            }
        }
    }

    /// Passes over a candidate.
    pub(crate) fn pass_over(&mut self, place: usize) {
        self.passed_over[place] = true;
        self.records[place].score = f64::NEG_INFINITY;
    }

    /// The places of those that are not passed over.
    pub(crate) fn left(&self) -> impl Iterator<Item = usize> {
        (0..self.records.len()).filter(|place| !self.passed_over[*place])
    }

    /// The place of the best score; a tie is the first.
    pub(crate) fn best(&self) -> Option<usize> {
        let score = |place: usize| self.records[place].score;
        self.left().fold(None, |best: Option<usize>, i| match best {
            Some(b) if score(i).total_cmp(&score(b)).is_le() => Some(b),
            _ => Some(i),
        })
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table(values: &[(f64, f64)]) -> Vec<CandidateRecord> {
        let record = |(i, (gain, cost)): (usize, &(f64, f64))| CandidateRecord {
            cell: Cell::new(i32::try_from(i).unwrap(), 0),
            gain: *gain,
            cost: *cost,
            gain_term: 0.0,
            cost_term: 0.0,
            score: 0.0,
        };
        values.iter().enumerate().map(record).collect()
    }

    fn choose(score: Score, values: &[(f64, f64)]) -> Option<usize> {
        Contest::new(table(values), score).best()
    }

    #[test]
    fn who_is_passed_over_still_counts_for_the_maxima() {
        let mut contest =
            Contest::new(table(&[(1.0, 1.0), (10.0, 8.0), (5.0, 2.0)]), Score::Weighted(1.0));
        contest.pass_over(2);
        contest.apply();
        assert_eq!(contest.best(), Some(1));
        assert_eq!(contest.records[0].gain_term, 0.1);
        assert_eq!(contest.left().collect::<Vec<_>>(), [0, 1]);
    }

    #[test]
    fn gain_is_weighed_against_travel_cost() {
        let values = [(1.0, 1.0), (10.0, 8.0), (5.0, 2.0)];
        assert_eq!(choose(Score::Closest, &values), Some(0));
        assert_eq!(choose(Score::Gain, &values), Some(1));
        assert_eq!(choose(Score::Weighted(1.0), &values), Some(2));
    }

    #[test]
    fn the_result_is_defined_when_nothing_is_gained_and_nothing_costs() {
        assert_eq!(choose(Score::Weighted(0.3), &[(-1.0, 2.0), (-0.1, 1.0), (0.0, 3.0)]), Some(1));
        assert_eq!(choose(Score::Weighted(0.3), &[(1.0, 0.0), (2.0, 0.0)]), Some(1));
        assert_eq!(choose(Score::Weighted(0.3), &[(0.0, 0.0), (0.0, 0.0)]), Some(0));
        assert_eq!(choose(Score::Gain, &[]), None);
    }

    proptest! {
        #[test]
        fn alpha_zero_is_closest_location_and_large_alpha_is_maximum_gain(
            values in prop::collection::vec((-1.0..10.0f64, 0.0..20.0f64), 1..30)
        ) {
            prop_assert_eq!(choose(Score::Weighted(0.0), &values), choose(Score::Closest, &values));
            if values.iter().any(|(gain, _)| *gain > 0.0) {
                prop_assert_eq!(choose(Score::Weighted(1e9), &values), choose(Score::Gain, &values));
            }
        }
    }
}
