//! The view-points where the robot can stand, and the steps between them.

mod tight;

use crate::Reach;
use covmap::{Cell, Grid, STEPS, Steps, opposite, step_between};

/// The traversable view-points, and the steps that lead from one to the next.
///
/// Choice: a view-point is traversable if its cell is known with a most likely coverage of
/// at most `traversable_coverage`, and no known cell of more has its centre nearer than the
/// robot's radius. (With the distance to the nearest edge of such cells instead, one wrong cell at
/// either post closes doors of .8 m at r = .1 m; the price of centres is more bumps.) A step leads from
/// one view-point to the next if no such centre is under the body on the way. An unknown cell whose
/// centre was under the robot's body counts as free: on coarse grids such a cell is too near for the
/// sensors and too large to be under the body entirely.
///
/// What the robot's body tried outweighs the map: a step that the robot drove is possible in both
/// directions, a step at which it bumped is not, and where it stood it can stand again. A cell that
/// the robot bumped at by a straight step, and never stood on, is no view-point.
#[derive(Debug, Clone)]
pub(crate) struct Traversable {
    grid: Grid,
    /// The robot's radius in cells, and the number of cells around it that may matter.
    radius_in_cells: f64,
    reach: i32,
    /// Cells that block a view-point, relative to it.
    disc: Vec<(i32, i32)>,
    /// Cells that block a step and neither of its ends, relative to where the step begins.
    between: [Vec<(i32, i32)>; 4],
    /// The number of blocking cells too near to each view-point.
    blockers: Vec<u32>,
    blocking: Vec<bool>,
    free: Vec<bool>,
    /// Whether the body was over the centre of each cell.
    under_body: Vec<bool>,
    stood: Vec<bool>,
    bumped: Vec<bool>,
    /// The steps from each cell that were driven, and those that ended with a bump.
    driven: Vec<u8>,
    barred: Vec<u8>,
    /// The cells from which there is a driven or a barred step.
    tried: Vec<usize>,
}

