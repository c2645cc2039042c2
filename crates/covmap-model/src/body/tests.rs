//! Contacts in small maps.

use super::*;

fn map(width: usize, height: usize) -> CoverageMap {
    let grid = Grid::new(Point2::origin(), 0.1, width, height).unwrap();
    CoverageMap::new(grid, 11).unwrap()
}

/// Makes a cell free or solid with the odds `weight` against 1.
fn believe(map: &mut CoverageMap, cell: Cell, coverage: usize, weight: f64) {
    let mut evidence = [1.0; 11];
    evidence[coverage] = weight;
    map.multiply(cell, &evidence);
}

#[test]
fn what_alone_can_have_been_touched_was() {
    // A body of .1 m in a corridor that is one cell wide: of its front only cell 3 may be
    // covered.
    let mut map = map(5, 1);
    let mut body = Body::new(*map.grid(), 0.05);
    map.pin_free(Cell::new(2, 0));
    let changes = body.touched(&mut map, Point2::new(0.26, 0.05), Vector2::x());
    assert_eq!(changes.iter().map(|c| c.cell).collect::<Vec<_>>(), [Cell::new(3, 0)]);
    // Of a uniform prior p(c) ∝ c + .001, and 0 + .1 + … + 1 = 5.5.
    for (k, p) in (0u32..).zip(map.histogram(Cell::new(3, 0)).probabilities()) {
        let expected = (0.1 * f64::from(k) + 0.001) / 5.511;
        assert!((p - expected).abs() < 1e-7, "{k}: {p}");
    }
    assert!(body.touched(&mut map, Point2::new(0.05, 9.0), Vector2::x()).is_empty());
    assert!(body.touched(&mut map, Point2::new(f64::NAN, 0.0), Vector2::x()).is_empty());
}

/// Two cells, one above the other, ahead of a wide body that is in the cells before them.
fn two_cells() -> (CoverageMap, Body, [Cell; 2]) {
    let mut map = map(3, 2);
    let body = Body::new(*map.grid(), 0.09);
    [0, 1].into_iter().for_each(|y| {
        map.pin_free(Cell::new(0, y));
    });
    (map, body, [Cell::new(1, 0), Cell::new(1, 1)])
}

fn touch_both(map: &mut CoverageMap, body: &mut Body) {
    body.touched(map, Point2::new(0.049, 0.1), Vector2::x());
}

#[test]
fn each_cell_may_be_it_by_its_share_and_its_coverage() {
    let (mut map, mut body, [low, high]) = two_cells();
    believe(&mut map, low, 0, 10.0);
    believe(&mut map, high, 10, 10.0);
    let mean = [map.mean(low), map.mean(high)];
    let before = map.histogram(low);
    touch_both(&mut map, &mut body);
    // Their shares are equal: p(c) ∝ h(c) · (c + E[c of the other]).
    let factor = |c: f64| c + mean[1];
    let weights: Vec<f64> = before
        .probabilities()
        .iter()
        .enumerate()
        .map(|(k, p)| p * factor(bin_coverage(k, 11)))
        .collect();
    let sum: f64 = weights.iter().sum();
    let after = map.histogram(low);
    for k in [0, 5, 10] {
        let expected = weights[k] / sum;
        let found = after.probabilities()[k];
        assert!((found - expected).abs() < 1e-6, "{k}: {found} {expected}");
    }
    // The wall explains the contact.
    assert!(map.mode(low) < 0.1 && map.mode(high) > 0.9);
}

