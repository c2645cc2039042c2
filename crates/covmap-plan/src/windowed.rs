//! Candidates of IG_WIN: the planner opens, explores and closes a window.

use crate::Planner;
use crate::planner::Candidates;
use crate::window::Window;
use covmap::{Cell, CoverageMap};

impl Planner {
    /// The candidates; for IG_WIN those inside the window, which this opens and closes.
    pub(crate) fn windowed_candidates(
        &mut self,
        map: &CoverageMap,
        from: Cell,
    ) -> Option<Candidates> {
        if self.window.as_ref().is_some_and(|w| w.center().is_none()) {
            self.open_window(from);
        }
        loop {
            let mut candidates = self.candidates(from);
            if self.window.is_some() {
                self.leave_out_vain(map, &mut candidates.indices, self.least_change);
            }
            let Some(window) = &mut self.window else {
                return (!candidates.indices.is_empty()).then_some(candidates);
            };
            if candidates.indices.is_empty() {
                let reopened = window.reopen_all();
                if reopened.is_empty() {
                    return None;
                }
                reopened.into_iter().for_each(|index| self.update_limit(map, index));
                continue;
            }
            let inside: Vec<usize> =
                candidates.indices.iter().copied().filter(|i| self.window_offers(*i)).collect();
            if !inside.is_empty() {
                candidates.indices = inside;
                return Some(candidates);
            }
            self.close_window(map);
            let mut left = self.candidates(from);
            self.leave_out_vain(map, &mut left.indices, self.least_change);
            let nearest = left.costs.nearest(&left.indices);
            if let Some(nearest) = nearest {
                self.open_window(self.grid.cell(nearest));
                if !left.indices.iter().any(|i| self.window_offers(*i)) {
                    // All cells in sight of the nearest candidate lie outside of its window.
                    left.indices = vec![nearest];
                    return Some(left);
                }
            }
        }
    }

    fn open_window(&mut self, center: Cell) {
        if let Some(window) = &mut self.window {
            window.open(center);
        }
    }

    fn close_window(&mut self, map: &CoverageMap) {
        let closed = self.window.as_mut().map_or_else(Vec::new, Window::close);
        closed.into_iter().for_each(|index| self.update_limit(map, index));
    }

    /// Whether a candidate lies in the window and has an open cell of the window in sight.
    fn window_offers(&self, candidate: usize) -> bool {
        let Some(window) = &self.window else { return true };
        let is_open = |&(index, distance): &(usize, f32)| {
            self.is_reason(index, distance) && window.holds(index)
        };
        window.holds(candidate) && self.gains.sees(candidate, is_open)
    }
}
