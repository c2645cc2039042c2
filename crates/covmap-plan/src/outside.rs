//! Strategies from outside: whoever uses the crate chooses among the candidates.

use crate::decision::Contest;
use crate::planner::Candidates;
use crate::{CandidateRecord, Decision, Planner};
use covmap::{Cell, CoverageMap};

impl Planner {
    /// Chooses the next view-point for a robot in the cell `from` by a strategy of one's own. It is given
    /// all candidates that a scan is worth its while at, with gains, costs and the scores of the planner's
    /// strategy, in row-major order, and returns the place of one of them in this list.
    ///
    /// Candidates, certificate and stall rule are the same for every strategy, so that a run ends whatever
    /// is chosen: a scan from a candidate lowers entropies, or counts against the cells that were its reason.
    /// All gains are evaluated, where [`choose`](Self::choose) evaluates those that may decide.
    ///
    /// `None` if there is no candidate, or the strategy returns none, or a place outside of the list.
    ///
    /// # Panics
    /// If the robot's cell lies outside of the grid.
    pub fn choose_by(
        &mut self,
        map: &CoverageMap,
        from: Cell,
        strategy: impl FnOnce(&[CandidateRecord]) -> Option<usize>,
    ) -> Option<Decision> {
        let (candidates, towards_ground) = self.worthwhile(map, from)?;
        let mut contest = Contest::new(self.records(&candidates, from), self.score());
        self.fill_gains(&mut contest.records);
        contest.apply();
        let chosen = strategy(&contest.records)?;
        let target = contest.records.get(chosen)?.cell;
        Some(Decision {
            towards_ground,
            ..self.decision(&candidates, from, (target, contest.records, 0))?
        })
    }

    /// The candidates that promise enough: those in reach; else those that look at what keeps the robot off
    /// more ground, which is told; else those beyond a passage.
    fn worthwhile(&mut self, map: &CoverageMap, from: Cell) -> Option<(Candidates, bool)> {
        let least = self.least_change;
        if let Some(mut near) = self.windowed_candidates(map, from) {
            self.leave_out_vain(map, &mut near.indices, least);
            if !near.indices.is_empty() {
                return Some((near, false));
            }
        }
        if let Some((mut towards, least)) = self.candidates_towards_ground(map, from) {
            self.leave_out_vain(map, &mut towards.indices, Some(least));
            if !towards.indices.is_empty() {
                return Some((towards, true));
            }
        }
        let mut beyond = self.candidates_beyond_a_passage(map, from)?;
        self.leave_out_vain(map, &mut beyond.indices, least);
        (!beyond.indices.is_empty()).then_some((beyond, false))
    }
}
