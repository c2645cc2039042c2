//! Strategies from outside: a closure chooses among the candidates.

use super::corridor::{Corridor, plain, two_bins};
use covmap::Cell;
use covmap_plan::{CandidateRecord, Strategy};

fn corridor(strategy: Strategy) -> Corridor {
    let mut corridor = Corridor::new(11, &[0.0, 180.0], &two_bins(1.0), &plain(strategy));
    corridor.free_but(&[2, 8]);
    corridor.know(8, &[0.9, 0.1]);
    corridor
}

/// The first of the best.
fn best(candidates: &[CandidateRecord]) -> Option<usize> {
    (0..candidates.len()).min_by(|a, b| candidates[*b].score.total_cmp(&candidates[*a].score))
}

#[test]
fn the_strategies_of_the_paper_choose_the_same_through_this_door() {
    for strategy in [Strategy::Cl, Strategy::Ig, Strategy::IgCl { alpha: 0.3 }] {
        for from in [3, 4, 5, 6] {
            let (mut own, mut outside) = (corridor(strategy), corridor(strategy));
            let decision = outside.planner.choose_by(&outside.map, Cell::new(from, 0), best);
            let (decision, own) = (decision.unwrap(), own.choose(from).unwrap());
            assert_eq!(
                (decision.target, decision.path),
                (own.target, own.path),
                "{strategy} {from}"
            );
        }
    }
}

#[test]
fn a_strategy_sees_every_candidate_and_may_take_any_or_none() {
    let mut corridor = corridor(Strategy::Cl);
    let from = Cell::new(4, 0);
    let mut seen = Vec::new();
    let farthest = corridor.planner.choose_by(&corridor.map, from, |candidates| {
        seen = candidates.iter().map(|candidate| candidate.cell.x).collect();
        candidates.len().checked_sub(1)
    });
    assert_eq!((seen, farthest.unwrap().target.x), (vec![3, 7, 9], 9));
    assert!(corridor.planner.choose_by(&corridor.map, from, |_| None).is_none());
    assert!(corridor.planner.choose_by(&corridor.map, from, |_| Some(99)).is_none());
}
