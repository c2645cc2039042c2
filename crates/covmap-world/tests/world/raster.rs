//! Worlds made from rasters, drawn as pictures.

use covmap::{Cell, Grid, Raster};
use covmap_world::{SonarPhysics, Surface, World};
use nalgebra::{Isometry2, Point2, Vector2};
use proptest::prelude::*;

/// Returns a raster of cells of .5 m from a picture, the top row first.
pub(crate) fn picture(rows: &[&str]) -> Raster<bool> {
    let corner = Point2::new(-3.0, 2.0);
    let grid = Grid::new(corner, 0.5, rows[0].len(), rows.len()).unwrap();
    let values = rows.iter().rev().flat_map(|row| row.bytes().map(|b| b == b'#')).collect();
    Raster::from_values(grid, values).unwrap()
}

fn build(solid: &Raster<bool>) -> World {
    World::from_raster("picture", solid, Surface::Smooth).unwrap()
}

#[test]
fn a_raster_is_covered_where_it_is_solid() {
    let solid = picture(&["##..", "#..#", "...#", ".#.."]);
    let coverage = build(&solid).coverage(solid.grid());
    assert_eq!(coverage, solid.map(|&s| f64::from(u8::from(s))));
}

#[test]
fn a_wall_of_many_cells_is_one_smooth_face() {
    let solid = picture(&["########", "........", "........", "........"]);
    let world = build(&solid);
    let ring = covmap_sonar::SonarRing::b21r();
    let physics = SonarPhysics::b21r().without_noise();
    // Axis 45° from the wall's normal: nothing in the cone is within 20°, and no joint answers.
    let pose = nalgebra::Isometry2::new(Vector2::new(-1.0, 2.8), 45.0_f64.to_radians());
    let beam = covmap_sonar::Beam {
        pose: nalgebra::Isometry2::identity(),
        max_range: 1.2,
        ..ring.beams()[0]
    };
    assert_eq!(world.echo(&beam, &pose, &physics), None);
}

#[test]
fn what_is_solid_far_around_the_free_is_no_part_of_the_world() {
    // One free cell of .5 m, in column 3 of row 2, and one cell more around it.
    let solid = picture(&["#######", "#######", "###.###", "#######", "#######"]);
    let world = build(&solid);
    assert_eq!(world.lower_left(), Point2::new(-2.0, 2.5));
    assert_eq!(world.size(), Vector2::new(1.5, 1.5));
    assert_eq!(world.coverage(solid.grid()), solid.map(|&s| f64::from(u8::from(s))));
    // A raster without free cells stays as it is.
    assert_eq!(build(&picture(&["###", "###"])).size(), Vector2::new(1.5, 1.0));
    // A small room in a huge block of walls costs no more than the room.
    let grid = Grid::new(Point2::origin(), 0.05, 4000, 4000).unwrap();
    let room = |v: i32| (2000..2160).contains(&v);
    let solid = Raster::from_fn(grid, |cell| !(room(cell.x) && room(cell.y)));
    assert_eq!(build(&solid).grid(0.1).unwrap().len(), 92 * 92);
}

#[test]
fn a_turned_raster_is_the_same_room_in_another_place() {
    let solid = picture(&["#####", "#...#", "##..#", "#####"]);
    let pose = Isometry2::new(Vector2::new(0.3, -0.8), 1.0);
    let world = World::from_turned_raster("room", &solid, &pose, Surface::Smooth).unwrap();
    let straight = build(&solid);
    // By hand: the corners of 2.5 × 2 m at (−3, 2), turned by 1 rad and shifted, reach from
    // .3 − 3 cos 1 − 4 sin 1 to .3 − .5 cos 1 − 2 sin 1, and from −.8 − 3 sin 1 + 2 cos 1 to
    // −.8 − .5 sin 1 + 4 cos 1.
    let (low, high) = (world.lower_left(), world.lower_left() + world.size());
    assert!((low - Point2::new(-4.686_790_9, -2.243_808_3)).norm() < 1e-6, "{low}");
    assert!((high - Point2::new(-1.653_093_1, 0.940_473_7)).norm() < 1e-6, "{high}");
    for k in 0..500 {
        let (u, v) = (f64::from(k % 25) / 10.0, f64::from(k / 25) / 10.0);
        let point = Point2::new(-3.0 + u + 0.013, 2.0 + v + 0.017);
        assert_eq!(world.is_solid(pose * point), straight.is_solid(point), "{point}");
        let along = Vector2::new(0.6, 0.8);
        let ray =
            (straight.cast_ray(point, along, 9.0), world.cast_ray(pose * point, pose * along, 9.0));
        assert!((ray.0.unwrap() - ray.1.unwrap()).abs() < 1e-9, "{point}: {ray:?}");
    }
    // Five free cells of .25 m² are free, however the grid lies.
    let free: f64 =
        world.coverage(&world.grid(0.1).unwrap()).iter().map(|(_, c)| (1.0 - c) * 0.01).sum();
    assert!((free - 1.25).abs() < 1e-9, "{free}");
}

