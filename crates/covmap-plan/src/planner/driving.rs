//! Targets of a robot that measures while it drives.

use crate::{InPlace, Planner};
use covmap::Cell;

impl Planner {
    /// Takes note that the robot measures while it drives, at this distance \[m\].
    pub fn measure_while_driving(&mut self, every: f64) {
        self.apart = (self.parameters.in_place == InPlace::AtViewPoints).then_some(every);
    }

    /// While driving, leaves out what is nearer to the last scan than scans are to each other; of view-points
    /// that are all that near, the robot's own, if there is another.
    pub(super) fn leave_the_last_scan(&self, indices: &mut Vec<usize>, from: Cell) {
        let (Some(apart), Some(last)) = (self.apart, self.last_scan) else { return };
        let is_apart = |i: usize| (self.grid.center(self.grid.cell(i)) - last).norm() >= apart;
        let own = self.grid.index(from);
        if indices.iter().any(|i| is_apart(*i)) {
            indices.retain(|i| is_apart(*i));
        } else if indices.len() > 1 {
            indices.retain(|i| Some(*i) != own);
        }
    }
}
