//! Values worked out by hand, or by a few lines of Python, with their derivation: the fast and the
//! literal formulas share code, and would be wrong alike.
#![allow(clippy::float_cmp, clippy::unwrap_used, reason = "tests compare exact values")]

use covmap::lanes::{LANES, TOGETHER};
use covmap::{
    Cell, Class, CoverageMap, EvidenceBlock, Grid, Histogram, PROBABILITY_FLOOR, Raster,
    bin_coverage, lower_bin, product,
};
use covmap_statistics::{crps, log_likelihood, randomised_pit};
use nalgebra::{Point2, Vector2};

/// Three readings of a cell of three bins. From a uniform prior Eq. (8) and (11) give
///
/// ```text
/// [.5 .3 .2] × [.2 .3 .5] = [.10 .09 .10], /.29 = [.344828 .310345 .344828]
///            × [.1 .3 .6] = [.010 .027 .060], /.097 = [.103093 .278351 .618557]
/// −Σ p log p = 1.029653, 1.097409, .887349
/// ```
const READINGS: [[f64; 3]; 3] = [[0.5, 0.3, 0.2], [0.2, 0.3, 0.5], [0.1, 0.3, 0.6]];
const POSTERIORS: [[f64; 3]; 3] = [
    [0.5, 0.3, 0.2],
    [0.344_827_59, 0.310_344_83, 0.344_827_59],
    [0.103_092_78, 0.278_350_52, 0.618_556_70],
];
const ENTROPIES: [f64; 3] = [1.029_653_01, 1.097_408_83, 0.887_348_92];

#[track_caller]
fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} is not {expected}");
}

#[track_caller]
fn all_close(actual: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(actual.len(), expected.len());
    actual.iter().zip(expected).for_each(|(a, e)| close(*a, *e, tolerance));
}

fn empty(bins: usize) -> CoverageMap {
    CoverageMap::new(Grid::new(Point2::origin(), 0.1, 4, 3).unwrap(), bins).unwrap()
}

fn posterior(map: &CoverageMap, cell: Cell) -> Vec<f64> {
    let mut out = vec![0.0; map.bins()];
    map.read_posterior(cell, &mut out);
    out
}

#[test]
fn entropy_is_in_nats() {
    // ½ ln 2 + ¼ ln 4 + ¼ ln 4 = 1.5 ln 2.
    let h = Histogram::from_weights(&[2.0, 1.0, 1.0]).unwrap();
    close(h.entropy(), 1.5 * std::f64::consts::LN_2, 1e-12);
    // ln 11
    close(empty(11).entropy(Cell::new(0, 0)), 2.397_895_27, 1e-6);
}

#[test]
fn bins_stand_at_coverages() {
    assert_eq!((bin_coverage(2, 11), bin_coverage(0, 2), bin_coverage(1, 2)), (0.2, 0.0, 1.0));
    // .1·0 + .2·⅓ + .3·⅔ + .4·1
    close(Histogram::from_weights(&[0.1, 0.2, 0.3, 0.4]).unwrap().mean(), 2.0 / 3.0, 1e-12);
}

#[test]
fn a_product_returns_its_sum() {
    let mut out = [0.0; 3];
    close(product(&READINGS[0], &READINGS[1], &mut out), 0.29, 1e-12);
    all_close(&out, &[0.10, 0.09, 0.10], 1e-12);
}

#[test]
fn a_posterior_is_the_product_of_all_readings() {
    let (mut map, cell) = (empty(3), Cell::new(2, 1));
    let mut before = 1.098_612_29; // ln 3
    for i in 0..3 {
        let change = map.multiply(cell, &READINGS[i]).unwrap();
        assert_eq!(change.cell, cell);
        close(change.before, before, 2e-6);
        close(change.after, ENTROPIES[i], 2e-6);
        all_close(&posterior(&map, cell), &POSTERIORS[i], 1e-6);
        close(map.entropy(cell), ENTROPIES[i], 2e-6);
        before = change.after;
    }
    assert_eq!(map.mode(cell), 1.0);
    // ½ · .278351 + .618557
    close(map.mean(cell), 0.757_732, 1e-6);
    assert!(map.grid().cells().all(|c| map.is_known(c) == (c == cell)));
}

