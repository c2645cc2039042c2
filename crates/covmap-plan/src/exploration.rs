//! Exploration of each cell: when it is finished, and when it is given up.

use crate::{PlannerParameters, StallRule};
use covmap::{Cell, Grid, Raster};
use covmap_model::ScanCounts;
use serde::{Deserialize, Serialize};

/// Status of a cell in a certificate.
///
/// Each cell has the first status that applies, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum CellStatus {
    /// Outside of the environment's extent.
    Outside,
    /// Known, with an entropy of at most ε.
    Resolved,
    /// Given up: the entropy did not fall any longer from any distance, or no reachable view-point with
    /// the cell in sight is a candidate any longer.
    Exhausted,
    /// In sight of a reachable candidate: the cell is still to be measured.
    Open,
    /// Out of sight of all reachable view-points, or out of scope.
    Unreachable,
    /// Out of sight so far, but not cut off from the cells in sight; only in a run that was stopped
    /// while cells were open.
    NotSeen,
}

/// The kind of reachable view-point from which a cell is in sight within its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum InSight {
    /// No view-point.
    Nowhere,
    /// Only view-points that tell nothing new.
    Spent,
    /// A candidate.
    Candidate,
}

/// Progress of the measurements of one cell.
#[derive(Debug, Clone, Copy)]
struct CellProgress {
    /// R: the cell is a reason to go to a view-point up to this distance away \[m\].
    limit: f32,
    /// The lowest entropy of this distance band.
    lowest: f32,
    /// The nearest distance of the scans of the present stall.
    nearest: f32,
    stalled: u32,
    counted: u32,
    given_up: bool,
    capped: bool,
}

/// A scan that was expected to tell something about a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CountedScan {
    /// Row-major index of the cell.
    pub(crate) index: usize,
    /// Distance of the cell from the sensor [m].
    pub(crate) distance: f32,
    /// Entropy before the scan [nats].
    pub(crate) before: f32,
    /// Entropy after the scan [nats].
    pub(crate) after: f32,
}

/// The state of each cell: finished, given up, or the distance up to which it is a reason.
///
/// Every counted scan either lowers the lowest entropy of the cell's present distance band
/// by `min_entropy_change` or is one of at most `stall_limit` in a row, after which the band
/// is halved; so every cell ends after finitely many counted scans.
#[derive(Debug, Clone)]
pub(crate) struct Exploration {
    rule: StallRule,
    threshold: f64,
    min_change: f32,
    stall_limit: u32,
    max_counted: u32,
    outside: Vec<bool>,
    progress: Vec<CellProgress>,
    /// Of the counting strategies: the weights so far, and the weight that finishes a cell.
    counts: Option<(ScanCounts, f64)>,
}

impl Exploration {
    pub(crate) fn new(
        parameters: &PlannerParameters,
        usable_range: f64,
        outside: &Raster<bool>,
    ) -> Self {
        #[allow(clippy::cast_possible_truncation, reason = "distances are compared as f32")]
        let limit = match parameters.stall_rule {
            StallRule::Banded { first, .. } => first.min(usable_range) as f32,
            StallRule::Unbanded | StallRule::Literal => usable_range as f32,
        };
        let fresh = CellProgress {
            limit,
            lowest: f32::INFINITY,
            nearest: f32::INFINITY,
            stalled: 0,
            counted: 0,
            given_up: false,
            capped: false,
        };
        let counting = parameters.strategy.counting();
        let counts = counting.map(|(c, times)| (ScanCounts::new(*outside.grid(), c), times));
        #[allow(clippy::cast_possible_truncation, reason = "entropies are compared as f32")]
        let min_change = parameters.min_entropy_change as f32;
        Self {
            rule: if counts.is_some() { StallRule::Unbanded } else { parameters.stall_rule },
            threshold: parameters.entropy_threshold,
            min_change,
            stall_limit: parameters.stall_limit,
            max_counted: parameters.max_counted_scans,
            outside: outside.values().to_vec(),
            progress: vec![fresh; outside.values().len()],
            counts,
        }
    }

    /// Whether a cell lies outside of the environment's extent.
    pub(crate) fn is_outside(&self, index: usize) -> bool {
        self.outside[index]
    }