proptest! {
    #[test]
    fn a_turned_raster_has_the_same_free_area(
        cells in prop::collection::vec(any::<bool>(), 48), angle in -3.2..3.2f64,
    ) {
        let grid = Grid::new(Point2::new(1.0, -2.0), 0.25, 8, 6).unwrap();
        let solid = Raster::from_values(grid, cells).unwrap();
        let pose = Isometry2::new(Vector2::new(-2.0, 3.0), angle);
        let world = World::from_turned_raster("turned", &solid, &pose, Surface::Rough).unwrap();
        let free = solid.values().iter().filter(|solid| !**solid).count() as f64 / 16.0;
        let coverage = world.coverage(&world.grid(0.1).unwrap());
        let found: f64 = coverage.iter().map(|(_, c)| (1.0 - c) * 0.01).sum();
        prop_assert!((found - free).abs() < 1e-8, "{found} {free}");
    }

    #[test]
    fn a_raster_is_solid_where_it_says(cells in prop::collection::vec(any::<bool>(), 48)) {
        let grid = Grid::new(Point2::new(1.0, -2.0), 0.25, 8, 6).unwrap();
        let solid = Raster::from_values(grid, cells).unwrap();
        let world = build(&solid);
        prop_assert_eq!(world.coverage(&grid), solid.map(|&s| f64::from(u8::from(s))));
        for (cell, &expected) in solid.iter() {
            prop_assert_eq!(world.is_solid(grid.center(cell)), expected);
            if !expected {
                let ray = world.cast_ray(grid.center(cell), Vector2::x(), 10.0).unwrap();
                let mut free = 0;
                while solid.get(cell.offset(free + 1, 0)) == Some(&false) {
                    free += 1;
                }
                prop_assert!((ray - 0.25 * (f64::from(free) + 0.5)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn another_resolution_gives_the_share_of_the_area(cells in prop::collection::vec(any::<bool>(), 64)) {
        let grid = Grid::new(Point2::new(-1.0, 0.5), 0.5, 8, 8).unwrap();
        let solid = Raster::from_values(grid, cells).unwrap();
        let coarse = Grid::new(grid.lower_left(), 1.0, 4, 4).unwrap();
        for (cell, covered) in build(&solid).coverage(&coarse).iter() {
            let part = |dx, dy| solid.get(Cell::new(2 * cell.x + dx, 2 * cell.y + dy)).unwrap();
            let count = [part(0, 0), part(1, 0), part(0, 1), part(1, 1)];
            let share = count.iter().filter(|s| ***s).count() as f64 / 4.0;
            prop_assert!((covered - share).abs() < 1e-12);
        }
    }
}

#[test]
fn a_million_scattered_cells_are_a_world() {
    use rand_pcg::rand_core::Rng;
    let grid = Grid::new(Point2::origin(), 0.05, 1000, 1000).unwrap();
    let mut rng = covmap_statistics::stream(1, "raster", 0);
    let solid = Raster::from_fn(grid, |_| rng.next_u32().is_multiple_of(8));
    let world = build(&solid);
    assert_eq!(world.coverage(&grid), solid.map(|&s| f64::from(u8::from(s))));
    assert!(world.size() == Vector2::new(50.0, 50.0));
}
