//! Counting, occupancy, and the body.

use super::{all_close, at, close, grid, model, parameters, scan};
use covmap::{Cell, CoverageMap, Raster};
use covmap_model::{
    Body, Counting, OccupancyGrid, OccupancyParameters, ScanCounts, cells_under_body,
    integrate_body, intercepted,
};
use covmap_sonar::Range;
use nalgebra::{Point2, Vector2};

/// The cells that a reading intercepts, by how many metres they are ahead.
fn hit(range: Range) -> Vec<i32> {
    let cells = intercepted(&model(&parameters()), &grid(), &scan(range));
    for (cell, distance) in &cells {
        assert_eq!(cell.y, 10);
        close(*distance, f64::from(cell.x - 10), 1e-12);
    }
    cells.into_iter().map(|(cell, _)| cell.x - 10).collect()
}

#[test]
fn a_reading_intercepts_the_cells_up_to_its_end_and_none_behind() {
    assert_eq!(hit(Range::Echo(4.0)), [1, 2, 3, 4]);
    // δ = r/2: the beam ends at the border of the fourth cell, which it touches.
    assert_eq!(hit(Range::Echo(3.5)), [1, 2, 3, 4]);
    assert_eq!(hit(Range::Echo(3.4)), [1, 2, 3]);
    assert_eq!(hit(Range::Echo(7.0)), [1, 2, 3, 4, 5]);
    assert_eq!(hit(Range::NoEcho), [1, 2, 3]);
    assert_eq!(hit(Range::Missing), [0; 0]);
}

#[test]
fn longer_beams_count_less() {
    // 1/(1 + d/2): whole at the sensor, half at 2 m, a quarter at 6 m.
    let discounted = Counting::Discounted { half_distance: 2.0 };
    all_close(
        &[0.0, 1.0, 2.0, 6.0].map(|d| discounted.weight(d)),
        &[1.0, 2.0 / 3.0, 0.5, 0.25],
        1e-12,
    );
    close(Counting::Plain.weight(6.0), 1.0, 1e-12);
}

#[test]
fn weights_add_up() {
    let count = |counting| {
        let mut counts = ScanCounts::new(grid(), counting);
        counts.add(&[(at(1, 0), 2.0), (at(2, 0), 6.0)]);
        counts.add(&[(at(1, 0), 6.0), (Cell::new(-1, 0), 1.0)]);
        [at(1, 0), at(2, 0), at(3, 0)].map(|cell| *counts.weights().get(cell).unwrap())
    };
    all_close(&count(Counting::Plain), &[2.0, 1.0, 0.0], 1e-12);
    let discounted = Counting::Discounted { half_distance: 2.0 };
    all_close(&count(discounted), &[0.75, 0.25, 0.0], 1e-12);
}

/// The probabilities 1 … 6 m ahead after some readings; −1 where nothing is known.
fn occupancy(parameters: OccupancyParameters, readings: &[Range], pin: Option<Cell>) -> Vec<f64> {
    let model = model(&super::parameters());
    let mut occupancy = OccupancyGrid::new(grid(), parameters);
    pin.into_iter().for_each(|cell| occupancy.pin_free(cell));
    readings.iter().for_each(|range| occupancy.integrate(&model, &scan(*range)));
    let probabilities: Raster<Option<f64>> = occupancy.probabilities();
    (1..=6).map(|x| probabilities.get(at(x, 0)).unwrap().unwrap_or(-1.0)).collect()
}

const PARAMETERS: OccupancyParameters =
    OccupancyParameters { hit: 0.7, miss: 0.4, no_echo: 0.45, clamp: None };

#[test]
fn log_odds_add_up() {
    // Odds: a miss 2/3, a hit 7/3, no echo 9/11. The third cell is missed and then hit: 14/9.
    let readings = [Range::Echo(4.0), Range::Echo(3.0), Range::NoEcho];
    let odds = |o: f64| o / (1.0 + o);
    let free = odds(2.0 / 3.0 * 2.0 / 3.0 * 9.0 / 11.0);
    let expected = [free, free, odds(14.0 / 9.0 * 9.0 / 11.0), odds(7.0 / 3.0), -1.0, -1.0];
    all_close(&occupancy(PARAMETERS, &readings, None), &expected, 1e-12);
    // 14/11 : 1 is .56, 4/11 : 1 is .26667.
    all_close(&expected[2..4], &[0.56, 0.7], 1e-12);
    close(free, 4.0 / 15.0, 1e-12);
}

#[test]
fn an_echo_from_beyond_misses_all_before_it() {
    let expected = [0.4, 0.4, 0.4, 0.4, 0.4, -1.0];
    all_close(&occupancy(PARAMETERS, &[Range::Echo(9.0)], None), &expected, 1e-12);
}

