//! The cells that can be reached and seen, as pictures.

use crate::build::{scenario, wall, world};
use crate::raster::picture;
use covmap::Raster;
use covmap_world::{Surface, World};
use nalgebra::{Point2, Vector2};

fn drawn(raster: &Raster<bool>) -> Vec<String> {
    let row = |row: &[bool]| row.iter().map(|&b| if b { 'o' } else { '.' }).collect();
    raster.values().chunks(raster.grid().width()).rev().map(row).collect()
}

#[track_caller]
fn check_reachable(solid: &[&str], start: (f64, f64), expected: &[&str]) {
    let solid = picture(solid);
    let world = World::from_raster("picture", &solid, Surface::Rough).unwrap();
    let start = Point2::new(start.0, start.1);
    assert_eq!(drawn(&world.reachable_cells(solid.grid(), start, 0.24)), expected);
}

#[test]
fn a_disc_reaches_what_its_width_lets_it() {
    check_reachable(
        &["......", ".####.", "......", "##.###", "......"],
        (-2.75, 2.25),
        &["oooooo", "o....o", "oooooo", "..o...", "oooooo"],
    );
}

#[test]
fn a_disc_does_not_squeeze_through_a_corner() {
    check_reachable(&["#..", ".#.", "..."], (-2.75, 2.25), &[".oo", "o.o", "ooo"]);
    check_reachable(&[".#.", "#..", "..."], (-2.75, 2.25), &["..o", ".oo", "ooo"]);
}

#[test]
fn an_unreachable_start_reaches_nothing() {
    check_reachable(&["###", "#.#", "###"], (-2.9, 2.1), &["...", "...", "..."]);
}

#[test]
fn sight_ends_at_the_first_solid() {
    let solid = picture(&["......", "......", "..##..", "......", "......"]);
    let world = World::from_raster("picture", &solid, Surface::Rough).unwrap();
    let grid = *solid.grid();
    let coverage = world.coverage(&grid);
    let mut from = Raster::filled(grid, false);
    from[2 * grid.width()] = true;
    let seen = world.cells_seen(&grid, &coverage, &from, 9.0);
    assert_eq!(drawn(&seen.in_sight), ["oooooo", "ooooo.", "oo....", "ooooo.", "oooooo"]);
    assert_eq!(drawn(&seen.first_solid), ["......", "......", "..o...", "......", "......"]);
}

#[test]
fn the_border_is_the_first_solid_of_an_empty_room() {
    let world = world(2.0, 1.0, &[], Surface::Rough);
    let grid = world.grid(0.25).unwrap();
    let coverage = world.coverage(&grid);
    let from = coverage.map(|&c| c == 0.0);
    let seen = world.cells_seen(&grid, &coverage, &from, 3.0);
    assert_eq!(seen.in_sight, from);
    assert_eq!(seen.first_solid.values().iter().filter(|s| **s).count(), 2 * (8 + 4));
}

#[test]
fn the_default_start_is_the_roomiest_place_of_the_largest_room() {
    // The room on the right is wider, the one on the left larger.
    let shapes = [wall((6.0, 0.0), (6.0, 3.0), 0.1), wall((0.0, 1.5), (3.0, 1.5), 0.05)];
    let world =
        World::from_scenario(&scenario(8.0, 3.0, &shapes, Surface::Rough), Surface::Rough).unwrap();
    let grid = world.grid(0.1).unwrap();
    let start = world.default_start(&world.coverage(&grid), 0.27).unwrap();
    let at = Point2::from(start.translation.vector);
    assert!(at.x > 4.0 && at.x < 5.0 && (world.clearance(at) - 1.45).abs() < 0.06, "{at}");
    assert_eq!(start.rotation.angle(), 0.0);
    assert_eq!(world.default_start(&world.coverage(&grid), 2.0), None);
    assert!(world.clearance(at + Vector2::new(0.1, 0.0)) <= world.clearance(at));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let shapes = [wall((2.0, 0.3), (5.0, 4.0), 0.2), wall((1.0, 4.5), (7.0, 3.0), 0.1)];
    let world = world(8.0, 6.0, &shapes, Surface::Rough);
    let grid = world.grid(0.1).unwrap();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let coverage = world.coverage(&grid);
            let reached = world.reachable_cells(&grid, Point2::new(0.5, 0.5), 0.27);
            let seen = world.cells_seen(&grid, &coverage, &reached, 3.0);
            (coverage.map(|c| c.to_bits()), reached, seen)
        })
    };
    assert!(on(1) == on(3));
}
