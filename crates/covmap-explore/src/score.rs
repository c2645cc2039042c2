//! A map against the truth.

use crate::{Mission, Run};
use covmap::{Cell, CoverageMap, LIKELIHOOD_FLOOR, Raster, log_likelihood};
use covmap_world::World;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

/// A cell of which at least this much is covered is solid.
const SOLID: f64 = 0.5;

/// What there truly is, and what of it the robot could have known.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The exact coverage of every cell.
    pub coverage: Raster<f64>,
    /// The cells whose centres the robot can truly reach.
    pub reachable: Raster<bool>,
    /// The first solid cells that can be seen from there within the usable range.
    pub first_solid: Raster<bool>,
    /// The cells that can be seen from there within the usable range, and the first solid
    /// ones: the same for every strategy.
    pub observable: Raster<bool>,
}

/// How good a map is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// The share of the truly reachable cells that are known to be free.
    pub completeness: f64,
    /// The share of the first solid cells that are known with a mode of at least ½.
    pub wall_recall: f64,
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
    /// The truth about a world for a mission.
    pub fn new(world: &World, mission: &Mission) -> Self {
        let Mission { config, grid, start, .. } = mission;
        let coverage = world.coverage(grid);
        let at = Point2::from(start.translation.vector);
        let reachable = world.reachable_cells(grid, at, config.robot.radius);
        let seen = world.cells_seen(grid, &coverage, &reachable, config.model.usable_range);
        let observable = Raster::from_fn(*grid, |cell| {
            [&seen.in_sight, &seen.first_solid].iter().any(|r| r.get(cell) == Some(&true))
        });
        Self { coverage, reachable, first_solid: seen.first_solid, observable }
    }

    /// The cells whose error counts: within the usable range and in sight of a pose of the
    /// trajectory, plus one solid layer; not those that the robot's body pinned.
    pub fn scored_cells(&self, world: &World, mission: &Mission, run: &Run) -> Vec<Cell> {
        let grid = mission.grid;
        let places = run.scans.iter().map(|scan| scan.pose.translation.vector.into());
        let range = mission.config.model.usable_range;
        let seen = world.cells_seen_from(&grid, &self.coverage, places, range);
        let counts = |i: usize| seen.in_sight[i] || seen.first_solid[i];
        let cells = (0..grid.len()).filter(|i| counts(*i)).map(|i| grid.cell(i));
        cells.filter(|cell| !run.map.is_pinned(*cell)).collect()
    }

    /// Scores a map over the cells that count.
    pub fn score(&self, map: &CoverageMap, scored: &[Cell]) -> Score {
        let share = |among: &Raster<bool>, good: &dyn Fn(Cell) -> bool| {
            let all: Vec<Cell> = among.iter().filter(|(_, a)| **a).map(|(cell, _)| cell).collect();
            mean(all.iter().map(|cell| f64::from(good(*cell))))
        };
        let over = |f: &dyn Fn(Cell, f64) -> f64| {
            let value = |cell: &Cell| f(*cell, self.coverage.get(*cell).copied().unwrap_or(1.0));
            mean(scored.iter().map(value))
        };
        // What is not known scores as uniform.
        let mode = |cell| if map.is_known(cell) { map.mode(cell) } else { 0.5 };
        Score {
            completeness: share(&self.reachable, &|c| map.is_known(c) && map.mode(c) <= 0.2 + 1e-9),
            wall_recall: share(&self.first_solid, &|c| map.is_known(c) && map.mode(c) >= SOLID),
            phantom: share(&self.reachable, &|c| map.is_known(c) && map.mode(c) >= SOLID),
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
    #[allow(clippy::cast_precision_loss, reason = "at most 2e7 cells")]
    let count = values.len().max(1) as f64;
    // A sum of nothing would be −0.
    values.fold(0.0, |sum, value| sum + value) / count
}
