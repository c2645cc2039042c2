//! Steps that a body can take from cell to cell.

use crate::{Cell, Grid, Raster};

/// The eight steps `(dx, dy)` from a cell to its neighbours, counter-clockwise from the right:
/// even ones are straight, odd ones diagonal.
pub const STEPS: [(i32, i32); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// The bit of a cell near which a step was opened or closed.
const EXCEPTION: u16 = 1 << 8;

/// The steps that a body can take.
///
/// **The one rule**: a body goes from the centre of a cell to that of one of its eight neighbours in a
/// straight line, if it touches nothing on the way. The caller says what the body would touch: the world from
/// its walls, the planner from its belief and from the body's path so far. `Steps` alone answers where a body
/// can go: for the planner's ways and passages, and for the truth that a run is compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    grid: Grid,
    /// For each cell a bit for each step that leads on, and [`EXCEPTION`].
    of: Vec<u16>,
}

impl Steps {
    /// Returns all steps that end in a cell on which the body can stand. `can_stand` takes the
    /// cell's row-major index.
    ///
    /// A step may begin in a cell on which the body cannot stand: a robot may find itself there.
    pub fn between(grid: &Grid, can_stand: impl Fn(usize) -> bool) -> Self {
        let (width, bordered) = (grid.width(), grid.width() + 2);
        let mut stands = vec![0u16; bordered * (grid.height() + 2)];
        let rows = stands.chunks_exact_mut(bordered).skip(1).take(grid.height());
        for (y, row) in rows.enumerate() {
            for (x, stands) in row[1..=width].iter_mut().enumerate() {
                *stands = u16::from(can_stand(y * width + x));
            }
        }
        let mut of = vec![0u16; grid.len()];
        for (y, of) in of.chunks_exact_mut(width).enumerate() {
            let row = |dy: usize| &stands[(y + dy) * bordered..(y + dy + 1) * bordered];
            let three = |dy: usize| [0, 1, 2].map(|dx| &row(dy)[dx..dx + width]);
            let (below, beside, above) = (three(0), three(1), three(2));
            for (x, of) in of.iter_mut().enumerate() {
                *of = beside[2][x]
                    | above[2][x] << 1
                    | above[1][x] << 2
                    | above[0][x] << 3
                    | beside[0][x] << 4
                    | below[0][x] << 5
                    | below[1][x] << 6
                    | below[2][x] << 7;
            }
        }
        Self { grid: *grid, of }
    }

    /// Returns the grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the steps that lead on from the cell with a row-major index: bit k for `STEPS[k]`.
    ///
    /// # Panics
    /// This and [`is_regular`](Self::is_regular) panic if there is no such cell.
    pub fn from(&self, index: usize) -> u8 {
        let [steps, _] = self.of[index].to_le_bytes();
        steps
    }

    /// Returns whether all steps among a cell and its neighbours are those
    /// [`between`](Self::between) the cells on which the body can stand: none was opened or closed.
    pub fn is_regular(&self, index: usize) -> bool {
        self.of[index] & EXCEPTION == 0
    }

    /// Returns for each cell, row by row, the bits of [`from`](Self::from), and 2⁸ where the cell
    /// is not [regular](Self::is_regular).
    pub fn masks(&self) -> &[u16] {
        &self.of
    }

    /// Closes a step in both directions: the body does not get through.
    pub fn close(&mut self, from: usize, step: usize) {
        self.set(from, step, false);
    }

    /// Opens a step in both directions, whatever else speaks against it.
    pub fn open(&mut self, from: usize, step: usize) {
        self.set(from, step, true);
    }

    fn set(&mut self, from: usize, step: usize, open: bool) {
        let Some(to) = neighbour(&self.grid, from, step) else { return };
        let mut changed = false;
        for (index, step) in [(from, step), (to, opposite(step))] {
            changed |= (self.of[index] >> step & 1 == 1) != open;
            self.of[index] = self.of[index] & !(1 << step) | u16::from(open) << step;
        }
        if changed {
            let around = (0..8).filter_map(|k| neighbour(&self.grid, from, k));
            let around: Vec<usize> = around.chain([from]).collect();
            around.into_iter().for_each(|index| self.of[index] |= EXCEPTION);
        }
    }

