//! What a run left unseen of what its robot could truly reach.

use crate::Truth;
use covmap::Cell;
use covmap_explore::{Mission, Run};
use covmap_plan::Reach;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

/// The truly reachable cells that the robot never knew to be free, nor found a way to; and what
/// bars the way there.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CutOff {
    /// How many cells that are.
    pub cells: usize,
    /// Cells on the border of what the robot could reach, beyond which it could truly drive, at
    /// which it bumped.
    pub bumps: usize,
    /// Such cells that it took for covered, or too near to what it took for covered, where truly
    /// nothing is.
    pub phantoms: usize,
    /// Such cells that seemed too narrow, and that it did not try.
    pub passages: usize,
    /// Such cells of which it knew nothing.
    pub unknown: usize,
}

impl CutOff {
    /// Of a run.
    pub fn new(truth: &Truth, mission: &Mission, run: &Run) -> Self {
        let (grid, steps) = (mission.grid, &truth.steps);
        let is_cut_off = |i: usize| truth.reachable[i] && run.reach[i] != Reach::Reached;
        let is_unseen = |i: &usize| !Truth::is_known_free(&run.map, grid.cell(*i));
        let mut cut_off = Self::default();
        for region in steps.regions(is_cut_off) {
            let unseen = region.iter().filter(|i| is_unseen(i)).count();
            if unseen == 0 {
                continue;
            }
            cut_off.cells += unseen;
            for index in region {
                if steps.neighbours(index).any(|near| run.reach[near] == Reach::Reached) {
                    cut_off.count(truth, mission, run, grid.cell(index));
                }
            }
        }
        cut_off
    }

    /// Counts a cell on the border of what was reached.
    fn count(&mut self, truth: &Truth, mission: &Mission, run: &Run, cell: Cell) {
        match run.reach.get(cell) {
            Some(Reach::Bumped) => self.bumps += 1,
            Some(Reach::Covered) if has_phantom(truth, mission, run, cell) => self.phantoms += 1,
            Some(Reach::Covered | Reach::CutOff) => self.passages += 1,
            _ => self.unknown += 1,
        }
    }
}

/// Whether a cell under the body at another is known to be covered, and truly is not.
fn has_phantom(truth: &Truth, mission: &Mission, run: &Run, at: Cell) -> bool {
    let (grid, planner) = (mission.grid, &mission.config.planner);
    let center: Point2<f64> = grid.center(at);
    let most = planner.traversable_coverage + 1e-9;
    covmap_model::cells_under_body(&grid, center, center, mission.config.robot.radius)
        .into_iter()
        .filter(|cell| run.map.is_known(*cell) && run.map.mode(*cell) > most)
        .any(|cell| truth.coverage.get(cell).is_some_and(|coverage| *coverage <= most))
}