impl Traversable {
    pub(crate) fn new(grid: Grid, radius: f64) -> Self {
        let r = grid.resolution();
        #[allow(clippy::cast_possible_truncation, reason = "a robot is some cells wide")]
        let reach = (radius / r).ceil().min(200.0) as i32 + 1;
        let square = || (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
        let touches = |step, at| distance_from_step(step, at) * r < radius - 1e-9;
        let at_an_end = |(dx, dy): (i32, i32), (x, y): (i32, i32)| {
            touches((0, 0), (x, y)) || touches((0, 0), (x - dx, y - dy))
        };
        let between = |k: usize| {
            let on_the_way = |at: &(i32, i32)| touches(STEPS[k], *at) && !at_an_end(STEPS[k], *at);
            square().filter(on_the_way).collect()
        };
        let none = vec![false; grid.len()];
        Self {
            grid,
            radius_in_cells: radius / r,
            reach,
            disc: square().filter(|at| touches((0, 0), *at)).collect(),
            between: std::array::from_fn(between),
            blockers: vec![0; grid.len()],
            blocking: none.clone(),
            free: none.clone(),
            under_body: none.clone(),
            stood: none.clone(),
            bumped: none,
            driven: vec![0; grid.len()],
            barred: vec![0; grid.len()],
            tried: Vec::new(),
        }
    }

    /// Whether the robot can stand on the view-point with a row-major index.
    pub(crate) fn at(&self, index: usize) -> bool {
        self.stood[index] || !self.bumped[index] && self.seems_open(index)
    }

    /// Whether the robot might be able to stand on a view-point: it can, or its cell is unknown with nothing
    /// known in the way, next to one where it can.
    pub(crate) fn may_be_at(&self, index: usize) -> bool {
        let cell = self.grid.cell(index);
        let is_beside = |(dx, dy): &(i32, i32)| {
            self.grid.index(cell.offset(*dx, *dy)).is_some_and(|beside| self.at(beside))
        };
        match self.obstacle(index) {
            Reach::CutOff => true,
            Reach::Unknown => STEPS.iter().any(is_beside),
            _ => false,
        }
    }

    fn seems_open(&self, index: usize) -> bool {
        self.is_free(index) && self.blockers[index] == 0
    }

    /// The steps that the robot can take.
    pub(crate) fn steps(&self) -> Steps {
        let mut steps = Steps::between(&self.grid, |index| self.at(index));
        for (step, between) in self.between.iter().enumerate().filter(|(_, b)| !b.is_empty()) {
            let blocks = |at: &Cell| {
                let blocking = |&(dx, dy)| self.grid.index(at.offset(dx, dy));
                between.iter().filter_map(blocking).any(|i| self.blocking[i])
            };
            for (index, _) in self.grid.cells().enumerate().filter(|(_, at)| blocks(at)) {
                steps.close(index, step);
            }
        }
        let set = |steps: u8| (0..8).filter(move |step| steps >> step & 1 == 1);
        for &index in &self.tried {
            set(self.driven[index]).for_each(|step| steps.open(index, step));
            set(self.barred[index]).for_each(|step| steps.close(index, step));
        }
        steps
    }

    /// The same if some more cells are free.
    pub(crate) fn with_free(&self, is_free: impl Fn(usize) -> bool) -> Self {
        let mut hoped = self.clone();
        (0..self.free.len())
            .filter(|index| is_free(*index))
            .for_each(|index| hoped.update(index, Some(true)));
        hoped
    }

    /// Whether the robot may drive over a cell, by the map or because its body was there.
    pub(crate) fn is_free(&self, index: usize) -> bool {
        self.free[index] || self.under_body[index]
    }

    /// The cells whose centres are under the body at a view-point.
    pub(crate) fn under_body_at(&self, index: usize) -> impl Iterator<Item = usize> {
        let at = self.grid.cell(index);
        self.disc.iter().filter_map(move |(dx, dy)| self.grid.index(at.offset(*dx, *dy)))
    }

    /// The number of cells whose centres are under the body.
    pub(crate) fn body_cells(&self) -> usize {
        self.disc.len()
    }

    /// Whether the robot never bumped at a view-point.
    pub(crate) fn is_untried(&self, index: usize) -> bool {
        !self.bumped[index]
    }

    /// Whether a step ended with a bump.
    pub(crate) fn is_barred(&self, from: usize, step: usize) -> bool {
        self.barred[from] >> step & 1 == 1
    }

    /// The obstacle that keeps the robot from a view-point that it does not reach.
    pub(crate) fn obstacle(&self, index: usize) -> Reach {
        if self.at(index) {
            Reach::CutOff
        } else if self.bumped[index] {
            Reach::Bumped
        } else if self.blockers[index] > 0 {
            Reach::Covered
        } else {
            Reach::Unknown
        }
    }

    /// Takes over the state of a cell: `Some(true)` if the robot may drive over it, `Some(false)` if it
    /// blocks, `None` if it is unknown.
    pub(crate) fn update(&mut self, index: usize, free: Option<bool>) {
        let blocking = free == Some(false);
        self.free[index] = free == Some(true);
        if blocking == self.blocking[index] {
            return;
        }
        self.blocking[index] = blocking;
        let cell = self.grid.cell(index);
        for k in 0..self.disc.len() {
            let (dx, dy) = self.disc[k];
            let Some(near) = self.grid.index(cell.offset(-dx, -dy)) else { continue };
            if blocking {
                self.blockers[near] += 1;
            } else {
                self.blockers[near] -= 1;
            }
        }
    }

    /// Takes note that the robot stands on a cell's view-point.
    pub(crate) fn stand_on(&mut self, cell: Cell) {
        if let Some(index) = self.grid.index(cell) {
            self.stood[index] = true;
        }
    }

    /// Takes note that the robot's body was over the centre of a cell.
    pub(crate) fn cover(&mut self, cell: Cell) {
        if let Some(index) = self.grid.index(cell) {
            self.under_body[index] = true;
        }
    }

    /// Takes note that the robot drove from one cell to a neighbour.
    pub(crate) fn drive(&mut self, from: Cell, to: Cell) {
        self.try_step(from, to, |t| (&mut t.driven, &mut t.barred));
    }

    /// Takes note that the robot bumped into something as it drove from one cell to a neighbour.
    pub(crate) fn bump(&mut self, from: Cell, to: Cell) {
        self.try_step(from, to, |t| (&mut t.barred, &mut t.driven));
        // On a diagonal step the robot may have clipped an obstacle beside it.
        let is_straight = step_between(from, to).is_some_and(|step| step % 2 == 0);
        if let Some(index) = self.grid.index(to).filter(|_| is_straight) {
            self.bumped[index] = true;
        }
    }

    /// Takes note of how a step ended, for both directions; the last attempt counts.
    fn try_step(
        &mut self,
        from: Cell,
        to: Cell,
        sets: fn(&mut Self) -> (&mut Vec<u8>, &mut Vec<u8>),
    ) {
        let Some(step) = step_between(from, to) else { return };
        let ends = [(self.grid.index(from), step), (self.grid.index(to), opposite(step))];
        let [(Some(from), step), (Some(to), back)] = ends else { return };
        for index in [from, to] {
            if self.driven[index] | self.barred[index] == 0 {
                self.tried.push(index);
            }
        }
        let (so, not) = sets(self);
        for (index, step) in [(from, step), (to, back)] {
            so[index] |= 1 << step;
            not[index] &= !(1 << step);
        }
    }
}

/// The distance of a place from the line of a step that begins at the origin [cells].
fn distance_from_step((dx, dy): (i32, i32), (x, y): (i32, i32)) -> f64 {
    let [dx, dy, x, y] = [dx, dy, x, y].map(f64::from);
    let squared = dx * dx + dy * dy;
    let along = if squared > 0.0 { ((x * dx + y * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
    libm::hypot(x - along * dx, y - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn a_view_point_needs_the_robots_radius_around_it() {
        let grid = Grid::new(Point2::origin(), 0.1, 12, 1).unwrap();
        let mut traversable = Traversable::new(grid, 0.27);
        (0..12).for_each(|i| traversable.update(i, Some(true)));
        let picture =
            |t: &Traversable| (0..12).map(|i| if t.at(i) { '.' } else { '#' }).collect::<String>();
        assert_eq!(picture(&traversable), "............");
        traversable.update(5, Some(false));
        assert_eq!(picture(&traversable), "...#####....");
        traversable.stand_on(Cell::new(3, 0));
        traversable.bump(Cell::new(1, 0), Cell::new(0, 0));
        assert_eq!(picture(&traversable), "#...####....");
        traversable.update(5, Some(true));
        assert_eq!(picture(&traversable), "#...........");
    }

    #[test]
    fn unknown_cells_are_not_traversable_but_do_not_block() {
        let grid = Grid::new(Point2::origin(), 0.1, 3, 1).unwrap();
        let mut traversable = Traversable::new(grid, 0.27);
        traversable.update(1, Some(true));
        assert_eq!([0, 1, 2].map(|i| traversable.at(i)), [false, true, false]);
        traversable.cover(Cell::new(2, 0));
        assert_eq!([0, 1, 2].map(|i| traversable.at(i)), [false, true, true]);
    }

    #[test]
    fn the_robot_may_be_beside_where_it_can_stand_unless_something_is_in_the_way() {
        let grid = Grid::new(Point2::origin(), 0.1, 12, 1).unwrap();
        let mut traversable = Traversable::new(grid, 0.15);
        // 2 to 4, 9 and 11 are unknown.
        for (from, to, free) in [(0, 2, Some(true)), (5, 9, Some(true)), (10, 11, Some(false))] {
            (from..to).for_each(|i| traversable.update(i, free));
        }
        let picture = |may: &dyn Fn(usize) -> bool| {
            (0..12).map(|i| if may(i) { '.' } else { '#' }).collect::<String>()
        };
        assert_eq!(picture(&|i| traversable.at(i)), "..###....###");
        assert_eq!(picture(&|i| traversable.may_be_at(i)), "...#.....###");
    }

    /// Which of the eight steps from the middle of 3 × 3 cells are possible.
    fn steps_from_the_middle(t: &Traversable) -> u8 {
        t.steps().from(4)
    }

    fn all_free(resolution: f64) -> Traversable {
        let grid = Grid::new(Point2::origin(), resolution, 3, 3).unwrap();
        let mut traversable = Traversable::new(grid, 0.27);
        (0..9).for_each(|i| traversable.update(i, Some(true)));
        traversable
    }

    #[test]
    fn the_last_time_that_a_step_was_tried_counts_in_both_directions() {
        let mut t = all_free(0.5);
        let (middle, corner) = (Cell::new(1, 1), Cell::new(2, 2));
        // A diagonal may have clipped a post: the cell stays, the step is closed.
        t.bump(middle, corner);
        assert_eq!(steps_from_the_middle(&t), 0b1111_1101);
        assert!(t.at(8) && t.is_untried(8) && t.is_barred(8, 5));
        t.bump(Cell::new(1, 2), corner);
        assert!(!t.at(8) && !t.is_untried(8) && t.is_barred(8, 4));
        // The body got there from another side and may go back that way, but not by the step of the bump.
        t.stand_on(corner);
        t.drive(Cell::new(2, 1), corner);
        assert!(t.at(8) && t.steps().from(8) == 0b0100_0000);
        t.drive(corner, middle);
        assert_eq!((steps_from_the_middle(&t), t.steps().from(8)), (0xff, 0b0110_0000));
    }

    #[test]
    fn a_step_that_the_body_has_driven_is_possible_whatever_the_map_says() {
        let mut t = all_free(0.2);
        t.drive(Cell::new(1, 1), Cell::new(2, 2));
        (0..9).for_each(|i| t.update(i, Some(false)));
        assert_eq!((steps_from_the_middle(&t), t.steps().from(8)), (0b10, 0b10_0000));
    }

    #[test]
    fn a_diagonal_needs_room_for_the_body_and_not_the_cells_beside_it() {
        // With cells of .5 m the body is over neither cell beside a diagonal, .354 m away; with .3 m it
        // is over both, .212 m away, but at neither end; with .2 m it is over them at both ends.
        for (resolution, steps) in [(0.5, 0b1111_1110), (0.3, 0b0111_1100), (0.2, 0b0111_1100)] {
            let mut t = all_free(resolution);
            t.update(5, Some(false));
            assert_eq!(steps_from_the_middle(&t), steps, "{resolution}");
        }
        // If the cells beside a diagonal are unknown, the robot tries it.
        let grid = Grid::new(Point2::origin(), 0.2, 2, 2).unwrap();
        let mut t = Traversable::new(grid, 0.27);
        [0, 3].into_iter().for_each(|i| t.update(i, Some(true)));
        assert_eq!(t.steps().from(0), 0b10);
    }
}
