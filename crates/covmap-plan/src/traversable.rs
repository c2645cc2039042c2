//! Where the robot can stand.

use covmap::{Cell, Grid};

/// Which view-points the robot can stand on.
///
/// Choice: a view-point is traversable if its cell is known with a most likely coverage of
/// at most `traversable_coverage`, and no known cell of more has its centre nearer than the
/// robot's radius. (Up to the nearest edge of such cells instead, doors of .8 m are closed at
/// r = .1 m by one wrong cell at either post; the price is more bumps.) Where the robot stood it
/// can stand again; where it bumped it cannot. An unknown cell whose centre was under the
/// robot's body counts as free: on coarse grids it is too near for the sensors and too large
/// to be under the body entirely.
#[derive(Debug, Clone)]
pub(crate) struct Traversable {
    grid: Grid,
    /// Cells that block a view-point, relative to it.
    disc: Vec<(i32, i32)>,
    /// How many blocking cells are too near to each view-point.
    blockers: Vec<u32>,
    blocking: Vec<bool>,
    free: Vec<bool>,
    /// The body was over the centre of the cell.
    under_body: Vec<bool>,
    stood: Vec<bool>,
    bumped: Vec<bool>,
}

impl Traversable {
    pub(crate) fn new(grid: Grid, radius: f64) -> Self {
        let r = grid.resolution();
        #[allow(clippy::cast_possible_truncation, reason = "a robot is some cells wide")]
        let reach = (radius / r).ceil().min(200.0) as i32;
        let near =
            |&(dx, dy): &(i32, i32)| libm::hypot(f64::from(dx), f64::from(dy)) * r < radius - 1e-9;
        let square = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
        let none = vec![false; grid.len()];
        Self {
            grid,
            disc: square.filter(near).collect(),
            blockers: vec![0; grid.len()],
            blocking: none.clone(),
            free: none.clone(),
            under_body: none.clone(),
            stood: none.clone(),
            bumped: none,
        }
    }

    /// Whether the robot can stand on the view-point with a row-major index.
    pub(crate) fn at(&self, index: usize) -> bool {
        let open = self.free[index] || self.under_body[index];
        !self.bumped[index] && (self.stood[index] || open && self.blockers[index] == 0)
    }

    /// How many cells' centres are under the body.
    pub(crate) fn body_cells(&self) -> usize {
        self.disc.len()
    }

    /// Whether a view-point that looks blocked may turn out to be open: nobody bumped there.
    pub(crate) fn may_open(&self, index: usize) -> bool {
        !self.bumped[index]
    }

    /// Takes over what is known of a cell: `Some(true)` if the robot may drive over it,
    /// `Some(false)` if it blocks. Calls `changed` for every view-point that this opens or
    /// closes.
    pub(crate) fn update(
        &mut self,
        index: usize,
        free: Option<bool>,
        mut changed: impl FnMut(usize),
    ) {
        let blocking = free == Some(false);
        let was = self.at(index);
        self.free[index] = free == Some(true);
        if was != self.at(index) {
            changed(index);
        }
        if blocking == self.blocking[index] {
            return;
        }
        self.blocking[index] = blocking;
        let cell = self.grid.cell(index);
        for k in 0..self.disc.len() {
            let (dx, dy) = self.disc[k];
            let Some(near) = self.grid.index(cell.offset(-dx, -dy)) else { continue };
            let was = self.at(near);
            if blocking {
                self.blockers[near] += 1;
            } else {
                self.blockers[near] -= 1;
            }
            if was != self.at(near) {
                changed(near);
            }
        }
    }

    /// The robot stands on a cell's view-point.
    pub(crate) fn stand_on(&mut self, cell: Cell) {
        if let Some(index) = self.grid.index(cell) {
            self.stood[index] = true;
        }
    }

    /// The robot's body was over the centre of a cell.
    pub(crate) fn cover(&mut self, cell: Cell) {
        if let Some(index) = self.grid.index(cell) {
            self.under_body[index] = true;
        }
    }

    /// The robot bumped into something when it entered a cell.
    pub(crate) fn bump_at(&mut self, cell: Cell) {
        if let Some(index) = self.grid.index(cell) {
            self.bumped[index] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn a_view_point_needs_the_robots_radius_around_it() {
        let grid = Grid::new(Point2::origin(), 0.1, 12, 1).unwrap();
        let mut traversable = Traversable::new(grid, 0.27);
        (0..12).for_each(|i| traversable.update(i, Some(true), |_| ()));
        let picture =
            |t: &Traversable| (0..12).map(|i| if t.at(i) { '.' } else { '#' }).collect::<String>();
        assert_eq!(picture(&traversable), "............");
        let mut closed = Vec::new();
        traversable.update(5, Some(false), |i| closed.push(i));
        assert_eq!(picture(&traversable), "...#####....");
        assert_eq!(closed.len(), 5);
        traversable.stand_on(Cell::new(3, 0));
        traversable.bump_at(Cell::new(0, 0));
        assert_eq!(picture(&traversable), "#...####....");
        traversable.update(5, Some(true), |_| ());
        assert_eq!(picture(&traversable), "#...........");
    }

    #[test]
    fn unknown_cells_are_not_traversable_but_do_not_block() {
        let grid = Grid::new(Point2::origin(), 0.1, 3, 1).unwrap();
        let mut traversable = Traversable::new(grid, 0.27);
        traversable.update(1, Some(true), |_| ());
        assert_eq!([0, 1, 2].map(|i| traversable.at(i)), [false, true, false]);
        traversable.cover(Cell::new(2, 0));
        assert_eq!([0, 1, 2].map(|i| traversable.at(i)), [false, true, true]);
    }
}
