//! Scores of a map against the truth.

use covmap::{Cell, CoverageMap, Raster, Steps, is_scored};
use covmap_explore::{Mission, Run};
use covmap_statistics::{LIKELIHOOD_FLOOR, log_likelihood};
use covmap_world::World;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

/// Least coverage of a solid cell.
const SOLID: f64 = 0.5;
/// Largest coverage of a free cell.
const FREE: f64 = 0.2;

/// The truth about a world, and the cells that the robot could have known.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The exact coverage of every cell.
    pub coverage: Raster<f64>,
    /// The cells whose centres the robot can truly reach.
    pub reachable: Raster<bool>,
    /// The first solid cells in sight of the reachable cells within the usable range.
    pub first_solid: Raster<bool>,
    /// The first solid cells with a smooth surface in sight, which mirrors sound.
    pub first_smooth: Raster<bool>,
    /// The steps that the robot can truly take.
    pub steps: Steps,
    /// The cells in sight of the reachable cells within the usable range, and the first solid cells: the
    /// same for every strategy.
    pub observable: Raster<bool>,
}

/// Score of a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// The share of the truly reachable cells that are known to be free.
    pub completeness: f64,
    /// The share of the first solid cells that are known with a mode of at least ½.
    pub wall_recall: f64,
    /// The same share of the first solid cells with only rough surfaces in sight; `None` if there are none.
    pub wall_recall_rough: Option<f64>,
    /// The same share of the first solid cells with a smooth surface in sight; `None` if there are none.
    pub wall_recall_smooth: Option<f64>,
    /// The share of the truly reachable cells with a mode of at least ½.
    pub phantom: f64,
    /// Mean absolute error of the most likely coverage over the scored cells.
    pub mae_mode: f64,
    /// Mean absolute error of the expected coverage over the scored cells.
    pub mae_mean: f64,
    /// Mean log-likelihood of the true coverage over the scored cells \[nats\].
    pub mean_log_likelihood: f64,
    /// The share of the scored cells with an entropy above .65 (Table 1).
    pub share_entropy_above_0_65: f64,
}

impl Truth {
    /// Computes the truth about a world for a mission.
    pub fn new(world: &World, mission: &Mission) -> Self {
        let Mission { config, grid, start, .. } = mission;
        let coverage = world.coverage(grid);
        let at = Point2::from(start.translation.vector);
        let steps = world.steps(grid, config.robot.radius);
        let reachable = world.reachable_by(&steps, at, config.robot.radius);
        let seen = world.cells_seen(grid, &coverage, &reachable, config.model.usable_range);
        let observable = Raster::from_fn(*grid, |cell| {
            [&seen.in_sight, &seen.first_solid].iter().any(|r| r.get(cell) == Some(&true))
        });
        let (first_solid, first_smooth) = (seen.first_solid, seen.first_smooth);
        Self { coverage, reachable, first_solid, first_smooth, steps, observable }
    }

    /// Returns the scored cells of a run: those within the usable range and in sight of the pose of a scan,
    /// plus one solid layer, without those that the robot's body pinned.
    pub fn scored_cells(&self, world: &World, mission: &Mission, run: &Run) -> Vec<Cell> {
        let grid = mission.grid;
        let places = run.scans.iter().map(|scan| scan.pose.translation.vector.into());
        let range = mission.config.model.usable_range;
        let seen = world.cells_seen_from(&grid, &self.coverage, places, range);
        let counts = |i: usize| seen.in_sight[i] || seen.first_solid[i];
        let cells = (0..grid.len()).filter(|i| counts(*i)).map(|i| grid.cell(i));
        cells.filter(|cell| !run.map.is_pinned(*cell)).collect()
    }

    /// Returns the measured cells: those that the map knows and the body did not pin, without the solid
    /// cells deeper than the first layer ([`is_scored`]).
    pub fn measured_cells(&self, map: &CoverageMap) -> Vec<Cell> {
        let counts = |cell: &Cell| {
            map.is_known(*cell) && !map.is_pinned(*cell) && is_scored(&self.coverage, *cell)
        };
        map.grid().cells().filter(counts).collect()
    }

    /// Whether a map knows a cell to be free, with a mode of at most .2.
    pub fn is_known_free(map: &CoverageMap, cell: Cell) -> bool {
        map.is_known(cell) && map.mode(cell) <= FREE + 1e-9
    }

    /// Scores a map; `scored` are the scored cells.
    pub fn score(&self, map: &CoverageMap, scored: &[Cell]) -> Score {
        let those = |among: &Raster<bool>| -> Vec<Cell> {
            among.iter().filter(|(_, a)| **a).map(|(cell, _)| cell).collect()
        };
        let share = |all: &[Cell], good: &dyn Fn(Cell) -> bool| {
            mean(all.iter().map(|cell| f64::from(good(*cell))))
        };
        let is_wall = |cell| map.is_known(cell) && map.mode(cell) >= SOLID;
        let (reachable, walls) = (those(&self.reachable), those(&self.first_solid));
        let (smooth, rough): (Vec<Cell>, Vec<Cell>) =
            walls.iter().partition(|cell| self.first_smooth.get(**cell) == Some(&true));
        let recall = |walls: &[Cell]| (!walls.is_empty()).then(|| share(walls, &is_wall));
        let over = |f: &dyn Fn(Cell, f64) -> f64| {
            let value = |cell: &Cell| f(*cell, self.coverage.get(*cell).copied().unwrap_or(1.0));
            mean(scored.iter().map(value))
        };
        // An unknown cell scores as uniform.
        let mode = |cell| if map.is_known(cell) { map.mode(cell) } else { 0.5 };
        Score {
            completeness: share(&reachable, &|c| Self::is_known_free(map, c)),
            wall_recall: share(&walls, &is_wall),
            wall_recall_rough: recall(&rough),
            wall_recall_smooth: recall(&smooth),
            phantom: share(&reachable, &is_wall),
            mae_mode: over(&|cell, truth| (mode(cell) - truth).abs()),
            mae_mean: over(&|cell, truth| (map.mean(cell) - truth).abs()),
            mean_log_likelihood: over(&|cell, truth| {
                log_likelihood(map.histogram(cell).probabilities(), truth, LIKELIHOOD_FLOOR)
            }),
            share_entropy_above_0_65: over(&|cell, _| f64::from(map.entropy(cell) > 0.65)),
        }
    }
}

/// The mean of some numbers; 0 for none.
pub(crate) fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    // A sum of nothing would be −0.
    values.fold(0.0, |sum, value| sum + value) / count
}
