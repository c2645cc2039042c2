//! The stall rule: .001, five times, and the distance bands.
//!
//! A robot in a corridor looks to the right, up to 6 m, at cell 7; all cells before it are free.

use super::corridor::{Corridor, plain, two_bins};
use covmap::Cell;
use covmap_plan::{CellStatus, StallRule, Strategy};

/// The cell that is looked at.
const CELL: i32 = 7;
/// All view-points from which that cell is in sight, 6 m to 1 m away.
const ALL: [i32; 6] = [1, 2, 3, 4, 5, 6];

fn corridor(stall_rule: StallRule) -> Corridor {
    let parameters = covmap_plan::PlannerParameters { stall_rule, ..plain(Strategy::Cl) };
    let mut corridor = Corridor::new(8, &[0.0], &two_bins(6.0), &parameters);
    corridor.free_but(&[CELL]);
    corridor
}

fn banded() -> Corridor {
    corridor(StallRule::Banded { first: 6.0, closest: 1.0 })
}

/// The candidates after a first scan from 6 m away, with the entropy .6 after it, and one scan for each
/// of `entropies`.
fn after(mut corridor: Corridor, entropies: &[f64]) -> Vec<i32> {
    corridor.look(1, CELL, 0.6);
    entropies.iter().for_each(|after| corridor.look(1, CELL, *after));
    corridor.candidates(0)
}

#[test]
fn five_scans_in_a_row_that_tell_nothing_halve_the_distance() {
    let mut corridor = banded();
    assert_eq!(corridor.candidates(0), ALL);
    // The first scan of a band sets its lowest entropy.
    corridor.look(1, CELL, 0.6);
    (0..4).for_each(|_| corridor.look_in_vain(1));
    assert_eq!(corridor.candidates(0), ALL);
    corridor.look_in_vain(1);
    // R = 3 m.
    assert_eq!((corridor.candidates(0), corridor.counted(CELL)), (vec![4, 5, 6], 6));
}

#[test]
fn a_scan_from_beyond_the_band_does_not_count() {
    let mut corridor = banded();
    corridor.look(1, CELL, 0.6);
    (0..5).for_each(|_| corridor.look_in_vain(1));
    (0..9).for_each(|_| corridor.look_in_vain(3));
    assert_eq!((corridor.counted(CELL), corridor.candidates(0)), (6, vec![4, 5, 6]));
    corridor.look_in_vain(4);
    assert_eq!(corridor.counted(CELL), 7);
}

#[test]
fn below_the_closest_distance_a_cell_is_exhausted() {
    let mut corridor = banded();
    corridor.look(1, CELL, 0.6);
    (0..5).for_each(|_| corridor.look_in_vain(1));
    (0..6).for_each(|_| corridor.look_in_vain(4));
    // R = 1.5 m.
    assert_eq!((corridor.candidates(0), corridor.status(0, CELL)), (vec![6], CellStatus::Open));
    (0..5).for_each(|_| corridor.look_in_vain(6));
    assert_eq!(corridor.status(0, CELL), CellStatus::Open);
    corridor.look_in_vain(6);
    // R = .5 m is below 1 m.
    assert_eq!((corridor.candidates(0), corridor.status(0, CELL)), (vec![], CellStatus::Exhausted));
    assert_eq!((corridor.counted(CELL), corridor.planner.capped_cells()), (18, 0));
}

#[test]
fn a_band_as_near_as_the_closest_distance_is_still_one() {
    let mut corridor = corridor(StallRule::Banded { first: 6.0, closest: 1.5 });
    corridor.look(1, CELL, 0.6);
    (0..5).for_each(|_| corridor.look_in_vain(1));
    (0..6).for_each(|_| corridor.look_in_vain(4));
    assert_eq!(corridor.candidates(0), [6]);
}

#[test]
fn no_band_goes_beyond_the_usable_range() {
    // A wall 4 m from cell 0 is in sight from there; the cell behind it, 5 m away, is no reason.
    let mut model = two_bins(4.0);
    model = model.with_product(|product| {
        (product.behind, product.no_echo.range) = (1.0, 1.0);
    });
    let mut parameters = plain(Strategy::Cl);
    parameters.stall_rule = StallRule::Banded { first: 50.0, closest: 0.5 };
    let mut corridor = Corridor::new(6, &[0.0], &model, &parameters);
    corridor.free_but(&[4, 5]);
    corridor.know(4, &[0.001, 0.999]);
    assert_eq!(corridor.in_sight(0).last(), Some(&(5, 5.0)));
    assert_eq!(corridor.candidates(0), [1, 2, 3]);
}

#[test]
fn what_a_wall_hides_is_no_reason() {
    let mut corridor = banded();
    corridor.know(3, &[0.01, 0.99]);
    assert_eq!(corridor.candidates(0), [0; 0]);
    // The robot can drive over the cell that looks like a wall, as it stood there.
    corridor.planner.stand_on(Cell::new(3, 0));
    assert_eq!(corridor.candidates(0), [3, 4, 5, 6]);
}

