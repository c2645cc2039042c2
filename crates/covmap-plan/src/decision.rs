//! Choosing one of the candidates: Eq. (12), (15) and (16).

use crate::{CandidateRecord, Scoring, Situation};
use covmap_gain::GAIN_TOLERANCE;

/// The number of candidates that a decision reports.
pub(crate) const REPORTED: usize = 5;

/// The scores of the paper's strategies.
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
    /// with both maxima over the same candidates. Choice: where no gain is positive, gains are divided by the
    /// largest absolute one, so that a large α remains IG; where all gains are 0 the first term is 0 for all,
    /// and where all costs are 0 the second.
    pub(crate) fn fill(self, candidates: &mut [CandidateRecord]) {
        let largest = |f: fn(&CandidateRecord) -> f64| candidates.iter().map(f).fold(0.0, f64::max);
        let (positive, max_cost) = (largest(|c| c.gain), largest(|c| c.cost));
        let max_gain = if positive > 0.0 { positive } else { largest(|c| c.gain.abs()) };
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
}

impl Scoring for Score {
    fn score(&mut self, _: &Situation<'_>, candidates: &mut [CandidateRecord]) {
        self.fill(candidates);
    }

    fn uncertainty(&self, candidates: &[CandidateRecord], tolerance: f64) -> Option<f64> {
        let largest = candidates.iter().map(|c| c.gain.abs()).fold(0.0, f64::max);
        let positive = candidates.iter().map(|c| c.gain).fold(0.0, f64::max);
        match self {
            Score::Closest => Some(0.0),
            Score::Gain => Some(tolerance * largest),
            Score::Weighted(alpha) if positive > 0.0 => {
                // The numerator and the denominator may both be off.
                Some(alpha * tolerance * largest / positive * (1.0 + largest / positive))
            }
            // The largest absolute gain is the lowest, of which bounds say nothing.
            Score::Weighted(_) => None,
        }
    }

    fn uses_gain(&self) -> bool {
        *self != Score::Closest
    }
}

/// The candidates of a decision, in row-major order of cells. Candidates that are passed over count
/// for the maxima of Eq. (16), but are not chosen.
pub(crate) struct Contest<'a> {
    pub(crate) records: Vec<CandidateRecord>,
    pub(crate) scoring: &'a mut dyn Scoring,
    situation: Situation<'a>,
    passed_over: Vec<bool>,
}

impl<'a> Contest<'a> {
    pub(crate) fn new(
        records: Vec<CandidateRecord>,
        scoring: &'a mut dyn Scoring,
        situation: Situation<'a>,
    ) -> Self {
        let passed_over = vec![false; records.len()];
        let mut contest = Self { records, scoring, situation, passed_over };
        contest.apply();
        contest
    }

    /// Scores the candidates anew.
    pub(crate) fn apply(&mut self) {
        self.scoring.score(&self.situation, &mut self.records);
        for (record, passed_over) in self.records.iter_mut().zip(&self.passed_over) {
            if *passed_over {
                record.score = f64::NEG_INFINITY;
            }
        }
    }

    /// The error of a score that follows from the error of the fast gains; 0 if all gains are evaluated.
    pub(crate) fn uncertainty(&self) -> f64 {
        self.scoring.uncertainty(&self.records, GAIN_TOLERANCE).unwrap_or(0.0)
    }

    /// Whether bounds of gains do not tell which candidates may be the best.
    pub(crate) fn needs_all_gains(&self) -> bool {
        let known = self.scoring.uncertainty(&self.records, GAIN_TOLERANCE);
        self.scoring.uses_gain() && known.is_none()
    }

    /// Passes over a candidate.
    pub(crate) fn pass_over(&mut self, place: usize) {
        self.passed_over[place] = true;
        self.records[place].score = f64::NEG_INFINITY;
    }

    /// The places of the candidates that are not passed over.
    pub(crate) fn left(&self) -> impl Iterator<Item = usize> {
        (0..self.records.len()).filter(|place| !self.passed_over[*place])
    }

    /// The place of the best score; of equal scores the first, and never one of −∞.
    pub(crate) fn best(&self) -> Option<usize> {
        let score = |place: usize| self.records[place].score;
        let left = self.left().filter(|place| score(*place) > f64::NEG_INFINITY);
        left.fold(None, |best: Option<usize>, i| match best {
            Some(b) if score(i).total_cmp(&score(b)).is_le() => Some(b),
            _ => Some(i),
        })
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use crate::travel_costs;
    use covmap::{Cell, CoverageMap, Grid, Steps};
    use nalgebra::Point2;
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

    /// The result of a contest on a grid of one cell.
    fn contest<T>(
        mut score: Score,
        values: &[(f64, f64)],
        then: impl FnOnce(&mut Contest<'_>) -> T,
    ) -> T {
        let grid = Grid::new(Point2::origin(), 1.0, 1, 1).unwrap();
        let map = CoverageMap::new(grid, 2).unwrap();
        let from = Cell::new(0, 0);
        let ways = travel_costs(Steps::between(&grid, |_| true), from);
        let situation = Situation { map: &map, from, ways: &ways };
        then(&mut Contest::new(table(values), &mut score, situation))
    }

    fn choose(score: Score, values: &[(f64, f64)]) -> Option<usize> {
        contest(score, values, |contest| contest.best())
    }

    #[test]
    fn who_is_passed_over_still_counts_for_the_maxima() {
        let values = [(1.0, 1.0), (10.0, 8.0), (5.0, 2.0)];
        contest(Score::Weighted(1.0), &values, |contest| {
            contest.pass_over(2);
            contest.apply();
            assert_eq!(contest.best(), Some(1));
            assert_eq!(contest.records[0].gain_term, 0.1);
            assert_eq!(contest.left().collect::<Vec<_>>(), [0, 1]);
        });
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
        // .3 · −1 − 2/3, .3 · −.1 − 1/3, 0 − 1.
        assert_eq!(choose(Score::Weighted(0.3), &[(-1.0, 2.0), (-0.1, 1.0), (0.0, 3.0)]), Some(1));
        // 2 · −1 − 1/2, 2 · −.1 − 1: the gain decides, though none is positive.
        assert_eq!(choose(Score::Weighted(2.0), &[(-1.0, 1.0), (-0.1, 2.0)]), Some(1));
        assert_eq!(choose(Score::Weighted(0.3), &[(1.0, 0.0), (2.0, 0.0)]), Some(1));
        assert_eq!(choose(Score::Weighted(0.3), &[(0.0, 0.0), (0.0, 0.0)]), Some(0));
        assert_eq!(choose(Score::Gain, &[]), None);
    }

    proptest! {
        #[test]
        fn alpha_zero_is_closest_location_and_large_alpha_is_maximum_gain(
            below in 0.0..20.0f64,
            values in prop::collection::vec((-1.0..10.0f64, 0.0..20.0f64), 1..30)
        ) {
            let values: Vec<(f64, f64)> = values.into_iter().map(|(g, c)| (g - below, c)).collect();
            prop_assert_eq!(choose(Score::Weighted(0.0), &values), choose(Score::Closest, &values));
            if values.iter().any(|(gain, _)| gain.abs() > 1e-6) {
                prop_assert_eq!(choose(Score::Weighted(1e9), &values), choose(Score::Gain, &values));
            }
        }
    }
}
