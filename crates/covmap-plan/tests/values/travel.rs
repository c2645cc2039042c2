//! Traversable view-points and their travel costs.

use super::close;
use super::corridor::{Corridor, plain, two_bins};
use covmap::{Cell, Grid, Steps};
use covmap_plan::{BodyEvidence, PlannerParameters, Reach, Strategy, travel_costs};
use nalgebra::Point2;

#[test]
fn travel_costs_are_metres_over_straight_and_diagonal_steps() {
    let grid = Grid::new(Point2::origin(), 0.2, 4, 3).unwrap();
    let costs = travel_costs(Steps::between(&grid, |_| true), Cell::new(0, 0));
    let cost = |x, y| costs.cost(grid.index(Cell::new(x, y)).unwrap()).unwrap();
    // (1 + 2 √2) · .2, 3 · .2, 2 √2 · .2
    close(cost(3, 2), 0.765_685_424_9, 1e-10);
    close(cost(3, 0), 0.6, 1e-12);
    close(cost(2, 2), 0.565_685_424_9, 1e-10);
    close(cost(0, 0), 0.0, 0.0);
    assert_eq!(costs.reached().count(), 12);
}

#[test]
fn of_two_shortest_ways_the_one_whose_last_step_comes_from_the_nearest_cell() {
    // To (2, 1) by (1, 0) at 1, or by (1, 1) at √2.
    let grid = Grid::new(Point2::origin(), 1.0, 4, 3).unwrap();
    let costs = travel_costs(Steps::between(&grid, |_| true), Cell::new(0, 0));
    let path = |x, y| costs.path_to(Cell::new(x, y)).unwrap();
    assert_eq!(path(2, 1), [Cell::new(1, 0), Cell::new(2, 1)]);
    assert_eq!(path(2, 2), [Cell::new(1, 1), Cell::new(2, 2)]);
    assert_eq!(path(0, 0), []);
}

/// The candidates of a robot that drives from cell 0 over cell 2 to where it sees the unknown cell 5;
/// `bin` is the most likely of the eleven bins of cell 2.
fn candidates(change: impl Fn(&mut PlannerParameters), bin: usize, radius: f64) -> Vec<i32> {
    corridor(change, bin, radius).candidates(0)
}

fn corridor(change: impl Fn(&mut PlannerParameters), bin: usize, radius: f64) -> Corridor {
    let mut model = two_bins(1.0);
    model.bins = 11;
    model = model.with_product(|product| {
        (product.sigma_out.base, product.sigma_in) = (0.1, 0.2);
    });
    let mut parameters = plain(Strategy::Cl);
    parameters.entropy_threshold = 0.6;
    change(&mut parameters);
    let mut corridor = Corridor::build(6, &[0.0], &model, &parameters, radius, |_| false);
    corridor.free_but(&[5]);
    let posterior: Vec<f64> = (0..11).map(|k| if k == bin { 0.99 } else { 0.001 }).collect();
    corridor.know(2, &posterior);
    corridor
}

#[test]
fn the_robot_drives_over_cells_of_which_a_fifth_at_most_is_likely_covered() {
    let reached = [0, 1, 2, 3, 4, 5, 10].map(|bin| candidates(|_| (), bin, 0.3) == [4]);
    assert_eq!(reached, [true, true, true, false, false, false, false]);
    let strict = [1, 2].map(|bin| candidates(|p| p.traversable_coverage = 0.1, bin, 0.3) == [4]);
    assert_eq!(strict, [true, false]);
}

#[test]
fn a_blocking_cell_is_kept_off_by_the_robots_radius() {
    // Standing in cell 1, 1 m from the centre of cell 2, takes a radius of at most 1 m.
    let stands = |radius| {
        let mut corridor = corridor(|_| (), 10, radius);
        corridor.know(1, &[0.6; 11].map(|p| p / 6.6));
        corridor.candidates(0)
    };
    assert_eq!(stands(1.0), [0]);
    let reach = |radius| {
        let reach = corridor(|_| (), 10, radius).planner.reach(Cell::new(0, 0));
        [1, 2, 3, 5].map(|x| *reach.get(Cell::new(x, 0)).unwrap())
    };
    use Reach::{Covered, CutOff, Reached, Unknown};
    assert_eq!(reach(1.0), [Reached, Covered, CutOff, Unknown]);
    assert_eq!(reach(1.1), [Covered, Covered, Covered, Unknown]);
}

