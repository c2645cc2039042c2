//! Eq. (12), (15) and (16), ties, and spent view-points.
//!
//! A robot in a corridor of eleven cells sees its neighbours to the left and to the right. It does
//! not know the cells 2 and 8, and cannot drive beyond them.

use super::corridor::{Corridor, plain, two_bins};
use super::{all_close, close};
use covmap::Cell;
use covmap_plan::{CellStatus, InPlace, PlannerParameters, Scope, Strategy};
use std::f64::consts::PI;

fn corridor_with(parameters: &PlannerParameters) -> Corridor {
    let mut corridor = Corridor::new(11, &[0.0, 180.0], &two_bins(1.0), parameters);
    corridor.free_but(&[2, 8]);
    corridor
}

fn corridor(strategy: Strategy) -> Corridor {
    corridor_with(&plain(strategy))
}

#[test]
fn candidates_hold_an_open_cell_in_sight() {
    let mut corridor = corridor(Strategy::Cl);
    assert_eq!(corridor.candidates(5), [3, 7]);
    corridor.know(8, &[0.999, 0.001]);
    // Cell 8 is free: the robot could go on, but all cells there are known.
    assert_eq!(corridor.candidates(5), [3]);
    corridor.know(10, &[0.8, 0.2]);
    assert_eq!(corridor.candidates(5), [3, 9]);
    // ε = .1: −.98 ln .98 − .02 ln .02 = .0980, and .1030 with .979.
    corridor.know(10, &[0.98, 0.02]);
    assert_eq!(corridor.candidates(5), [3]);
    corridor.know(10, &[0.978, 0.022]);
    assert_eq!(corridor.candidates(5), [3, 9]);
}

#[test]
fn closest_location_minimises_the_travel_cost() {
    for strategy in [Strategy::Cl, Strategy::IgCl { alpha: 0.0 }] {
        let mut corridor = corridor(strategy);
        assert_eq!([4, 6].map(|from| corridor.target(from)), [3, 7]);
        let decision = corridor.choose(6).unwrap();
        assert_eq!(decision.path, [Cell::new(7, 0)]);
        assert_eq!((decision.candidates, decision.passage.len()), (2, 0));
        assert_eq!(decision.negative_gains, 0);
        let costs: Vec<f64> = decision.best.iter().map(|record| record.cost).collect();
        assert_eq!(costs, [1.0, 3.0]);
        // To stay costs nothing.
        let stay = corridor.choose(7).unwrap();
        assert_eq!((stay.target, stay.path.len(), stay.best[0].cost), (Cell::new(7, 0), 0, 0.0));
    }
}

#[test]
fn a_tie_is_the_first_in_row_major_order() {
    for strategy in [Strategy::Cl, Strategy::Ig, Strategy::IgCl { alpha: 0.3 }] {
        let mut corridor = corridor(strategy);
        let decision = corridor.choose(5).unwrap();
        let order: Vec<i32> = decision.best.iter().map(|record| record.cell.x).collect();
        assert_eq!((decision.target.x, order), (3, vec![3, 7]), "{strategy}");
        let by_oracle = if strategy == Strategy::Cl { 0 } else { 2 };
        assert_eq!(decision.decided_by_oracle, by_oracle, "{strategy}");
    }
}

#[test]
fn maximum_gain_asks_for_no_travel_cost() {
    let mut corridor = corridor(Strategy::Ig);
    // A second look at cell 8 tells more than the first at cell 2.
    corridor.know(8, &[0.9, 0.1]);
    assert_eq!([3, 4, 5].map(|from| corridor.target(from)), [7; 3]);
    let best = corridor.choose(4).unwrap().best;
    assert_eq!(best.iter().map(|record| record.cell.x).collect::<Vec<_>>(), [7, 9, 3]);
    assert!(best.iter().all(|record| record.score == record.gain));
    assert!(best[1].gain > best[2].gain && best[2].gain > 0.0);
}

#[test]
fn gain_and_travel_cost_are_weighed_in_shares_of_the_largest() {
    for (alpha, expected) in [(0.3, 3), (0.9, 3), (4.0, 7)] {
        let mut corridor = corridor(Strategy::IgCl { alpha });
        corridor.know(8, &[0.9, 0.1]);
        let table = corridor.planner.candidate_table(&corridor.map, Cell::new(4, 0));
        let [near, far, farthest] = table[..] else { panic!("{table:?}") };
        // 1 m, 3 m and 5 m away; the far ones gain more. By Eq. (9) no echo says
        // .2 + N(0, .5, x), which is [.764155 .235845]; the gains of [½ ½], [.9 .1] and the sure
        // neighbour are .146904, .179537 and .000670, and of two beams (.146904 + .000670)/2 …
        let share = near.gain / far.gain;
        all_close(&[near.gain, far.gain], &[0.073_786_9, 0.090_103_1], 1e-6);
        let costs = [near.cost_term, far.cost_term, farthest.cost_term];
        all_close(&costs, &[0.2, 0.6, 1.0], 1e-12);
        all_close(&[near.gain_term, far.gain_term], &[alpha * share, alpha], 1e-12);
        let scores = [alpha * share - 0.2, alpha - 0.6, alpha - 1.0];
        all_close(&[near.score, far.score, farthest.score], &scores, 1e-12);
        // The far one is better if α (1 − share) > .4.
        let decision = corridor.choose(4).unwrap();
        assert_eq!(decision.target.x, expected, "{alpha}");
        close(decision.best[0].score, scores[0].max(scores[1]), 1e-6);
    }
}

