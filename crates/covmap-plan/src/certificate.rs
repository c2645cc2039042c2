//! The planner's reports on the cells: the certificate, the reach, and counts for progress.

use crate::exploration::InSight;
use crate::{CellStatus, Planner, Reach, Scope, travel_costs};
use covmap::{Cell, CoverageMap, Raster, neighbour};
use covmap_gain::ViewPoints;
use serde::{Deserialize, Serialize};

/// Least coverage with which a known cell hides the cells behind it from future scans.
const OPAQUE: f64 = 0.5;

/// The largest expected change of a cell by one more scan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Promise {
    /// The largest expected fall of the cell's entropy by one beam from a reachable view-point:
    /// Σ_d p(d | c) · I(h | d) \[nats\].
    pub change: f64,
    /// The view-point that promises this change.
    pub from: Cell,
}

impl Planner {
    /// Returns the largest expected change of each cell by one more scan.
    ///
    /// The scan may be taken from any view-point that a robot in the cell `from` can reach. `None` for cells
    /// that cannot be measured, and for all cells with the product of Eq. (9). An exhausted cell is given up
    /// because its expected change is small.
    ///
    /// # Panics
    /// If the robot's cell lies outside of the grid.
    pub fn promises_of(&mut self, from: Cell) -> Raster<Option<Promise>> {
        let costs = travel_costs(self.traversable.steps(), from);
        let reached = ViewPoints::of(&self.grid, costs.reached());
        let largest = self.gains.largest_changes(&reached);
        Raster::from_fn(self.grid, |cell| {
            let (change, from) = largest[self.grid.index(cell)?]?;
            Some(Promise { change, from: self.grid.cell(from) })
        })
    }

    /// Returns the status of each cell, for a robot in the cell `from`. The environment is explored
    /// if no cell is [`CellStatus::Open`].
    ///
    /// # Panics
    /// If the robot's cell lies outside of the grid.
    pub fn certificate(&mut self, map: &CoverageMap, from: Cell) -> Raster<CellStatus> {
        let mut in_sight = vec![InSight::Nowhere; self.grid.len()];
        let mut candidates = self.candidates(from);
        self.leave_out_vain(map, &mut candidates.indices, self.least_change);
        if candidates.indices.is_empty()
            && let Some((mut towards, least)) = self.candidates_towards_ground(map, from)
        {
            self.leave_out_vain(map, &mut towards.indices, Some(least));
            candidates.indices = towards.indices;
        }
        for view_point in candidates.costs.reached() {
            let is_candidate = candidates.indices.binary_search(&view_point).is_ok();
            let sight = if is_candidate { InSight::Candidate } else { InSight::Spent };
            for (index, distance) in self.gains.cells_in_sight(view_point) {
                if self.is_open_reason(map, index, distance) {
                    in_sight[index] = in_sight[index].max(sight);
                }
            }
        }
        let mut certificate = Raster::from_fn(self.grid, |cell| {
            let index = self.grid.index(cell).unwrap_or(0);
            let (known, entropy) = (map.is_known(cell), map.entropy(cell));
            self.exploration.status(index, known, entropy, in_sight[index])
        });
        let is_over = !certificate.values().contains(&CellStatus::Open)
            && self.candidates_beyond_a_passage(map, from).is_none();
        if !is_over {
            let reached: Vec<usize> = candidates.costs.reached().collect();
            self.mark_not_seen(map, reached, &mut certificate);
        }
        certificate
    }

    /// Whether a cell is a reason to measure from this distance \[m\]; for IG_WIN also in closed windows.
    fn is_open_reason(&self, map: &CoverageMap, index: usize, distance: f32) -> bool {
        if self.window.is_none() {
            return self.is_reason(index, distance);
        }
        let cell = self.grid.cell(index);
        distance <= self.exploration.limit(index, map.is_known(cell), map.entropy(cell))
    }

    /// Marks the unreachable cells that may still come into sight, in a run that is not over.
    ///
    /// These are the cells connected to a reachable cell over cells that are not known to be covered,
    /// and the cells at which such a connection ends.
    fn mark_not_seen(
        &self,
        map: &CoverageMap,
        mut front: Vec<usize>,
        certificate: &mut Raster<CellStatus>,
    ) {
        let mut seen = vec![false; self.grid.len()];
        front.iter().for_each(|index| seen[*index] = true);
        while let Some(at) = front.pop() {
            let cell = self.grid.cell(at);
            // In the paper's words, a known cell where the robot cannot stand is out of scope for good.
            let in_scope =
                self.parameters().scope_of_strategy() == Scope::Observable || !map.is_known(cell);
            if certificate[at] == CellStatus::Unreachable && in_scope {
                certificate[at] = CellStatus::NotSeen;
            }
            if map.is_known(cell) && map.mode(cell) >= OPAQUE || self.exploration.is_outside(at) {
                continue;
            }
            let sides = [0, 2, 4, 6].into_iter().filter_map(|step| neighbour(&self.grid, at, step));
            for next in sides {
                if !std::mem::replace(&mut seen[next], true) {
                    front.push(next);
                }
            }
        }
    }

    /// Returns for each cell whether a robot in the cell `from` can drive there, and if not, the obstacle.
    pub fn reach(&self, from: Cell) -> Raster<Reach> {
        let reached = self.traversable.steps().reached(self.grid.index(from));
        Raster::from_fn(self.grid, |cell| match self.grid.index(cell) {
            Some(index) if !reached[index] => self.traversable.obstacle(index),
            _ => Reach::Reached,
        })
    }

    /// Returns the number of known cells that are neither resolved nor given up, whether or not they
    /// are in sight of a reachable view-point. Cheap, for progress.
    pub fn open_cells(&self, map: &CoverageMap) -> usize {
        let is_open = |index: &usize| {
            let cell = self.grid.cell(*index);
            let (known, entropy) = (map.is_known(cell), map.entropy(cell));
            let status = self.exploration.status(*index, known, entropy, InSight::Candidate);
            known && status == CellStatus::Open
        };
        (0..self.grid.len()).filter(is_open).count()
    }

    /// Returns the number of cells given up by the cap on counted scans.
    pub fn capped_cells(&self) -> usize {
        self.exploration.capped_cells()
    }

    /// Returns the number of scans counted for each cell.
    pub fn counted_scans(&self) -> Raster<u32> {
        self.exploration.counted_scans(self.grid)
    }

    /// Whether a robot in the cell `from` is shut in: one of the cells that it can reach is nearer to all
    /// others than the robot is wide.
    pub fn is_confined(&self, from: Cell) -> bool {
        let reached = self.traversable.steps().reached(self.grid.index(from));
        let reached: Vec<usize> = (0..self.grid.len()).filter(|i| reached[*i]).collect();
        let center = |index: &usize| self.grid.center(self.grid.cell(*index));
        let is_near_all = |at: &usize| {
            reached.iter().all(|i| (center(i) - center(at)).norm() < 2.0 * self.radius)
        };
        reached.iter().any(is_near_all)
    }
}
