//! The places where scans were taken.

use covmap::{Cell, Grid};
use covmap_model::cells_under_body;
use nalgebra::Point2;

/// Margin by which a view-point exactly at the spacing is not spent, in spite of rounding \[m\].
const ROUNDING: f64 = 1e-9;

/// The spent view-points: those too near to a scan to tell anything new.
///
/// Choice: readings from one place share their errors (the same wall that does not answer, the same
/// width of the cone); repeating them adds confidence but no knowledge. If the model accounts for that
/// ([`Repeats`](covmap_model::Repeats)), so does the gain. A spacing of 0 spends nothing, as in the paper.
#[derive(Debug, Clone)]
pub(crate) struct Measured {
    grid: Grid,
    spacing: f64,
    spent: Vec<bool>,
}

impl Measured {
    pub(crate) fn new(grid: Grid, spacing: f64) -> Self {
        Self { grid, spacing, spent: vec![false; grid.len()] }
    }

    /// Takes note of a scan.
    pub(crate) fn note(&mut self, at: Point2<f64>) {
        for cell in cells_under_body(&self.grid, at, at, self.spacing - ROUNDING) {
            if let Some(index) = self.grid.index(cell) {
                self.spent[index] = true;
            }
        }
    }

    /// Whether a scan from one view-point spends another.
    pub(crate) fn is_near(&self, index: usize, view_point: Cell) -> bool {
        let center = |cell| self.grid.center(cell);
        let distance = (center(self.grid.cell(index)) - center(view_point)).norm();
        distance <= self.spacing - ROUNDING
    }

    pub(crate) fn is_spent(&self, index: usize) -> bool {
        self.spent[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spent_after_one_scan(spacing: f64) -> String {
        let grid = Grid::new(Point2::origin(), 0.1, 7, 5).unwrap();
        let mut measured = Measured::new(grid, spacing);
        measured.note(grid.center(Cell::new(2, 2)));
        let row = |y: i32| {
            let mark = |x| grid.index(Cell::new(x, y)).is_some_and(|i| measured.is_spent(i));
            (0..7).map(|x| if mark(x) { '#' } else { '.' }).collect::<String>() + "\n"
        };
        (0..5).map(row).collect()
    }

    #[test]
    fn view_points_nearer_than_the_spacing_are_spent() {
        let disc = ".......\n.###...\n.###...\n.###...\n.......\n";
        assert_eq!(spent_after_one_scan(0.2), disc);
    }

    #[test]
    fn without_a_spacing_nothing_is_spent() {
        assert!(!spent_after_one_scan(0.0).contains('#'));
    }
}
