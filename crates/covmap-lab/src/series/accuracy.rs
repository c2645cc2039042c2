//! How accurate a map is, by the class of the cells, and how certain.

use crate::Truth;
use crate::score::mean;
use covmap::{Cell, Class, CoverageMap};
use covmap_explore::Mission;
use covmap_statistics::crps;

/// Above this entropy a cell is not explored well enough in Table 1 \[nats\].
const TABLE_1: f64 = 0.65;

/// How far a map is from the truth, and how much of it is certain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Over the scored cells: what this run could see.
    pub scored: Errors,
    /// Over the compared cells: the same for every run in a world.
    pub compared: Errors,
    /// Mean absolute error of the most likely coverage over the compared cells; what is not known
    /// counts as ½.
    pub mae_observable: f64,
    /// Mean log-likelihood of the true coverage over the compared cells \[nats\].
    pub log_likelihood_observable: f64,
    /// The share of the observable cells that are known with an entropy of at most ε.
    pub share_explored: f64,
    /// The share of the observable cells with an entropy above .65: Table 1, over the same
    /// cells for every technique.
    pub share_uncertain: f64,
    /// How many cells are observable.
    pub observable_cells: f64,
    /// How many cells are compared.
    pub compared_cells: f64,
}

/// Errors of a whole posterior over some cells. What the map does not know is uniform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Mean continuous ranked probability score.
    pub crps: f64,
    /// Mean absolute error of the expected coverage over the cells of coverage 0.
    pub mae_free: f64,
    /// ... of a coverage between 0 and 1.
    pub mae_partial: f64,
    /// ... of coverage 1.
    pub mae_solid: f64,
}

impl Errors {
    fn new(truth: &Truth, map: &CoverageMap, cells: &[Cell]) -> Self {
        let coverage = |cell: Cell| truth.coverage.get(cell).copied().unwrap_or(1.0);
        let error = |class: Class| {
            let cells: Vec<&Cell> =
                cells.iter().filter(|cell| Class::of(coverage(**cell)) == class).collect();
            mean(cells.iter().map(|cell| (map.mean(**cell) - coverage(**cell)).abs()))
        };
        let score = |cell: &Cell| crps(map.histogram(*cell).probabilities(), coverage(*cell));
        Self {
            crps: mean(cells.iter().map(score)),
            mae_free: error(Class::Free),
            mae_partial: error(Class::Partial),
            mae_solid: error(Class::Solid),
        }
    }
}

impl Accuracy {
    /// The accuracy of a map: over the cells that count for its run, and over those that are the
    /// same for all.
    pub fn new(truth: &Truth, mission: &Mission, map: &CoverageMap, scored: &[Cell]) -> Self {
        let compared = truth.compared_cells(mission.config.robot.radius);
        let score = truth.score(map, &compared);
        let compared_cells = compared.len() as f64;
        Self {
            scored: Errors::new(truth, map, scored),
            compared: Errors::new(truth, map, &compared),
            mae_observable: score.mae_mode,
            log_likelihood_observable: score.mean_log_likelihood,
            share_explored: truth.share_explored(map, mission),
            share_uncertain: truth.share_observable(|cell| map.entropy(cell) > TABLE_1),
            observable_cells: truth.observable.iter().map(|(_, o)| f64::from(*o)).sum(),
            compared_cells,
        }
    }

    /// All numbers by their names.
    pub fn named(&self) -> [(&'static str, f64); 14] {
        [
            ("crps", self.scored.crps),
            ("mae_free", self.scored.mae_free),
            ("mae_partial", self.scored.mae_partial),
            ("mae_solid", self.scored.mae_solid),
            ("mae_observable", self.mae_observable),
            ("log_likelihood_observable", self.log_likelihood_observable),
            ("crps_observable", self.compared.crps),
            ("mae_free_observable", self.compared.mae_free),
            ("mae_partial_observable", self.compared.mae_partial),
            ("mae_solid_observable", self.compared.mae_solid),
            ("share_explored", self.share_explored),
            ("share_uncertain", self.share_uncertain),
            ("observable_cells", self.observable_cells),
            ("compared_cells", self.compared_cells),
        ]
    }
}

impl Truth {
    /// The share of the observable cells that are known with an entropy of at most ε.
    pub fn share_explored(&self, map: &CoverageMap, mission: &Mission) -> f64 {
        let threshold = mission.config.planner.entropy_threshold;
        self.share_observable(|cell| map.is_known(cell) && map.entropy(cell) <= threshold)
    }

    fn share_observable(&self, good: impl Fn(Cell) -> bool) -> f64 {
        let all: Vec<Cell> =
            self.observable.iter().filter(|(_, o)| **o).map(|(cell, _)| cell).collect();
        mean(all.iter().map(|cell| f64::from(good(*cell))))
    }
}