#[test]
fn a_contact_stays_true_when_readings_speak_against_it() {
    let (mut map, mut body, cells) = two_cells();
    touch_both(&mut map, &mut body);
    let free = [3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
    for _ in 0..200 {
        let changes = cells.iter().filter_map(|cell| map.multiply(*cell, &free)).collect();
        body.hold(&mut map, changes);
    }
    // Both look free, and one of them is not: half of the probability each, but both may be
    // covered, whatever the readings say.
    for cell in cells {
        let p = 1.0 - map.histogram(cell).probabilities()[0];
        assert!((0.5..0.6).contains(&p), "{p}");
        assert!(map.entropy(cell) > 0.6);
    }
    // The body reaches one of them: then the other one was touched.
    let changes = map.pin_free(cells[0]).into_iter().collect();
    let changes = body.hold(&mut map, changes);
    assert_eq!(changes.iter().map(|c| c.cell).collect::<Vec<_>>(), cells);
    // p(0) of a tenth in doubt: .909 · .001 against .0091 · 5.5.
    let p = map.histogram(cells[1]).probabilities()[0];
    assert!((p - 0.018).abs() < 0.003, "{p}");
}

/// Returns the map of a wall at some x: the readings say `says` of all cells, 50 times before and
/// once after each contact. The body touches the wall in each row from 4 to 15.
fn bumped_wall(wall: f64, says: impl Fn(Cell) -> [f64; 11]) -> CoverageMap {
    let mut map = map(20, 20);
    let mut body = Body::new(*map.grid(), 0.27);
    let all: Vec<Cell> = map.grid().cells().collect();
    let hear = |map: &mut CoverageMap, body: &mut Body| {
        let changes = all.iter().filter_map(|cell| map.multiply(*cell, &says(*cell))).collect();
        body.hold(map, changes);
    };
    (0..50).for_each(|_| hear(&mut map, &mut body));
    for y in 4..16 {
        let home = Point2::new(0.65, 0.1 * f64::from(y) + 0.05);
        let at = Point2::new(wall - 0.27 - 1e-6, home.y);
        body.moved(&mut map, home, at);
        body.touched(&mut map, at, Vector2::x());
        body.moved(&mut map, at, home);
        hear(&mut map, &mut body);
    }
    map
}

const FREE: [f64; 11] = [3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
const SOLID: [f64; 11] = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 3.0];

#[test]
fn a_wall_that_mirrors_every_sound_is_not_free_where_it_was_touched() {
    for step in 0..20 {
        let wall = 1.0 + 0.005 * f64::from(step);
        let map = bumped_wall(wall, |_| FREE);
        // Except at its ends, where another cell beside may have been touched as well.
        for y in 6..14 {
            let (at, behind) = (Cell::new(10, y), Cell::new(11, y));
            let p = 1.0 - map.histogram(at).probabilities()[0];
            assert!(map.entropy(at) > 0.6 && p > 0.2, "{wall} {y}: {:?}", map.histogram(at));
            // The touched object may be as deep as a part of a cell.
            if wall < 1.09 {
                assert!(map.mode(behind) < 0.1 && map.entropy(behind) < 0.6, "{wall} {y}");
            }
        }
    }
}

#[test]
fn a_wall_that_is_heard_is_not_forgotten_where_it_was_touched() {
    let map = bumped_wall(1.0, |cell| if cell.x >= 10 { SOLID } else { FREE });
    for y in 5..15 {
        let (before, wall) = (Cell::new(9, y), Cell::new(10, y));
        assert!(map.mode(wall) > 0.9 && map.entropy(wall) < 0.6, "{y}");
        assert!(map.mode(before) < 0.1 && map.entropy(before) < 0.6, "{y}");
    }
}

#[test]
fn what_nobody_measured_is_no_wall_for_a_small_share() {
    let mut map = map(20, 20);
    let mut body = Body::new(*map.grid(), 0.27);
    body.moved(&mut map, Point2::new(0.65, 1.05), Point2::new(0.73, 1.05));
    let known = |map: &CoverageMap| {
        let cells = map.grid().cells();
        cells.filter(|c| map.is_known(*c) && !map.is_pinned(*c)).count()
    };
    let changes = body.touched(&mut map, Point2::new(0.73, 1.05), Vector2::x());
    assert_eq!((changes.len(), known(&map)), (0, 0));
}

#[test]
fn absurd_places_are_no_contact() {
    let mut map = map(4, 4);
    let grid = *map.grid();
    for (radius, x) in [(-1.0, 0.2), (f64::NAN, 0.2), (1e9, 0.2), (0.2, 1e30)] {
        let at = Point2::new(x, 0.2);
        assert!(Body::new(grid, radius).touched(&mut map, at, Vector2::x()).is_empty());
    }
}
