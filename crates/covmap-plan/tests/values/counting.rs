//! The strategies that count scans.

use super::corridor::{Corridor, plain, two_bins};
use covmap_plan::{CellStatus, PlannerParameters, StallRule, Strategy};
use covmap_sonar::Range;

/// A robot that looks 4 m to the right along six free cells.
fn corridor(strategy: Strategy, change: impl Fn(&mut PlannerParameters)) -> Corridor {
    let mut parameters = plain(strategy);
    change(&mut parameters);
    let mut corridor = Corridor::new(6, &[0.0], &two_bins(4.0), &parameters);
    corridor.free_but(&[]);
    corridor
}

fn count(times: f64, half_distance: Option<f64>) -> Strategy {
    Strategy::Count { times, half_distance }
}

/// The statuses of the cells 1 … 4 m from where the robot looks.
fn statuses(corridor: &mut Corridor) -> [CellStatus; 4] {
    [2, 3, 4, 5].map(|x| corridor.status(0, x))
}

use CellStatus::{Exhausted, Open, Resolved};

#[test]
fn a_cell_is_explored_when_it_was_scanned_often_enough() {
    let mut corridor = corridor(count(2.0, None), |_| ());
    corridor.observe(1, &[Range::NoEcho], &[]);
    assert_eq!(statuses(&mut corridor), [Open; 4]);
    // An echo from 2 m intercepts the two cells up to there.
    corridor.observe(1, &[Range::Echo(2.0)], &[]);
    assert_eq!(statuses(&mut corridor), [Resolved, Resolved, Open, Open]);
}

#[test]
fn a_longer_beam_counts_less() {
    // 1/(1 + d/2): .667, .5, .4 and .333, after one scan and after two.
    let mut corridor = corridor(count(0.6, Some(2.0)), |_| ());
    corridor.observe(1, &[Range::NoEcho], &[]);
    assert_eq!(statuses(&mut corridor), [Resolved, Open, Open, Open]);
    corridor.observe(1, &[Range::NoEcho], &[]);
    assert_eq!(statuses(&mut corridor), [Resolved; 4]);
    let mut corridor = self::corridor(count(1.0, Some(2.0)), |_| ());
    (0..2).for_each(|_| corridor.observe(1, &[Range::NoEcho], &[]));
    assert_eq!(statuses(&mut corridor), [Resolved, Resolved, Open, Open]);
}

#[test]
fn five_scans_in_a_row_that_miss_a_cell_give_it_up() {
    // The rule for entropies does not matter.
    let banded = StallRule::Banded { first: 4.0, closest: 0.5 };
    let mut corridor = corridor(count(3.0, None), |p| p.stall_rule = banded);
    let miss = |corridor: &mut Corridor, times: usize| {
        (0..times).for_each(|_| corridor.observe(1, &[Range::Missing], &[]));
    };
    miss(&mut corridor, 4);
    corridor.observe(1, &[Range::Echo(2.0)], &[]);
    assert_eq!(statuses(&mut corridor), [Open, Open, Exhausted, Exhausted]);
    miss(&mut corridor, 4);
    assert_eq!(statuses(&mut corridor), [Open, Open, Exhausted, Exhausted]);
    miss(&mut corridor, 1);
    assert_eq!(statuses(&mut corridor), [Exhausted; 4]);
}

#[test]
fn counting_asks_for_no_spacing_and_knows_no_cap() {
    let mut corridor = corridor(count(9.0, None), |p| {
        (p.scan_spacing, p.max_counted_scans) = (3.0, 2);
    });
    (0..8).for_each(|_| corridor.observe(1, &[Range::NoEcho], &[]));
    assert_eq!(statuses(&mut corridor), [Open; 4]);
    assert!(corridor.candidates(0).contains(&1));
    corridor.observe(1, &[Range::NoEcho], &[]);
    assert_eq!(statuses(&mut corridor), [Resolved; 4]);
}

#[test]
fn a_cell_that_was_scanned_by_chance_is_no_reason_any_more() {
    // Cell 3 looks like a wall, but a beam of 4 m passes it.
    let mut corridor = corridor(count(1.0, None), |_| ());
    corridor.know(3, &[0.001, 0.999]);
    corridor.planner.stand_on(covmap::Cell::new(3, 0));
    assert_eq!(corridor.candidates(0), [0, 1, 2, 3, 4]);
    corridor.observe(1, &[Range::Echo(4.0)], &[]);
    // Cell 1 was not scanned yet.
    assert_eq!(corridor.candidates(0), [0]);
}
