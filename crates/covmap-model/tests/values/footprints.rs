//! The cells that belong to each beam.

use super::{at, beam, close, grid};
use covmap_model::{Footprint, FootprintCell, FootprintRule};
use covmap_sonar::{Beam, SonarRing};
use nalgebra::Isometry2;

fn footprint(beams: &[Beam], rule: FootprintRule) -> Footprint {
    Footprint::new(&SonarRing::new(beams.to_vec()).unwrap(), &rule).unwrap()
}

fn sectors(degrees: f64) -> FootprintRule {
    FootprintRule::Sectors { half_angle: degrees.to_radians() }
}

fn cones(degrees: f64) -> FootprintRule {
    FootprintRule::Cones { half_angle: degrees.to_radians() }
}

fn covered(footprint: &Footprint, beam: usize, reach: f64) -> Vec<FootprintCell> {
    let (mut cells, pose) = (Vec::new(), Isometry2::identity());
    footprint.for_each_cell(&grid(), &pose, beam, reach, |cell| cells.push(cell));
    cells
}

/// The number of the beam that covers each cell, `*` for several, from (−3, 3) to (3, −3).
#[track_caller]
fn check(footprint: &Footprint, reach: f64, expected: [&str; 7]) {
    let all: Vec<_> = (0..footprint.beams()).map(|beam| covered(footprint, beam, reach)).collect();
    let mark = |x: i32, y: i32| {
        let holds = |cells: &Vec<FootprintCell>| cells.iter().any(|c| c.cell == at(x, y));
        let beams: Vec<usize> = (0..all.len()).filter(|beam| holds(&all[*beam])).collect();
        match beams[..] {
            [] => '.',
            [beam] => char::from_digit(u32::try_from(beam).unwrap(), 10).unwrap(),
            _ => '*',
        }
    };
    let drawn: Vec<String> =
        (-3..=3).rev().map(|y| (-3..=3).map(|x| mark(x, y)).collect()).collect();
    assert_eq!(drawn, expected, "\n{}", drawn.join("\n"));
}

#[test]
fn sectors_tile_the_plane_and_their_first_border_is_theirs() {
    // Axes at 0°, 90°, 180°, 270°: the borders are the diagonals, and a cell on one belongs to the
    // beam that lies counter-clockwise of it. Exactly 3 m away is (3, 0), and (3, 1) is √10 m.
    let beams = [0.0, 90.0, 180.0, 270.0].map(|angle| beam(0.0, 0.0, angle));
    check(
        &footprint(&beams, sectors(45.0)),
        3.0,
        ["...1...", ".21111.", ".22110.", "222.000", ".23300.", ".33330.", "...3..."],
    );
}

#[test]
fn sectors_meet_half_way_between_two_axes_and_are_no_wider_than_they_should() {
    // Axes at 0°, 40° and 180°, 30° to each side, but 20° to where the first two meet:
    // [−30°, 20°), [20°, 70°) and [150°, 210°).
    //   (3, 1) 18.4°   (2, 1) 26.6°   (1, 3) 71.6°   (1, 2) 63.4°   (−1, 1) 135°
    //   (2, −1) −26.6° (1, −1) −45°   (3, −2) −33.7° (−2, 1) 153.4° (−2, −1) 206.6°
    let beams = [0.0, 40.0, 180.0].map(|angle| beam(0.0, 0.0, angle));
    check(
        &footprint(&beams, sectors(30.0)),
        9.0,
        [".....11", "....111", "22..110", "222.000", "22...00", ".......", "......."],
    );
}

#[test]
fn bearings_are_measured_from_the_centre_and_distances_from_the_sensor() {
    // A sensor 1 m before the centre: (2, ±1) are at 26.6° from the centre, and at 45° from the
    // sensor. They are √2 m from it.
    let ring = [beam(1.0, 0.0, 0.0)];
    check(
        &footprint(&ring, sectors(30.0)),
        1.5,
        [".......", ".......", ".....0.", ".....0.", ".....0.", ".......", "......."],
    );
    let cells = covered(&footprint(&ring, sectors(30.0)), 0, 1.5);
    let distances: Vec<f64> = cells.iter().map(|c| c.cell_distance).collect();
    assert_eq!(distances.len(), 3);
    for (distance, expected) in distances.iter().zip([2f64.sqrt(), 1.0, 2f64.sqrt()]) {
        close(*distance, expected, 1e-12);
    }
    // Of the cone's borders the first, to the right, is its own.
    check(
        &footprint(&ring, cones(45.0)),
        1.5,
        [".......", ".......", ".......", ".....0.", ".....0.", ".......", "......."],
    );
}

#[test]
fn a_reach_holds_what_is_exactly_so_far_away() {
    let ray = footprint(&[beam(0.0, 0.0, 0.0)], cones(0.0));
    let cells = |reach| covered(&ray, 0, reach).len();
    assert_eq!((cells(2.0), cells(1.999), cells(0.0)), (2, 1, 0));
}

#[test]
fn a_ray_covers_no_cell_that_it_enters_beyond_its_reach() {
    // At 19° it enters cell (1, 1) near its corner at (1.5, .5), after .5/sin 19° = 1.536 m; the
    // centre is at √2 m.
    let ray = footprint(&[beam(0.0, 0.0, 19.0)], cones(0.0));
    let covers = |reach| covered(&ray, 0, reach).iter().any(|c| c.cell == at(1, 1));
    assert_eq!([1.53, 1.54].map(covers), [false, true]);
}
