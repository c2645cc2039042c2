//! The truly reachable cells that a run left unseen.

use crate::Truth;
use covmap::Cell;
use covmap_explore::{Mission, Run};
use covmap_plan::Reach;
use nalgebra::Point2;
use serde::{Deserialize, Serialize};

/// The truly reachable cells that the robot neither knew to be free nor found a way to, and the
/// obstacles on the way there.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CutOff {
    /// The number of these cells.
    pub cells: usize,
    /// The number of border cells where the robot bumped. A border cell is next to the cells that the robot
    /// could reach, and truly leads to the cells that are cut off.
    pub bumps: usize,
    /// The number of border cells with a phantom under the body: a cell that the robot took for covered, and
    /// that is truly free.
    pub phantoms: usize,
    /// The number of border cells that seemed too narrow, and that the robot did not try.
    pub passages: usize,
    /// The number of border cells that the robot did not know.
    pub unknown: usize,
}

impl CutOff {
    /// Counts the cells that are cut off at the end of a run.
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

    /// Counts a cell on the border of the reached cells.
    fn count(&mut self, truth: &Truth, mission: &Mission, run: &Run, cell: Cell) {
        match run.reach.get(cell) {
            Some(Reach::Bumped) => self.bumps += 1,
            Some(Reach::Covered) if has_phantom(truth, mission, run, cell) => self.phantoms += 1,
            Some(Reach::Covered | Reach::CutOff) => self.passages += 1,
            _ => self.unknown += 1,
        }
    }
}

/// Whether the map takes a truly free cell under the body at `at` for covered.
fn has_phantom(truth: &Truth, mission: &Mission, run: &Run, at: Cell) -> bool {
    let (grid, planner) = (mission.grid, &mission.config.planner);
    let center: Point2<f64> = grid.center(at);
    let most = planner.traversable_coverage + 1e-9;
    covmap_model::cells_under_body(&grid, center, center, mission.config.robot.radius)
        .into_iter()
        .filter(|cell| run.map.is_known(*cell) && run.map.mode(*cell) > most)
        .any(|cell| truth.coverage.get(cell).is_some_and(|coverage| *coverage <= most))
}
