//! Strategies from outside: the user of the crate chooses among the candidates.

use crate::decision::Contest;
use crate::planner::Candidates;
use crate::planner::search::Search;
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
        let mut searches = Search::IN_ORDER.into_iter();
        let (candidates, search) =
            searches.find_map(|search| self.worthwhile(map, from, search))?;
        let mut contest = Contest::new(self.records(&candidates, from), self.score());
        self.fill_gains(&mut contest.records);
        contest.apply();
        let chosen = strategy(&contest.records)?;
        let target = contest.records.get(chosen)?.cell;
        Some(Decision {
            towards_ground: search == Search::TowardsGround,
            ..self.decision(&candidates, from, (target, contest.records, 0))?
        })
    }

    /// The candidates of a search that promise enough; `None` without any.
    fn worthwhile(
        &mut self,
        map: &CoverageMap,
        from: Cell,
        search: Search,
    ) -> Option<(Candidates, Search)> {
        let (mut candidates, least) = self.searched(map, from, search)?;
        self.leave_out_vain(map, &mut candidates.indices, least);
        (!candidates.indices.is_empty()).then_some((candidates, search))
    }
}
