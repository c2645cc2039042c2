//! IG_WIN: a local window until it is explored, and no return.
//!
//! A robot in a corridor of sixteen cells sees its neighbours to both sides. Cells that are not
//! resolved lie here and there, and it can drive over all of them.

use super::corridor::{Corridor, plain, two_bins};
use covmap_plan::Strategy;

/// A corridor with `open` cells that are free with these probabilities: .6 leaves more to learn than .9.
fn corridor(strategy: Strategy, open: &[(i32, f64)]) -> Corridor {
    let mut corridor = Corridor::new(16, &[0.0, 180.0], &two_bins(1.0), &plain(strategy));
    corridor.free_but(&[]);
    for &(x, free) in open {
        corridor.know(x, &[free, 1.0 - free]);
    }
    corridor
}

const WINDOW: Strategy = Strategy::IgWin { radius: 3.0 };

fn resolve(corridor: &mut Corridor, x: i32) {
    corridor.know(x, &[0.999, 0.001]);
}

#[test]
fn the_gain_is_sought_within_the_window_first() {
    // The window around cell 2 ends with cell 5.
    let open = [(3, 0.9), (9, 0.6)];
    assert_eq!(corridor(Strategy::Ig, &open).target(2), 8);
    let mut windowed = corridor(WINDOW, &open);
    let decision = windowed.choose(2).unwrap();
    assert_eq!((decision.target.x, decision.candidates), (2, 2));
    // The window stays where it was opened, wherever the robot is.
    assert_eq!(windowed.target(7), 2);
}

#[test]
fn a_window_is_a_circle_with_its_edge() {
    // Cell 5 lies on the edge: of the candidates 4 and 6, 6 is outside.
    let decision = corridor(WINDOW, &[(5, 0.9), (9, 0.6)]).choose(2).unwrap();
    assert_eq!((decision.target.x, decision.candidates), (4, 1));
}

#[test]
fn the_next_window_opens_around_the_nearest_candidate_that_is_left() {
    let mut corridor = corridor(WINDOW, &[(3, 0.9), (9, 0.9), (11, 0.6), (14, 0.6)]);
    assert_eq!(corridor.target(2), 2);
    resolve(&mut corridor, 3);
    // Around cell 8, up to cell 11: cells 10 and 12 look at 11, but 12 is outside; 10 also looks
    // at 9.
    let decision = corridor.choose(2).unwrap();
    assert_eq!((decision.target.x, decision.candidates), (10, 2));
}

#[test]
fn the_nearest_candidate_is_that_of_the_shortest_way() {
    // From cell 13, cell 10 is nearer than 4: the window around 10 ends with cell 7.
    let mut corridor = corridor(WINDOW, &[(12, 0.9), (3, 0.6), (9, 0.9)]);
    assert_eq!(corridor.target(14), 11);
    resolve(&mut corridor, 12);
    assert_eq!(corridor.target(13), 8);
}

#[test]
fn there_is_no_need_to_return_until_all_else_is_done() {
    let mut corridor = corridor(WINDOW, &[(3, 0.9), (9, 0.9)]);
    assert_eq!(corridor.target(2), 2);
    resolve(&mut corridor, 3);
    assert_eq!(corridor.target(2), 8);
    // Cell 3 is in doubt again: it is no reason now, although there is much to learn.
    corridor.know(3, &[0.6, 0.4]);
    assert_eq!(corridor.candidates(8), [8, 10]);
    assert_eq!(corridor.target(8), 8);
    resolve(&mut corridor, 9);
    // Nothing else is left.
    assert_eq!(corridor.target(8), 2);
    resolve(&mut corridor, 3);
    assert_eq!(corridor.target(2), -1);
}

#[test]
fn a_candidate_that_sees_only_what_lies_outside_is_not_offered() {
    // Cell 6 is outside of the window around 2, but in sight from cell 5, which is inside.
    let mut corridor = corridor(WINDOW, &[(3, 0.9), (6, 0.6)]);
    assert_eq!(corridor.target(2), 2);
    resolve(&mut corridor, 3);
    // The next window is around cell 5, and holds both neighbours of cell 6.
    let decision = corridor.choose(2).unwrap();
    assert_eq!((decision.target.x, decision.candidates), (5, 2));
}