    /// The distance up to which a cell is a reason to measure \[m\]; 0 if the cell is finished, given up
    /// or outside.
    pub(crate) fn limit(&self, index: usize, known: bool, entropy: f64) -> f32 {
        let progress = &self.progress[index];
        let done =
            self.outside[index] || progress.given_up || self.is_resolved(index, known, entropy);
        if done { 0.0 } else { progress.limit }
    }

    /// Whether a cell is explored well enough.
    pub(crate) fn is_resolved(&self, index: usize, known: bool, entropy: f64) -> bool {
        match &self.counts {
            Some((counts, times)) => counts.weights()[index] >= *times,
            None => known && entropy <= self.threshold,
        }
    }

    /// The status of a cell.
    pub(crate) fn status(
        &self,
        index: usize,
        known: bool,
        entropy: f64,
        in_sight: InSight,
    ) -> CellStatus {
        if self.outside[index] {
            CellStatus::Outside
        } else if self.is_resolved(index, known, entropy) {
            CellStatus::Resolved
        } else if self.progress[index].given_up {
            CellStatus::Exhausted
        } else {
            match in_sight {
                InSight::Candidate => CellStatus::Open,
                InSight::Spent => CellStatus::Exhausted,
                InSight::Nowhere => CellStatus::Unreachable,
            }
        }
    }

    /// Adds the cells that a scan intercepted, if the strategy counts them.
    pub(crate) fn add_counts(&mut self, intercepted: impl FnOnce() -> Vec<(Cell, f64)>) {
        if let Some((counts, _)) = &mut self.counts {
            counts.add(&intercepted());
        }
    }

    /// The weight of a cell's scans; 0 if the strategy does not count.
    pub(crate) fn weight(&self, index: usize) -> f64 {
        self.counts.as_ref().map_or(0.0, |(counts, _)| counts.weights()[index])
    }

    /// Counts a scan for a cell. `touched` tells whether the cell's weight grew, for a counting strategy.
    pub(crate) fn count(&mut self, scan: CountedScan, touched: bool) {
        let CountedScan { index, distance, before, after } = scan;
        let counts_scans = self.counts.is_some();
        let progress = &mut self.progress[index];
        progress.counted += 1;
        let improved = match self.rule {
            _ if counts_scans => touched,
            StallRule::Literal => (after - before).abs() >= self.min_change,
            _ => after <= progress.lowest - self.min_change,
        };
        if improved {
            progress.lowest = after;
            (progress.stalled, progress.nearest) = (0, f32::INFINITY);
        } else {
            progress.stalled += 1;
            progress.nearest = progress.nearest.min(distance);
        }
        if progress.stalled >= self.stall_limit {
            progress.next_band(self.rule);
        }
        // A counting strategy may ask for more scans than the cap: its own count ends it.
        if progress.counted >= self.max_counted && !progress.given_up && !counts_scans {
            (progress.given_up, progress.capped) = (true, true);
        }
    }

    /// The number of cells given up by the cap on counted scans.
    pub(crate) fn capped_cells(&self) -> usize {
        self.progress.iter().filter(|p| p.capped).count()
    }

    /// The number of scans counted for each cell.
    pub(crate) fn counted_scans(&self, grid: Grid) -> Raster<u32> {
        Raster::from_fn(grid, |c| grid.index(c).map_or(0, |i| self.progress[i].counted))
    }
}

