//! Occupancy and coverage on the cells of oblique walls (claim 21).

use crate::error::Result;
use crate::runs::Units;
use covmap::{Class, CoverageMap, Raster};
use covmap_lab::{Config, SimulatedRobot};
use covmap_model::{OccupancyGrid, OccupancyParameters, integrate};
use covmap_sonar::{Range, Scan, SonarRing};
use covmap_world::{Extent, Obstacle, Scenario, Shape, Surface, World};
use nalgebra::{Isometry2, Point2};
use rayon::prelude::*;

/// The angles by which the walls are turned [°].
const TURNS: [f64; 6] = [7.0, 12.0, 17.0, 23.0, 29.0, 38.0];
/// The distances at which the robot drives past a wall \[m\]; it measures [`SCANS`] times …
const AWAY: [f64; 2] = [0.8, 1.2];
const SCANS: usize = 40;
/// … over this length \[m\].
const LENGTH: f64 = 2.0;
/// Cells in which fewer readings ended are not looked at: the paper speaks of cells in which "the sensors
/// repeatedly detect the obstacle".
const LEAST_ENDS: usize = 5;

/// The measurements on oblique walls.
///
/// Each unit is a (distance, seed) with mean occupancy, error of the occupancy, and error of the
/// expected coverage over the partly covered cells in which readings ended repeatedly; a group is what was measured of one
/// wall.
#[derive(Debug, Clone)]
pub struct Oblique(pub(crate) Units);

impl Oblique {
    /// The index of the occupancy.
    pub const OCCUPANCY: usize = 0;
    /// The index of the error of the occupancy.
    pub const OCCUPANCY_ERROR: usize = 1;
    /// The index of the error of the coverage.
    pub const COVERAGE_ERROR: usize = 2;

    /// Drives past each wall at two distances, with the seeds 1, 2, … `seeds`.
    pub fn measure(config: &Config, seeds: u64) -> Result<Self> {
        let group = |turn: f64| -> Result<Vec<Vec<f64>>> {
            let units = AWAY.into_iter().flat_map(|away| (1..=seeds).map(move |s| (away, s)));
            units.map(|(away, seed)| unit(config, turn.to_radians(), away, seed)).collect()
        };
        Ok(Self(Units(TURNS.into_par_iter().map(group).collect::<Result<_>>()?)))
    }
}

/// Returns a thick, turned wall through the middle of a hall.
fn wall(turn: f64) -> Scenario {
    let rectangle = Shape::Rectangle { center: (4.0, 4.0), size: (6.0, 0.4), angle: turn };
    Scenario {
        name: "oblique".into(),
        extent: Extent { width: 8.0, height: 8.0 },
        start: None,
        obstacles: vec![Obstacle { shape: rectangle, surface: Surface::Rough }],
    }
}

fn unit(config: &Config, turn: f64, away: f64, seed: u64) -> Result<Vec<f64>> {
    let world = World::from_scenario(&wall(turn), config.sonar.surface)?;
    let (ring, model) = config.build()?;
    let grid = world.grid(config.resolution)?;
    let mut map = CoverageMap::new(grid, config.model.bins)?;
    let mut occupancy = OccupancyGrid::new(grid, OccupancyParameters::default());
    let mut robot = SimulatedRobot::new(&world, config, seed)?;
    let mut ends = Raster::filled(grid, 0);
    for index in 0..SCANS {
        let along = LENGTH * (index as f64 / (SCANS - 1) as f64 - 0.5);
        // The robot's way lies below the wall, in the wall's frame.
        let turned = Isometry2::new(nalgebra::Vector2::new(4.0, 4.0), turn);
        let at = turned * Point2::new(along, -0.2 - away);
        let pose = Isometry2::new(at.coords, 0.0);
        let scan = Scan { pose, time: 0.0, ranges: robot.fire(&pose) };
        integrate(&model, &mut map, &scan);
        occupancy.integrate(&model, &scan);
        count_ends(&mut ends, &ring, &scan);
    }
    let truth = world.coverage(&grid);
    let occupied = occupancy.probabilities();
    let (mut sums, mut count) = (vec![0.0; 3], 0.0);
    for (cell, coverage) in truth.iter() {
        let detected = ends.get(cell).is_some_and(|ends| *ends >= LEAST_ENDS);
        let Some(p) = occupied.get(cell).copied().flatten() else { continue };
        if detected && Class::of(*coverage) == Class::Partial {
            sums[Oblique::OCCUPANCY] += p;
            sums[Oblique::OCCUPANCY_ERROR] += (p - coverage).abs();
            sums[Oblique::COVERAGE_ERROR] += (map.mean(cell) - coverage).abs();
            count += 1.0;
        }
    }
    Ok(sums.into_iter().map(|sum| sum / f64::max(count, 1.0)).collect())
}

/// Counts in which cell each reading ends, on the axis of its beam.
fn count_ends(ends: &mut Raster<usize>, ring: &SonarRing, scan: &Scan) {
    for (beam, range) in ring.beams().iter().zip(&scan.ranges) {
        if let Range::Echo(range) = range {
            let end = scan.pose * beam.pose * Point2::new(*range, 0.0);
            if let Some(count) = ends.grid().cell_at(end).and_then(|cell| ends.get_mut(cell)) {
                *count += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_measured_of_one_wall_is_one_group() {
        let config = Config { resolution: 0.2, ..Config::b21r() };
        let Oblique(Units(groups)) = Oblique::measure(&config, 1).unwrap();
        assert_eq!(groups.len(), TURNS.len());
        assert!(groups.iter().all(|group| group.len() == AWAY.len()));
    }
}