    /// Returns the cells to which steps lead on from the cell with a row-major index.
    pub fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let (grid, steps) = (self.grid, self.from(index));
        (0..8)
            .filter(move |step| steps >> step & 1 == 1)
            .filter_map(move |step| neighbour(&grid, index, step))
    }

    /// Returns all cells that the body reaches from the cells `first`, and those cells themselves.
    ///
    /// # Panics
    /// If one of the cells `first` does not exist.
    pub fn reached(&self, first: impl IntoIterator<Item = usize>) -> Raster<bool> {
        let mut reached = Raster::filled(self.grid, false);
        for index in first {
            self.spread(index, &mut reached);
        }
        reached
    }

    /// Returns the regions of the member cells. In each region the body gets from any cell to any
    /// other without leaving the region.
    pub fn regions(&self, is_member: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let mut seen =
            Raster::from_fn(self.grid, |cell| !self.grid.index(cell).is_some_and(&is_member));
        let mut regions = Vec::new();
        for first in 0..self.grid.len() {
            let region = self.spread(first, &mut seen);
            if !region.is_empty() {
                regions.push(region);
            }
        }
        regions
    }

    /// Marks the cells that the body reaches from a cell over unmarked cells, and returns them.
    fn spread(&self, first: usize, marked: &mut Raster<bool>) -> Vec<usize> {
        if std::mem::replace(&mut marked[first], true) {
            return Vec::new();
        }
        let mut region = vec![first];
        let mut done = 0;
        while let Some(&at) = region.get(done) {
            done += 1;
            for to in self.neighbours(at) {
                if !std::mem::replace(&mut marked[to], true) {
                    region.push(to);
                }
            }
        }
        region
    }
}

/// Returns the step back.
pub fn opposite(step: usize) -> usize {
    (step + 4) % 8
}

/// Returns the cell to which a step leads, by row-major indices; `None` if it leads out of the grid.
pub fn neighbour(grid: &Grid, index: usize, step: usize) -> Option<usize> {
    let (dx, dy) = STEPS[step % 8];
    grid.index(grid.cell(index).offset(dx, dy))
}

/// Returns the step from one cell to another; `None` if they are not neighbours.
pub fn step_between(from: Cell, to: Cell) -> Option<usize> {
    let (dx, dy) = (to.x.checked_sub(from.x)?, to.y.checked_sub(from.y)?);
    STEPS.iter().position(|step| *step == (dx, dy))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    /// Returns the steps over the cells of a picture that are not `#`, first row on top.
    fn steps(picture: &str) -> Steps {
        let rows: Vec<&[u8]> = picture.split_whitespace().map(str::as_bytes).rev().collect();
        let grid = Grid::new(Point2::origin(), 1.0, rows[0].len(), rows.len()).unwrap();
        Steps::between(&grid, |i| rows[i / grid.width()][i % grid.width()] != b'#')
    }

    #[test]
    fn a_step_leads_to_each_neighbour_that_can_be_stood_on() {
        let steps = steps(".#. ... ##.");
        // From the middle: right, up right, up left, left, down right.
        assert_eq!(steps.from(4), 0b1001_1011);
        assert_eq!(steps.neighbours(4).collect::<Vec<_>>(), [5, 8, 6, 3, 2]);
        // From a cell that cannot be stood on, too.
        assert_eq!(steps.neighbours(0).collect::<Vec<_>>(), [4, 3]);
    }

    #[test]
    fn a_step_is_opened_and_closed_in_both_directions() {
        let mut steps = steps("..... ..... ..... .....");
        steps.close(6, 1);
        assert_eq!((steps.from(6) >> 1 & 1, steps.from(12) >> 5 & 1), (0, 0));
        let irregular: Vec<usize> = (0..20).filter(|i| !steps.is_regular(*i)).collect();
        assert_eq!(irregular, [0, 1, 2, 5, 6, 7, 10, 11, 12]);
        steps.open(12, 5);
        assert_eq!((steps.from(6) >> 1 & 1, steps.from(12) >> 5 & 1), (1, 1));
        let mut same = steps.clone();
        same.open(12, 5);
        assert_eq!(steps, same);
    }

    #[test]
    fn what_is_reached_and_what_hangs_together() {
        let mut steps = steps("..#.. .#... ..#..");
        let count = |s: &Steps, first| s.reached([first]).values().iter().filter(|r| **r).count();
        // Diagonals lead through between the posts; closed, there are two rooms.
        assert_eq!(count(&steps, 0), 12);
        steps.close(1, 1);
        steps.close(7, 3);
        assert_eq!(count(&steps, 0), 5);
        assert_eq!(count(&steps, 4), 7);
        assert_eq!(steps.regions(|i| ![2, 6, 12].contains(&i)).len(), 2);
        steps.open(1, 0);
        assert_eq!(count(&steps, 0), 13);
        assert_eq!(steps.reached([]).values().iter().filter(|r| **r).count(), 0);
    }

    #[test]
    fn neighbours_have_a_step_between_them() {
        let at = Cell::new(3, 3);
        for (step, (dx, dy)) in STEPS.into_iter().enumerate() {
            assert_eq!(step_between(at, at.offset(dx, dy)), Some(step));
            assert_eq!(step_between(at.offset(dx, dy), at), Some(opposite(step)));
        }
        assert_eq!(step_between(at, at), None);
        assert_eq!(step_between(Cell::new(i32::MIN, 0), Cell::new(i32::MAX, 0)), None);
    }
}
