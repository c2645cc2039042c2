//! The starts of a series.

use covmap::{Cell, Grid};
use covmap_statistics::{stream, uniform};
use covmap_world::World;
use nalgebra::Isometry2;
use std::f64::consts::TAU;

/// Draws the poses of `count` starts by a seed, in different cells of a grid, with random headings.
///
/// From each of the cells a robot of `radius` \[m\] can reach `home`, and has `room` \[m\] around it.
///
/// # Errors
/// If there are fewer such cells; the error is their number.
pub fn drawn_starts(
    world: &World,
    grid: &Grid,
    home: &Isometry2<f64>,
    (radius, room): (f64, f64),
    (count, seed): (usize, u64),
) -> Result<Vec<Isometry2<f64>>, usize> {
    let reachable = world.reachable_cells(grid, home.translation.vector.into(), radius);
    let roomy = |cell: Cell| world.clearance(grid.center(cell)) >= radius + room;
    let reached = reachable.iter().filter(|(_, reached)| **reached).map(|(cell, _)| cell);
    let mut cells: Vec<Cell> = reached.filter(|cell| roomy(*cell)).collect();
    if cells.len() < count {
        return Err(cells.len());
    }
    let mut random = stream(seed, "starts", 0);
    let pose = |_| {
        #[allow(clippy::cast_possible_truncation, reason = "a share of the number of cells")]
        let index = (uniform(&mut random) * cells.len() as f64) as usize;
        let cell = cells.swap_remove(index.min(cells.len() - 1));
        Isometry2::new(grid.center(cell).coords, TAU * uniform(&mut random))
    };
    Ok((0..count).map(pose).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface};

    /// Two rooms without a door between them.
    fn rooms() -> World {
        let shape = Shape::Wall { from: (3.0, 0.0), to: (3.0, 2.0), thickness: 0.1 };
        let obstacles = vec![Obstacle { shape, surface: Surface::Rough }];
        let extent = Extent { width: 5.0, height: 2.0 };
        let scenario = Scenario { name: "rooms".into(), extent, start: None, obstacles };
        World::from_scenario(&scenario, Surface::Rough).unwrap()
    }

    fn draw(count: usize, seed: u64) -> Result<Vec<Isometry2<f64>>, usize> {
        let world = rooms();
        let grid = world.grid(0.1).unwrap();
        let home = Isometry2::new([1.5, 1.0].into(), 0.0);
        drawn_starts(&world, &grid, &home, (0.27, 0.15), (count, seed))
    }

    #[test]
    fn drawn_starts_are_roomy_and_reachable_and_differ() {
        let starts = draw(20, 1).unwrap();
        for (i, start) in starts.iter().enumerate() {
            let at = start.translation.vector;
            assert!(rooms().clearance(at.into()) >= 0.27 + 0.15);
            assert!(at.x < 3.0, "the other room cannot be reached");
            assert!(starts[..i].iter().all(|other| (other.translation.vector - at).norm() > 0.05));
        }
    }

    #[test]
    fn a_seed_draws_the_same_starts_again() {
        assert_eq!(draw(5, 1), draw(5, 1));
        assert_ne!(draw(5, 1), draw(5, 2));
        assert!(draw(100_000, 1).is_err_and(|there| (100..100_000).contains(&there)));
    }
}