#[test]
fn many_cells_side_by_side_have_the_same_posteriors() {
    let (mut map, cell, other) = (empty(3), Cell::new(3, 2), Cell::new(1, 0));
    // The cell is in the last lane; the first lane has another cell, with coverages the other way round.
    let (first, last) = (0, LANES - 1);
    let mut cells = [EvidenceBlock::NO_CELL; LANES];
    (cells[first], cells[last]) = (1, 11);
    let mut block = EvidenceBlock::new(3);
    for i in 0..3 {
        for bin in 0..3 {
            let row = &mut block.weights()[bin / TOGETHER][bin % TOGETHER];
            #[allow(clippy::cast_possible_truncation, reason = "weights are f32")]
            ((row[first], row[last]) = (READINGS[i][2 - bin] as f32, READINGS[i][bin] as f32));
        }
        let mut changes = Vec::new();
        map.multiply_block(&mut block, &cells, |lane, _, after| changes.push((lane, after)));
        assert_eq!(changes.iter().map(|c| c.0).collect::<Vec<_>>(), [first, last]);
        changes.iter().for_each(|c| close(c.1, ENTROPIES[i], 2e-6));
        all_close(&posterior(&map, cell), &POSTERIORS[i], 1e-6);
        let mut reversed = posterior(&map, other);
        reversed.reverse();
        all_close(&reversed, &POSTERIORS[i], 1e-6);
    }
    assert_eq!((map.mode(cell), map.mode(other)), (1.0, 0.0));
    assert_eq!(map.grid().cells().filter(|c| map.is_known(*c)).count(), 2);
}

#[test]
fn a_tie_is_the_lower_coverage_one_by_one_and_side_by_side() {
    let mut map = empty(4);
    assert_eq!(map.mode(Cell::new(0, 0)), 0.0);
    map.multiply(Cell::new(0, 0), &[0.1, 0.4, 0.4, 0.1]);
    assert_eq!(map.mode(Cell::new(0, 0)), 1.0 / 3.0);
    let mut block = EvidenceBlock::new(4);
    // Beside the tie: a bin larger than the one before it need not be the largest.
    for (bin, weights) in [[0.25, 0.5], [0.5, 0.1], [0.5, 0.3], [0.5, 0.1]].iter().enumerate() {
        block.weights()[bin / TOGETHER][bin % TOGETHER][..2].copy_from_slice(weights);
    }
    let mut cells = [EvidenceBlock::NO_CELL; LANES];
    (cells[0], cells[1]) = (1, 2);
    map.multiply_block(&mut block, &cells, |_, _, _| ());
    assert_eq!((map.mode(Cell::new(1, 0)), map.mode(Cell::new(2, 0))), (1.0 / 3.0, 0.0));
}

#[test]
fn no_bin_falls_below_the_floor() {
    assert_eq!(PROBABILITY_FLOOR, 1e-9);
    let (mut map, cell) = (empty(2), Cell::new(0, 0));
    map.multiply(cell, &[1.0, 0.0]);
    close(posterior(&map, cell)[1], 1e-9, 1e-15);
    // From 1 : 10⁻⁹ a reading of 10⁻⁹ : 1 leads to even odds, and one of 10⁻¹⁰ : 1 to 1 : 10.
    map.multiply(cell, &[1e-9, 1.0]);
    all_close(&posterior(&map, cell), &[0.5, 0.5], 1e-6);
    map.multiply(cell, &[1.0, 0.0]);
    map.multiply(cell, &[1e-10, 1.0]);
    all_close(&posterior(&map, cell), &[1.0 / 11.0, 10.0 / 11.0], 1e-6);
    // Side by side as well.
    let mut block = EvidenceBlock::new(2);
    block.weights()[0][1] = [0.0; LANES];
    let mut cells = [EvidenceBlock::NO_CELL; LANES];
    cells[0] = 1;
    map.multiply_block(&mut block, &cells, |_, _, _| ());
    close(posterior(&map, Cell::new(1, 0))[1], 1e-9, 1e-15);
}

#[test]
fn a_pinned_cell_is_free_but_for_the_floor() {
    let (mut map, cell) = (empty(11), Cell::new(1, 2));
    map.multiply(cell, &[0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 1.0]);
    map.pin_free(cell);
    let p = posterior(&map, cell);
    close(p[0], 1.0, 1e-7);
    p[1..].iter().for_each(|p| close(*p, 1e-9, 1e-14));
    assert!(map.is_pinned(cell) && !map.is_pinned(Cell::new(2, 1)));
    let index = map.grid().index(cell).unwrap();
    assert!(!map.is_changeable(index) && map.is_changeable(index - 1));
}

