//! The order in which the planner searches for candidates.

use super::Candidates;
use crate::Planner;
use crate::parameters::LeastChange;
use covmap::{Cell, CoverageMap};

/// Where the planner searches for candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Search {
    /// In reach; for IG_WIN in the window.
    InReach,
    /// Where something keeps the robot off more ground.
    TowardsGround,
    /// Beyond a passage that looks blocked.
    BeyondPassage,
}

impl Search {
    /// Each search runs only if the one before it found nothing.
    pub(crate) const IN_ORDER: [Self; 3] =
        [Self::InReach, Self::TowardsGround, Self::BeyondPassage];
}

impl Planner {
    /// The candidates of a search, and what a scan must be expected to change there; `None` if there is none.
    pub(crate) fn searched(
        &mut self,
        map: &CoverageMap,
        from: Cell,
        search: Search,
    ) -> Option<(Candidates, Option<LeastChange>)> {
        let least = self.least_change;
        Some(match search {
            Search::InReach => (self.windowed_candidates(map, from)?, least),
            Search::TowardsGround => {
                let (towards, least) = self.candidates_towards_ground(map, from)?;
                (towards, Some(least))
            }
            Search::BeyondPassage => (self.candidates_beyond_a_passage(map, from)?, least),
        })
    }
}