#[test]
fn where_the_robot_stood_it_can_stand_again() {
    for (body_evidence, expected) in [
        (BodyEvidence::Belief, vec![4]),
        (BodyEvidence::PlannerOnly, vec![4]),
        (BodyEvidence::Off, vec![]),
    ] {
        let mut corridor = corridor(|p| p.body_evidence = body_evidence, 10, 0.3);
        assert_eq!(corridor.candidates(0), [0; 0]);
        corridor.planner.stand_on(Cell::new(2, 0));
        // The map may say anything of that cell now:
        corridor
            .know(2, &[0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.99, 0.001]);
        assert_eq!(corridor.candidates(0), expected, "{body_evidence:?}");
    }
}

#[test]
fn an_unknown_cell_is_open_once_the_body_was_over_its_centre() {
    for (body_evidence, expected) in [(BodyEvidence::PlannerOnly, 4), (BodyEvidence::Off, 1)] {
        let parameters = PlannerParameters { body_evidence, ..plain(Strategy::Cl) };
        let mut corridor = Corridor::new(6, &[0.0], &two_bins(1.0), &parameters);
        corridor.free_but(&[2, 5]);
        // Cell 2 is unknown and shuts off the cells beyond.
        assert_eq!(corridor.candidates(0), [1]);
        let center = corridor.map.grid().center(Cell::new(2, 0));
        corridor.planner.body_moved(&corridor.map, center, center, &[]);
        assert_eq!(*corridor.candidates(0).last().unwrap(), expected, "{body_evidence:?}");
    }
}

#[test]
fn a_cell_that_was_bumped_into_is_blocked_for_good() {
    let mut corridor = corridor(|_| (), 0, 0.3);
    assert_eq!(corridor.candidates(0), [4]);
    corridor.planner.bump(Cell::new(1, 0), Cell::new(2, 0), nalgebra::Point2::origin());
    assert_eq!(corridor.candidates(0), [0; 0]);
    corridor.know(2, &[0.99, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001]);
    assert_eq!(corridor.candidates(0), [0; 0]);
}

/// Whether a robot reaches each of the cells 0 … 3 from a cell, if cell 2 looks like a wall.
fn reached(corridor: &Corridor, from: i32) -> [bool; 4] {
    let reach = corridor.planner.reach(Cell::new(from, 0));
    [0, 1, 2, 3].map(|x| *reach.get(Cell::new(x, 0)).unwrap() == Reach::Reached)
}

#[test]
fn a_step_that_the_body_has_driven_is_possible_for_ever_in_both_directions() {
    for body_evidence in [BodyEvidence::Belief, BodyEvidence::Off] {
        let mut corridor = corridor(|p| p.body_evidence = body_evidence, 10, 0.3);
        let [a, wall, b] = [1, 2, 3].map(|x| Cell::new(x, 0));
        assert_eq!(reached(&corridor, 0), [true, true, false, false]);
        corridor.planner.drove(a, wall);
        corridor.planner.drove(wall, b);
        assert_eq!(reached(&corridor, 0), [true; 4], "{body_evidence:?}");
        assert_eq!(reached(&corridor, 3), [true; 4], "{body_evidence:?}");
        corridor
            .know(2, &[0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.001, 0.99, 0.001, 0.001]);
        assert_eq!(reached(&corridor, 3), [true; 4], "{body_evidence:?}");
    }
}

#[test]
fn a_bump_closes_its_step_and_the_cell_unless_the_robot_stood_there() {
    let bump = |stood: bool| {
        let mut corridor = corridor(|_| (), 0, 0.3);
        assert_eq!(reached(&corridor, 0), [true; 4]);
        if stood {
            corridor.planner.stand_on(Cell::new(2, 0));
        }
        corridor.planner.bump(Cell::new(1, 0), Cell::new(2, 0), nalgebra::Point2::origin());
        [reached(&corridor, 0), reached(&corridor, 3)]
    };
    assert_eq!(bump(false), [[true, true, false, false], [false, false, false, true]]);
    assert_eq!(bump(true), [[true, true, false, false], [false, false, true, true]]);
}
