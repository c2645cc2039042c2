//! The interface of strategies: a score over candidates.

use crate::{CandidateRecord, TravelCosts};
use covmap::{Cell, CoverageMap};

/// The situation in which a decision is taken.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// The belief.
    pub map: &'a CoverageMap,
    /// The robot's cell.
    pub from: Cell,
    /// The shortest ways from the robot's cell.
    pub ways: &'a TravelCosts,
}

/// A strategy that scores the candidates.
///
/// The planner chooses the candidate with the largest score, of equal ones the first.
///
/// Candidates, certificate and stall rule are the same for every strategy. So a run ends with any choice: a
/// scan from a candidate lowers entropies, or counts against the cells that were its reason.
///
/// A closure from a candidate to its score is a strategy, too.
pub trait Scoring {
    /// Fills in the score of every candidate, from its gain, its cost or any other data.
    ///
    /// A score of −∞ is never chosen. The candidates are in row-major order. The planner calls this again
    /// whenever it knows more of their gains.
    fn score(&mut self, situation: &Situation<'_>, candidates: &mut [CandidateRecord]);

    /// Returns the error of a score if every gain may be off by `tolerance` times the largest absolute gain.
    ///
    /// A strategy that returns a number promises that no score falls when a gain rises. Upper bounds of gains
    /// are then upper bounds of scores, and the planner evaluates only the gains that may decide. With `None`
    /// it evaluates all gains.
    fn uncertainty(&self, candidates: &[CandidateRecord], tolerance: f64) -> Option<f64> {
        let _ = (candidates, tolerance);
        None
    }

    /// Whether scores depend on gains; if not, the planner only evaluates the gains that it reports.
    fn uses_gain(&self) -> bool {
        true
    }
}

impl<F: FnMut(&CandidateRecord) -> f64> Scoring for F {
    fn score(&mut self, _: &Situation<'_>, candidates: &mut [CandidateRecord]) {
        candidates.iter_mut().for_each(|candidate| candidate.score = self(candidate));
    }
}
