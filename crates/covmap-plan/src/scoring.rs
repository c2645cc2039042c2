//! The one door for strategies: a score over candidates.

use crate::{CandidateRecord, TravelCosts};
use covmap::{Cell, CoverageMap};

/// Where a decision is taken.
#[derive(Debug, Clone, Copy)]
pub struct Situation<'a> {
    /// The belief.
    pub map: &'a CoverageMap,
    /// The robot's cell.
    pub from: Cell,
    /// The shortest ways from there.
    pub ways: &'a TravelCosts,
}

/// A strategy: it scores the candidates, and the planner chooses the largest score, of equal ones the first.
///
/// Candidates, certificate and stall rule are the same for every strategy, so that a run ends whatever is
/// chosen: a scan from a candidate lowers entropies, or counts against the cells that were its reason.
///
/// A closure from a candidate to its score is a strategy, too.
pub trait Scoring {
    /// Fills in the score of every candidate, from its gain, its cost, or whatever else; −∞ is never chosen.
    /// The candidates are in row-major order. This is called again whenever more is known of their gains.
    fn score(&mut self, situation: &Situation<'_>, candidates: &mut [CandidateRecord]);

    /// How much a score may be off if every gain may be off by `tolerance` times the largest absolute gain.
    ///
    /// A strategy that says so promises that no score falls when a gain rises: upper bounds of gains are then
    /// upper bounds of scores, and only the gains that may decide are evaluated. `None`, and all are.
    fn uncertainty(&self, candidates: &[CandidateRecord], tolerance: f64) -> Option<f64> {
        let _ = (candidates, tolerance);
        None
    }

    /// Whether scores depend on gains; if not, the gains of the best are evaluated to be reported.
    fn uses_gain(&self) -> bool {
        true
    }
}

impl<F: FnMut(&CandidateRecord) -> f64> Scoring for F {
    fn score(&mut self, _: &Situation<'_>, candidates: &mut [CandidateRecord]) {
        candidates.iter_mut().for_each(|candidate| candidate.score = self(candidate));
    }
}
