//! Strategies from outside: a score over candidates.

use super::corridor::{Corridor, plain, two_bins};
use covmap::Cell;
use covmap_plan::{CandidateRecord, Scoring, Situation, Strategy};

fn corridor(strategy: Strategy) -> Corridor {
    let mut corridor = Corridor::new(11, &[0.0, 180.0], &two_bins(1.0), &plain(strategy));
    corridor.free_but(&[2, 8]);
    corridor.know(8, &[0.9, 0.1]);
    corridor
}

/// Eq. (16), as a user would write it: all gains are evaluated.
struct IgCl(f64);

impl Scoring for IgCl {
    fn score(&mut self, _: &Situation<'_>, candidates: &mut [CandidateRecord]) {
        let largest =
            |of: fn(&CandidateRecord) -> f64| candidates.iter().map(of).fold(0.0, f64::max);
        let (gain, cost) = (largest(|c| c.gain), largest(|c| c.cost));
        for c in candidates {
            c.score = self.0 * c.gain / gain - c.cost / cost;
        }
    }
}

#[track_caller]
fn check(strategy: Strategy, written: &mut dyn Scoring) {
    for from in [3, 4, 5, 6] {
        let (mut own, mut outside) = (corridor(strategy), corridor(strategy));
        let decision = outside.planner.choose_by(&outside.map, Cell::new(from, 0), written);
        let (decision, own) = (decision.unwrap(), own.choose(from).unwrap());
        assert_eq!((decision.target, decision.path), (own.target, own.path), "{strategy} {from}");
    }
}

#[test]
fn the_strategies_of_the_paper_choose_the_same_if_a_user_writes_them() {
    check(Strategy::Cl, &mut |c: &CandidateRecord| -c.cost);
    check(Strategy::Ig, &mut |c: &CandidateRecord| c.gain);
    check(Strategy::IgCl { alpha: 0.3 }, &mut IgCl(0.3));
}

#[test]
fn a_strategy_sees_every_candidate_and_may_take_any_or_none() {
    let mut corridor = corridor(Strategy::Cl);
    let from = Cell::new(4, 0);
    let mut seen = Vec::new();
    let mut farthest = |candidate: &CandidateRecord| {
        seen.push(candidate.cell.x);
        candidate.cost
    };
    let chosen = corridor.planner.choose_by(&corridor.map, from, &mut farthest);
    assert_eq!(chosen.unwrap().target.x, 9);
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, [3, 7, 9]);
    let mut none = |_: &CandidateRecord| f64::NEG_INFINITY;
    assert!(corridor.planner.choose_by(&corridor.map, from, &mut none).is_none());
}

/// A strategy that asks for the longest way in cells.
struct LongestWay;

impl Scoring for LongestWay {
    fn score(&mut self, situation: &Situation<'_>, candidates: &mut [CandidateRecord]) {
        for c in candidates {
            assert_eq!(situation.from, Cell::new(4, 0));
            let way = situation.ways.path_to(c.cell).unwrap();
            c.score = way.len() as f64;
        }
    }

    fn uses_gain(&self) -> bool {
        false
    }
}

#[test]
fn a_strategy_knows_the_ways_to_its_candidates() {
    let mut corridor = corridor(Strategy::Cl);
    let chosen = corridor.planner.choose_by(&corridor.map, Cell::new(4, 0), &mut LongestWay);
    assert_eq!(chosen.unwrap().target.x, 9);
}