#[test]
fn what_is_pinned_or_clamped_goes_no_farther() {
    let parameters = OccupancyParameters { clamp: Some((0.3, 0.75)), ..PARAMETERS };
    let readings = [Range::Echo(2.0); 5];
    let [a, b, ..] = occupancy(parameters, &readings, None)[..] else { panic!() };
    all_close(&[a, b], &[0.3, 0.75], 1e-12);
    close(occupancy(PARAMETERS, &readings, Some(at(2, 0)))[1], 1e-9, 1e-12);
}

#[test]
fn a_body_is_over_the_centres_that_it_reaches() {
    let count = |from: (f64, f64), to: (f64, f64), radius| {
        let (from, to) = (Point2::new(from.0, from.1), Point2::new(to.0, to.1));
        cells_under_body(&grid(), from, to, radius).len()
    };
    // A centre exactly at the edge counts: five cells within 1 m, nine within √2.
    assert_eq!(count((0.0, 0.0), (0.0, 0.0), 0.999), 1);
    assert_eq!(count((0.0, 0.0), (0.0, 0.0), 1.0), 5);
    assert_eq!(count((0.0, 0.0), (0.0, 0.0), 1.4143), 9);
    // Along 2 m: three rows of three and the two ends.
    assert_eq!(count((0.0, 0.0), (2.0, 0.0), 1.0), 11);
    assert_eq!(count((0.0, 0.0), (2.0, 0.0), 0.0), 3);
    // At the corner of the grid a quarter of the disc is left.
    assert_eq!(count((-10.0, -10.0), (-10.0, -10.0), 1.0), 3);
}

#[test]
fn cells_entirely_under_the_body_are_free() {
    let freed = |to: f64, radius| {
        let mut map = CoverageMap::new(grid(), 3).unwrap();
        integrate_body(&mut map, Point2::origin(), Point2::new(to, 0.0), radius);
        map.grid().cells().filter(|cell| map.is_pinned(*cell)).collect::<Vec<_>>()
    };
    // The far corners of the four neighbours are at √(1.5² + .5²) = 1.58 m.
    assert_eq!(freed(0.0, 1.57), [at(0, 0)]);
    let cross = [at(0, -1), at(-1, 0), at(0, 0), at(1, 0), at(0, 1)];
    assert_eq!(freed(0.0, 1.59), cross);
    // Along 1 m the cross is one cell longer.
    assert_eq!(freed(1.0, 1.59).len(), 8);
}

/// The posteriors of the two cells ahead of a body that fills the two cells behind, side by side,
/// and touched something with the same share of its front in both.
fn touched(low: [f64; 3], high: [f64; 3]) -> [[f64; 3]; 2] {
    let grid = covmap::Grid::new(Point2::origin(), 1.0, 2, 2).unwrap();
    let mut map = CoverageMap::new(grid, 3).unwrap();
    let mut body = Body::new(grid, 0.9);
    [0, 1].into_iter().for_each(|y| {
        map.pin_free(Cell::new(0, y));
    });
    map.multiply(Cell::new(1, 0), &low);
    map.multiply(Cell::new(1, 1), &high);
    body.touched(&mut map, Point2::new(0.49, 1.0), Vector2::x());
    [0, 1].map(|y| {
        let mut p = [0.0; 3];
        map.read_posterior(Cell::new(1, y), &mut p);
        p
    })
}

#[test]
fn a_contact_says_that_one_of_the_cells_ahead_is_covered() {
    // Means .15 and .7: p(c) ∝ h(c) · (c + .7) and h(c) · (c + .15).
    //   [.8 .1 .1] × [.7 1.2 1.7] = [.56 .12 .17], /.85
    //   [.2 .2 .6] × [.15 .65 1.15] = [.03 .13 .69], /.85
    let [low, high] = touched([0.8, 0.1, 0.1], [0.2, 0.2, 0.6]);
    all_close(&low, &[0.658_823_5, 0.141_176_5, 0.2], 1e-6);
    all_close(&high, &[0.035_294_1, 0.152_941_2, 0.811_764_7], 1e-6);
    // Where both are free, .1/3 is left to each coverage at least: [1 ε ε] becomes
    // [1 .0333 .0333]/1.0667 with the mean .046875; then × [.046875 .546875 1.046875].
    let [low, high] = touched([1.0, 1e-6, 1e-6], [1.0, 1e-6, 1e-6]);
    all_close(&low, &high, 1e-6);
    all_close(&low, &[0.468_75, 0.182_291_7, 0.348_958_3], 1e-4);
}
