//! The accuracy of a map, by the class of the cells, and its certainty.

use crate::Truth;
use crate::score::mean;
use covmap::{Cell, Class, CoverageMap};
use covmap_explore::Mission;
use covmap_statistics::crps;

/// Entropy above which a cell is not explored well enough in Table 1 \[nats\].
const TABLE_1: f64 = 0.65;

/// Errors of a map against the truth, and the shares of its cells that are certain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Errors over the scored cells, which this run could see.
    pub scored: Errors,
    /// Errors over the compared cells, which are the same for every run in a world.
    pub compared: Errors,
    /// Mean absolute error of the most likely coverage over the compared cells; an unknown cell counts as ½.
    pub mae_observable: f64,
    /// Mean log-likelihood of the true coverage over the compared cells \[nats\].
    pub log_likelihood_observable: f64,
    /// The share of the observable cells that are known with an entropy of at most ε.
    pub share_explored: f64,
    /// The share of the observable cells with an entropy above .65: Table 1, over the same
    /// cells for every technique.
    pub share_uncertain: f64,
    /// The number of observable cells.
    pub observable_cells: f64,
    /// The number of compared cells.
    pub compared_cells: f64,
}

/// Errors of the whole posterior over some cells. The posterior of an unknown cell is uniform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Mean continuous ranked probability score.
    pub crps: f64,
    /// Mean absolute error of the expected coverage over the cells of coverage 0.
    pub mae_free: f64,
    /// The same over the cells of a coverage between 0 and 1.
    pub mae_partial: f64,
    /// The same over the cells of coverage 1.
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
    /// Evaluates the accuracy of a map over the scored cells of its run, and over the compared cells.
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

    /// Returns all numbers with their names.
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
    /// Returns the share of the observable cells that are known with an entropy of at most ε.
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