#[test]
fn a_turn_costs_as_much_as_its_radians_say() {
    for (strategy, of_turns) in [(Strategy::IgCl { alpha: 0.0 }, 0.5 * PI), (Strategy::Cl, 0.0)] {
        let mut corridor = corridor_with(&PlannerParameters { turn_cost: 0.5, ..plain(strategy) });
        let costs = |corridor: &mut Corridor| {
            let table = corridor.planner.candidate_table(&corridor.map, Cell::new(5, 0));
            table.iter().map(|record| record.cost).collect::<Vec<_>>()
        };
        // 3 and 7 are 2 m away, and a robot that came from nowhere needs no turn.
        all_close(&costs(&mut corridor), &[2.0, 2.0], 1e-12);
        corridor.planner.drove(Cell::new(4, 0), Cell::new(5, 0));
        all_close(&costs(&mut corridor), &[2.0 + of_turns, 2.0], 1e-12);
        assert_eq!(corridor.target(5), if of_turns > 0.0 { 7 } else { 3 }, "{strategy}");
        // To stay needs no turn either.
        assert_eq!(corridor.choose(7).unwrap().best[0].cost, 0.0);
    }
}

#[test]
fn a_view_point_nearer_than_the_spacing_to_a_scan_is_spent() {
    let parameters = PlannerParameters { scan_spacing: 2.0, ..plain(Strategy::Cl) };
    let mut corridor = corridor_with(&parameters);
    corridor.look_in_vain(5);
    // 3 and 7 are 2 m from there.
    assert_eq!(corridor.candidates(5), [3, 7]);
    corridor.look_in_vain(4);
    assert_eq!(corridor.candidates(5), [7]);
    assert_eq!([2, 8].map(|x| corridor.status(5, x)), [CellStatus::Exhausted, CellStatus::Open]);
    corridor.look_in_vain(7);
    assert_eq!((corridor.candidates(5), corridor.target(5)), (vec![], -1));
}

#[test]
fn a_robot_that_cannot_get_away_from_a_scan_measures_again() {
    let parameters = PlannerParameters { scan_spacing: 2.0, ..plain(Strategy::Cl) };
    let mut corridor = corridor_with(&parameters);
    [4, 6].into_iter().for_each(|x| corridor.know(x, &[0.2, 0.8]));
    corridor.look_in_vain(5);
    assert_eq!(corridor.candidates(5), [5]);
}

#[test]
fn while_driving_a_target_is_as_far_from_the_last_scan_as_scans_are_apart() {
    // The last scan at 3 or 5; cells have sides of 1 m.
    let cases = [
        (InPlace::Always, 3, 2.0, vec![3, 7]),
        (InPlace::AtViewPoints, 3, 2.0, vec![7]),
        (InPlace::AtViewPoints, 5, 2.0, vec![3, 7]),
        // All are nearer: the robot's own cell is left out.
        (InPlace::AtViewPoints, 3, 5.0, vec![7]),
    ];
    for (in_place, at, every, candidates) in cases {
        let mut corridor = corridor_with(&PlannerParameters { in_place, ..plain(Strategy::Cl) });
        corridor.look_in_vain(at);
        assert_eq!(corridor.candidates(at), [3, 7], "{in_place:?}: at view-points");
        corridor.planner.measure_while_driving(every);
        assert_eq!(corridor.candidates(at), candidates, "{in_place:?}, every {every} m from {at}");
        // Only one is left.
        corridor.know(8, &[1.0, 0.0]);
        assert_eq!(corridor.candidates(at), [3], "{in_place:?}");
    }
}

#[test]
fn counting_has_a_scope_of_its_own() {
    let wall = [(Scope::Observable, CellStatus::Open), (Scope::Reachable, CellStatus::Unreachable)];
    for (count_scope, status) in wall {
        let count = Strategy::Count { times: 1.0, half_distance: None };
        let parameters = PlannerParameters { count_scope, ..plain(count) };
        let mut corridor = corridor_with(&parameters);
        corridor.know(8, &[0.1, 0.9]);
        assert_eq!(corridor.status(5, 8), status, "{count_scope:?}");
        // The floor is counted in any case.
        assert_eq!(corridor.status(5, 6), CellStatus::Open, "{count_scope:?}");
    }
}

#[test]
fn only_what_the_robot_may_stand_on_must_be_explored_if_it_is_said_so() {
    for (scope, candidates) in [(Scope::Observable, vec![3, 7]), (Scope::Reachable, vec![3])] {
        let parameters = PlannerParameters { scope, ..plain(Strategy::Cl) };
        let mut corridor = corridor_with(&parameters);
        // A wall that is not quite sure.
        corridor.know(8, &[0.1, 0.9]);
        assert_eq!(corridor.candidates(5), candidates, "{scope:?}");
    }
}
