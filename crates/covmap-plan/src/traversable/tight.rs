//! Paths pulled tight: straight lines instead of steps from cell to cell, wherever there is room.

use super::{Traversable, distance_from_step};
use covmap::{Cell, step_between};
use nalgebra::Point2;

impl Traversable {
    /// The corners of a path that begins in the cell `from`: without the cells that the robot can drive
    /// straight past.
    ///
    /// Choice: the robot may drive a straight line if it can stand on every cell that its centre
    /// passes, no step between these was tried in vain, and no known cell that blocks has its centre
    /// nearer to the line than the robot's radius plus a cell's side. So lines are for open space. Near
    /// walls, where the body may touch an obstacle that is not in the map, the robot drives from cell to
    /// cell, and after a bump it is one step away from a place where it can plan again.
    pub(crate) fn pulled_tight(&self, from: Cell, path: &[Cell]) -> Vec<Cell> {
        let (mut corners, mut corner, mut before) = (Vec::new(), from, None);
        for cell in path {
            if let Some(passed) = before
                && !self.is_free_between(corner, *cell)
            {
                corners.push(passed);
                corner = passed;
            }
            before = Some(*cell);
        }
        corners.extend(before);
        corners
    }

    fn is_free_between(&self, from: Cell, to: Cell) -> bool {
        let line = passed_between(from, to);
        let can_stand = |cell: &Cell| self.grid.index(*cell).is_some_and(|index| self.at(index));
        let may_step = |pair: &[Cell]| {
            let ends = self.grid.index(pair[0]).zip(step_between(pair[0], pair[1]));
            ends.is_some_and(|(index, step)| !self.is_barred(index, step))
        };
        line.iter().all(can_stand) && line.windows(2).all(may_step) && self.has_room(from, to)
    }

    /// Whether no known blocking cell is nearer to a line than the radius plus a cell.
    fn has_room(&self, from: Cell, to: Cell) -> bool {
        let (reach, way) = (self.reach + 1, (to.x - from.x, to.y - from.y));
        let span = |a: i32, b: i32| a.min(b) - reach..=a.max(b) + reach;
        let blocks = |x: i32, y: i32| {
            let index = self.grid.index(Cell::new(x, y)).filter(|index| self.blocking[*index]);
            index.is_some()
                && distance_from_step(way, (x - from.x, y - from.y)) < self.radius_in_cells + 1.0
        };
        !span(from.y, to.y).any(|y| span(from.x, to.x).any(|x| blocks(x, y)))
    }

    /// The step that the robot was taking when it got no farther than a place \[m\], on its way straight
    /// from the centre of one cell to that of another.
    pub(crate) fn step_at(&self, from: Cell, to: Cell, at: Point2<f64>) -> (Cell, Cell) {
        let (begin, end) = (self.grid.center(from), self.grid.center(to));
        let along = |point: Point2<f64>| (point - begin).dot(&(end - begin));
        let line = passed_between(from, to);
        let is_before = |pair: &&[Cell]| along(self.grid.center(pair[1])) <= along(at);
        let passed = line.windows(2).take_while(is_before).count();
        match line.get(passed..passed + 2) {
            Some(&[before, next]) => (before, next),
            _ => (from, to),
        }
    }
}

/// The cells that a straight line passes from the centre of one cell to that of another, including
/// both: one in each column or in each row, whichever are more. Each is a neighbour of the cell before.
fn passed_between(from: Cell, to: Cell) -> Vec<Cell> {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let steps = dx.abs().max(dy.abs());
    let share = |way: i32, step: i32| (2 * way * step + steps).div_euclid(2 * steps.max(1));
    (0..=steps).map(|step| from.offset(share(dx, step), share(dy, step))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap::Grid;

    /// A floor where `#` blocks, and `!` is free but the robot bumped at it by a step from the left.
    fn floor(rows: [&str; 5], radius: f64) -> Traversable {
        let grid = Grid::new(Point2::origin(), 1.0, rows[0].len(), 5).unwrap();
        let mut traversable = Traversable::new(grid, radius);
        for (y, row) in (0..).zip(rows.iter().rev()) {
            for (x, cell) in (0..).zip(row.chars()) {
                let here = Cell::new(x, y);
                traversable.update(grid.index(here).unwrap(), Some(cell != '#'));
                if cell == '!' {
                    traversable.bump(here.offset(-1, 0), here);
                }
            }
        }
        traversable
    }

    fn corners(rows: [&str; 5], path: &[(i32, i32)]) -> Vec<Cell> {
        let path: Vec<Cell> = path.iter().map(|(x, y)| Cell::new(*x, *y)).collect();
        floor(rows, 0.4).pulled_tight(Cell::new(0, 0), &path)
    }

    const WAY: [(i32, i32); 6] = [(1, 1), (2, 2), (3, 2), (4, 2), (5, 2), (6, 2)];

    #[test]
    fn in_open_space_a_path_is_one_line() {
        let open = [".......", ".......", ".......", ".......", "......."];
        assert_eq!(corners(open, &WAY), [Cell::new(6, 2)]);
        assert_eq!(corners(open, &[]), []);
        assert_eq!(corners(open, &[(1, 0)]), [Cell::new(1, 0)]);
    }

    #[test]
    fn beside_what_blocks_it_goes_from_cell_to_cell() {
        // (4, 0) is at least 1.2 cells from the line to (6, 2); the line needs 1.4 cells.
        let post = [".......", ".......", ".......", ".......", "....#.."];
        let found = corners(post, &WAY);
        assert!(found.len() > 1 && found.last() == Some(&Cell::new(6, 2)), "{found:?}");
    }

    #[test]
    fn what_was_bumped_at_is_not_passed() {
        let bumped = [".......", ".......", ".......", "...!...", "......."];
        assert!(corners(bumped, &WAY).len() > 1);
    }

    #[test]
    fn a_bump_on_a_line_is_a_bump_at_a_step() {
        let floor = floor(["......."; 5], 0.4);
        let step = |x: f64| {
            floor.step_at(Cell::new(0, 0), Cell::new(4, 2), Point2::new(x, x / 2.0 + 0.25))
        };
        assert_eq!(step(0.6), (Cell::new(0, 0), Cell::new(1, 1)));
        assert_eq!(step(2.6), (Cell::new(2, 1), Cell::new(3, 2)));
        let neighbours = floor.step_at(Cell::new(1, 1), Cell::new(1, 2), Point2::new(1.5, 1.7));
        assert_eq!(neighbours, (Cell::new(1, 1), Cell::new(1, 2)));
    }
}
