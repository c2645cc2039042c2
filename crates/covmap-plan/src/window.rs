//! The local window of IG_WIN.

use covmap::{Cell, Grid};

/// "A local window until this has been explored … no need for the robot to return."
///
/// Reading: the window is a circle around the cell where it was opened. It is explored when no candidate
/// inside has an open cell of the window in sight. Then its cells are no reasons any more, and the next
/// window opens around the nearest candidate left. Deviation: when no candidate is left at all, the
/// cells of closed windows are reasons again, so a run ends with no cell open.
#[derive(Debug, Clone)]
pub(crate) struct Window {
    grid: Grid,
    radius: f64,
    center: Option<Cell>,
    closed: Vec<bool>,
}

impl Window {
    /// No window is open, and none was.
    pub(crate) fn new(grid: Grid, radius: f64) -> Self {
        Self { grid, radius, center: None, closed: vec![false; grid.len()] }
    }

    /// The centre of the open window.
    pub(crate) fn center(&self) -> Option<Cell> {
        self.center
    }

    /// Opens a window around a cell.
    pub(crate) fn open(&mut self, center: Cell) {
        self.center = Some(center);
    }

    /// Whether the cell with a row-major index lies in the open window.
    pub(crate) fn holds(&self, index: usize) -> bool {
        self.center.is_some_and(|center| {
            let offset = self.grid.center(self.grid.cell(index)) - self.grid.center(center);
            offset.norm() <= self.radius
        })
    }

    /// Whether the cell with a row-major index lies in a closed window.
    pub(crate) fn is_closed(&self, index: usize) -> bool {
        self.closed[index]
    }

    /// Closes the open window; returns the cells that are no reasons any more.
    pub(crate) fn close(&mut self) -> Vec<usize> {
        let newly: Vec<usize> =
            (0..self.grid.len()).filter(|i| self.holds(*i) && !self.closed[*i]).collect();
        newly.iter().for_each(|i| self.closed[*i] = true);
        self.center = None;
        newly
    }

    /// Forgets that windows were closed; returns the cells that may be reasons again.
    pub(crate) fn reopen_all(&mut self) -> Vec<usize> {
        let all = (0..self.grid.len()).filter(|i| self.closed[*i]).collect();
        self.closed.fill(false);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn a_window_is_a_circle_with_its_edge() {
        let grid = Grid::new(Point2::origin(), 0.5, 7, 7).unwrap();
        let mut window = Window::new(grid, 1.0);
        assert!((0..grid.len()).all(|i| !window.holds(i)), "none is open yet");
        window.open(Cell::new(3, 3));
        let mark = |x, y| grid.index(Cell::new(x, y)).is_some_and(|i| window.holds(i));
        let row = |y| (0..7).map(|x| if mark(x, y) { '#' } else { '.' }).collect::<String>();
        let drawn: Vec<String> = (0..7).map(row).collect();
        let disc = [".......", "...#...", "..###..", ".#####.", "..###..", "...#...", "......."];
        assert_eq!(drawn, disc);
        assert_eq!(window.close().len(), 13);
        assert_eq!((window.center(), window.close().len()), (None, 0));
    }
}