impl CellProgress {
    fn next_band(&mut self, rule: StallRule) {
        #[allow(clippy::cast_possible_truncation, reason = "distances are compared as f32")]
        let closest = match rule {
            StallRule::Banded { closest, .. } => closest as f32,
            StallRule::Unbanded | StallRule::Literal => f32::INFINITY,
        };
        self.limit = 0.5 * self.nearest.min(self.limit);
        self.given_up = self.limit < closest;
        (self.stalled, self.lowest, self.nearest) = (0, f32::INFINITY, f32::INFINITY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Strategy;
    use nalgebra::Point2;
    use proptest::prelude::*;
    use proptest::strategy::Strategy as _;

    fn exploration(change: impl Fn(&mut PlannerParameters)) -> Exploration {
        let mut parameters = PlannerParameters::standard();
        change(&mut parameters);
        let grid = Grid::new(Point2::origin(), 0.1, 1, 1).unwrap();
        Exploration::new(&parameters, 3.0, &Raster::filled(grid, false))
    }

    fn count(e: &mut Exploration, distance: f32, before: f32, after: f32) {
        e.count(CountedScan { index: 0, distance, before, after }, false);
    }

    #[test]
    fn a_cell_with_low_entropy_is_resolved() {
        let e = exploration(|_| ());
        assert_eq!(e.status(0, true, 0.6, InSight::Candidate), CellStatus::Resolved);
        assert_eq!(e.status(0, true, 0.61, InSight::Candidate), CellStatus::Open);
        assert_eq!(e.status(0, true, 0.61, InSight::Spent), CellStatus::Exhausted);
        assert_eq!(e.status(0, false, 2.4, InSight::Nowhere), CellStatus::Unreachable);
    }

    #[test]
    fn a_cell_that_stalls_is_looked_at_from_nearer_until_it_is_exhausted() {
        let rule = StallRule::Banded { first: 3.0, closest: 0.5 };
        let mut e = exploration(|p| p.stall_rule = rule);
        for (distance, limit) in [(2.8, 1.4), (1.2, 0.6), (0.6, 0.0)] {
            // The first scan of a band sets its lowest entropy; five more do not lower it.
            (0..6).for_each(|_| count(&mut e, distance, 1.0, 1.0));
            assert!((e.limit(0, true, 1.0) - limit).abs() < 1e-6, "{distance}");
        }
        assert_eq!(e.status(0, true, 1.0, InSight::Candidate), CellStatus::Exhausted);
        assert_eq!(e.capped_cells(), 0);
    }

    #[test]
    fn the_literal_rule_looks_at_the_change_alone() {
        let mut e = exploration(|p| p.stall_rule = StallRule::Literal);
        // Jitter between two bins is a change, for ever:
        (0..500).for_each(|i| count(&mut e, 1.0, 1.0, if i % 2 == 0 { 1.01 } else { 0.99 }));
        assert_eq!(e.status(0, true, 1.0, InSight::Candidate), CellStatus::Open);
        (0..5).for_each(|_| count(&mut e, 1.0, 1.0, 1.0));
        assert_eq!(e.status(0, true, 1.0, InSight::Candidate), CellStatus::Exhausted);
    }

    #[test]
    fn the_cap_is_reported() {
        let mut e = exploration(|p| p.max_counted_scans = 3);
        (0..3).for_each(|_| count(&mut e, 1.0, 1.0, 0.9));
        assert_eq!(
            (e.status(0, true, 1.0, InSight::Candidate), e.capped_cells()),
            (CellStatus::Exhausted, 1)
        );
    }

    #[test]
    fn a_counting_strategy_reads_no_entropy() {
        let mut e =
            exploration(|p| p.strategy = Strategy::Count { times: 2.0, half_distance: None });
        assert_eq!(e.status(0, true, 0.0, InSight::Candidate), CellStatus::Open);
        e.add_counts(|| vec![(Cell::new(0, 0), 1.0), (Cell::new(0, 0), 2.0)]);
        assert_eq!(e.status(0, true, 2.0, InSight::Candidate), CellStatus::Resolved);
    }

    /// A distance and an entropy, drawn as f64: proptest's own f32 trips over its rounding once in
    /// some million draws.
    fn a_step() -> impl proptest::strategy::Strategy<Value = (f32, f32)> {
        #[allow(clippy::cast_possible_truncation, reason = "any f32 will do")]
        let step = |(distance, entropy): (f64, f64)| (distance as f32, entropy as f32);
        (0.3..3.0f64, 0.6..2.4f64).prop_map(step)
    }

    proptest! {
        #[test]
        fn every_cell_ends_after_finitely_many_counted_scans(
            steps in prop::collection::vec(a_step(), 1200)
        ) {
            let rule = StallRule::Banded { first: 3.0, closest: 0.5 };
            let mut e = exploration(|p| {
                p.stall_rule = rule;
                (p.max_counted_scans, p.min_entropy_change) = (1_000_000, 0.05);
            });
            let mut before = 2.4;
            let mut counted = 0;
            for (distance, after) in steps {
                let limit = e.limit(0, true, 1.0);
                if limit == 0.0 { break; }
                count(&mut e, distance.min(limit), before, after);
                before = after;
                counted += 1;
            }
            // 4 bands of at most 5·(⌊ln 11/.05⌋ + 1) scans.
            prop_assert!(counted <= 4 * 5 * 49, "{}", counted);
            prop_assert_eq!(e.status(0, true, 1.0, InSight::Candidate), CellStatus::Exhausted);
        }
    }
}