#[test]
fn evidence_that_says_nothing_makes_a_cell_known_once() {
    let (mut map, cell) = (empty(4), Cell::new(0, 1));
    assert!(map.multiply(cell, &[0.25; 4]).is_some() && map.is_known(cell));
    assert_eq!(map.multiply(cell, &[0.25; 4]), None);
    // Side by side as well.
    let (mut block, mut cells) = (EvidenceBlock::new(4), [EvidenceBlock::NO_CELL; LANES]);
    cells[3] = 1;
    for expected in [1, 0] {
        block.weights()[0] = [[1.0; LANES]; TOGETHER];
        let mut changes = 0;
        map.multiply_block(&mut block, &cells, |_, _, _| changes += 1);
        assert_eq!((changes, map.is_known(Cell::new(1, 0))), (expected, true));
    }
}

#[test]
fn the_interval_leaves_out_what_both_tails_hold() {
    let (mut map, cell) = (empty(5), Cell::new(0, 0));
    map.multiply(cell, &[0.05, 0.2, 0.4, 0.3, 0.05]);
    // Tails of at most .1 each, and of at most .025 each.
    assert_eq!(map.credible_interval(cell, 0.8), (0.25, 0.75));
    assert_eq!(map.credible_interval(cell, 0.95), (0.0, 1.0));
}

#[test]
fn scores_of_a_coverage_between_two_bins() {
    // The truth .25 is half way between the bins 0 and ½.
    let p = [0.2, 0.5, 0.3];
    assert_eq!(lower_bin(0.25, 3), (0, 0.5));
    assert_eq!((lower_bin(1.0, 3), lower_bin(0.5, 3)), ((1, 1.0), (1, 0.0)));
    // With η = .1: ½ log(.9 · .2 + .1/3) + ½ log(.9 · .5 + .1/3).
    close(log_likelihood(&p, 0.25, 0.1), -1.135_974_06, 1e-8);
    // A quarter of the way from ½ to 1: ¾ log .5 + ¼ log .3 = −.519860 − .300993.
    close(log_likelihood(&p, 0.625, 0.0), -0.820_853_6, 1e-6);
    // F is .2 up to ½ and .7 up to 1: .25 · .2² + .25 · .8² + .5 · .3².
    close(crps(&p, 0.25), 0.01 + 0.16 + 0.045, 1e-12);
    // .4 of the mass of bin 0; or all of it, and .4 of that of the next.
    close(randomised_pit(&p, 0.25, 0.4, 0.6), 0.4 * 0.2, 1e-12);
    close(randomised_pit(&p, 0.25, 0.4, 0.2), 0.2 + 0.4 * 0.5, 1e-12);
    use Class::{Free, Partial, Solid};
    let classes = [0.0, 1e-10, 1e-8, 0.5, 1.0 - 1e-8, 1.0 - 1e-10, 1.0].map(Class::of);
    assert_eq!(classes, [Free, Free, Partial, Partial, Partial, Solid, Solid]);
}

#[test]
fn cells_are_counted_from_the_lower_left_corner_row_by_row() {
    let grid = Grid::new(Point2::new(-1.0, 2.0), 0.5, 4, 3).unwrap();
    let cell = Cell::new(1, 2);
    assert_eq!(grid.center(cell), Point2::new(-0.25, 3.25));
    assert_eq!(grid.lower_corner(cell), Point2::new(-0.5, 3.0));
    assert_eq!((grid.index(cell), grid.cell(9), grid.len()), (Some(9), cell, 12));
    assert_eq!((grid.index(Cell::new(4, 0)), grid.index(Cell::new(0, 3))), (None, None));
    assert_eq!(grid.unbounded_cell_at(Point2::new(-1.01, 1.9)), Cell::new(-1, -1));
    assert!(Cell::new(3, 0) < Cell::new(0, 1) && Cell::new(0, 1) < Cell::new(1, 1));
    let raster = Raster::from_fn(grid, |cell| cell.x * 10 + cell.y);
    assert_eq!((raster.get(cell), raster[9]), (Some(&12), 12));
}

#[test]
fn a_grid_covers_what_it_should_with_a_margin() {
    // 10.5 and 9.8 cells: 11 and 10, and one more on each side.
    let size = Vector2::new(1.05, 0.98);
    let grid = Grid::covering(Point2::new(0.3, 0.0), size, 0.1, 1).unwrap();
    assert_eq!((grid.width(), grid.height()), (13, 12));
    assert!((grid.lower_left() - Point2::new(0.2, -0.1)).norm() < 1e-12);
}