#[test]
fn the_next_band_is_half_of_the_nearest_of_the_stalled_scans() {
    let mut corridor = banded();
    corridor.look(1, CELL, 0.6);
    [1, 3, 2, 1, 1].into_iter().for_each(|from| corridor.look_in_vain(from));
    // From 6, 4, 5, 6 and 6 m: R = 2 m.
    assert_eq!(corridor.candidates(0), [5, 6]);
    // A scan that told something ends the stall, and resets its nearest distance.
    let mut corridor = banded();
    corridor.look(1, CELL, 0.6);
    corridor.look_in_vain(5);
    corridor.look(1, CELL, 0.5);
    (0..5).for_each(|_| corridor.look_in_vain(1));
    assert_eq!(corridor.candidates(0), [4, 5, 6]);
}

#[test]
fn the_first_band_begins_at_its_distance_or_the_usable_range() {
    let candidates = |first| {
        let mut corridor = corridor(StallRule::Banded { first, closest: 0.5 });
        corridor.candidates(0)
    };
    assert_eq!(candidates(2.0), [5, 6]);
    assert_eq!(candidates(50.0), ALL);
}

#[test]
fn a_fall_of_less_than_a_thousandth_is_a_stall() {
    let falls = |by: f64| (1..=5).map(|i| 0.6 - f64::from(i) * by).collect::<Vec<_>>();
    // Five falls of .0001, all of them .0005 below the lowest: a stall.
    assert_eq!(after(banded(), &falls(0.000_1)), [4, 5, 6]);
    // Falls of .0011, and of .0003, the fourth of which is .0012 below the lowest: none.
    assert_eq!(after(banded(), &falls(0.001_1)), ALL);
    assert_eq!(after(banded(), &falls(0.000_3)), ALL);
}

#[test]
fn what_counts_is_the_lowest_entropy_of_the_band() {
    // Five falls that stay above .6, the entropy reached before.
    assert_eq!(after(banded(), &[0.65, 0.64, 0.63, 0.62, 0.61]), [4, 5, 6]);
    assert_eq!(after(banded(), &[0.65, 0.64, 0.63, 0.62, 0.59]), ALL);
    // The next band begins anew: its lowest entropy is .65 at first.
    let mut corridor = banded();
    corridor.look(1, CELL, 0.6);
    (0..5).for_each(|_| corridor.look_in_vain(1));
    for entropy in [0.65, 0.64, 0.63, 0.62, 0.61, 0.60] {
        corridor.look(4, CELL, entropy);
    }
    assert_eq!(corridor.candidates(0), [4, 5, 6]);
}

#[test]
fn without_bands_the_first_stall_exhausts_a_cell() {
    assert_eq!(after(corridor(StallRule::Unbanded), &[0.6; 4]), ALL);
    assert_eq!(after(corridor(StallRule::Unbanded), &[0.6; 5]), [0; 0]);
}

#[test]
fn the_literal_rule_looks_at_the_change_and_not_at_the_lowest() {
    let literal = || corridor(StallRule::Literal);
    // Changes of .01 are changes, up or down.
    assert_eq!(after(literal(), &[0.65, 0.64, 0.63, 0.62, 0.61, 0.65, 0.64]), ALL);
    assert_eq!(after(literal(), &[0.61, 0.62, 0.63, 0.64, 0.65, 0.66]), ALL);
    // Changes of .0005.
    let falls: Vec<f64> = (1..=5).map(|i| 0.6 - f64::from(i) * 0.000_5).collect();
    assert_eq!(after(literal(), &falls[..4]), ALL);
    assert_eq!(after(literal(), &falls), [0; 0]);
}

#[test]
fn the_cap_ends_a_cell_that_still_learns() {
    let mut parameters = plain(Strategy::Cl);
    parameters.max_counted_scans = 3;
    let mut corridor = Corridor::new(8, &[0.0], &two_bins(6.0), &parameters);
    corridor.free_but(&[CELL]);
    corridor.look(1, CELL, 0.6);
    corridor.look(1, CELL, 0.5);
    assert_eq!((corridor.candidates(0).len(), corridor.planner.capped_cells()), (6, 0));
    corridor.look(1, CELL, 0.4);
    assert_eq!((corridor.candidates(0).len(), corridor.planner.capped_cells()), (0, 1));
}

#[test]
fn a_scan_counts_for_what_was_in_sight_when_its_place_was_chosen() {
    let wall = [0.01, 0.99];
    let chosen = || {
        let mut corridor = banded();
        assert_eq!(corridor.target(0), 1);
        corridor
    };
    // On the way the robot finds a wall between the view-point and the cell.
    let mut corridor = chosen();
    corridor.know(3, &wall);
    corridor.look_in_vain(1);
    assert_eq!(corridor.counted(CELL), 1);
    // The next scan from there counts for the cells in sight now.
    corridor.look_in_vain(1);
    assert_eq!(corridor.counted(CELL), 1);
    // A scan on the way does not change that; a scan from elsewhere counts for the cells in its own sight.
    let mut corridor = chosen();
    corridor.look_in_vain(0);
    assert_eq!(corridor.counted(CELL), 0);
    corridor.look_in_vain(2);
    corridor.know(3, &wall);
    corridor.look_in_vain(1);
    assert_eq!(corridor.counted(CELL), 2);
    // After a bump no view-point is chosen.
    let mut corridor = chosen();
    corridor.planner.bump(Cell::new(1, 0), Cell::new(2, 0), nalgebra::Point2::origin());
    corridor.know(3, &wall);
    corridor.look_in_vain(1);
    assert_eq!(corridor.counted(CELL), 0);
}
