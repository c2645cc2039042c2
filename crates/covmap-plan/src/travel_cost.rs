//! d_c(l, x): the travel cost of each view-point.

mod label;
#[cfg(test)]
mod plain;
mod pruning;
mod spread;

use covmap::{Cell, Steps, neighbour, opposite};
use label::{Label, in_cells};
use spread::Spread;

/// The shortest ways from one cell to all cells that can be reached from it.
#[derive(Debug, Clone)]
pub struct TravelCosts {
    labels: Vec<Label>,
    steps: Steps,
}

/// Computes the shortest ways from `source` to all cells to which steps lead.
///
/// A straight step is as long as the side of a cell, a diagonal step √2 times that.
///
/// # Panics
/// If the source lies outside the grid.
pub fn travel_costs(steps: Steps, source: Cell) -> TravelCosts {
    let source = steps.grid().index(source).and_then(|index| u32::try_from(index).ok());
    let source = source.unwrap_or_else(|| panic!("the source lies outside the grid"));
    let labels = Spread::new(&steps).from(source);
    TravelCosts { labels, steps }
}

impl TravelCosts {
    /// Returns d_c of the cell with a row-major index \[m\]; `None` if it cannot be reached, or
    /// is not in the grid. Equal lengths are equal to the last bit, whatever steps they consist of.
    pub fn cost(&self, index: usize) -> Option<f64> {
        in_cells(*self.labels.get(index)?).map(|length| length * self.steps.grid().resolution())
    }

    /// Iterates over the row-major indices of all cells that can be reached, in ascending order.
    pub fn reached(&self) -> impl Iterator<Item = usize> {
        let is_reached = |(_, label): &(usize, &Label)| **label != label::UNREACHED;
        self.labels.iter().enumerate().filter(is_reached).map(|(index, _)| index)
    }

    /// The nearest of some cells, given by their row-major indices, and the first of equally near cells;
    /// `None` if none of them can be reached.
    pub(crate) fn nearest(&self, indices: &[usize]) -> Option<usize> {
        indices
            .iter()
            .copied()
            .filter(|i| self.labels[*i] != label::UNREACHED)
            .min_by_key(|i| label::length(self.labels[*i]))
    }

    /// Returns the cells of the shortest way to a cell, without the source and with the cell itself.
    ///
    /// Empty for the source; `None` if the cell cannot be reached. Of several shortest ways it is the
    /// one whose last step comes from the nearest cell, and from the first of these in row-major order;
    /// the same holds for each step back to the source.
    pub fn path_to(&self, cell: Cell) -> Option<Vec<Cell>> {
        let grid = *self.steps.grid();
        let mut at = grid.index(cell)?;
        self.cost(at)?;
        let mut path = Vec::new();
        while let Some(previous) = self.previous(at) {
            path.push(grid.cell(at));
            at = previous;
        }
        path.reverse();
        Some(path)
    }

    /// The cell before the last on the way to a cell; `None` for the source.
    fn previous(&self, at: usize) -> Option<usize> {
        // Diagonal steps are longer, so the cells that they come from are nearer to the source.
        const NEAREST_FIRST: [usize; 8] = [1, 3, 7, 5, 2, 0, 4, 6];
        let comes_by = |step: usize| {
            let from = neighbour(self.steps.grid(), at, opposite(step))?;
            let is_step = self.steps.from(from) >> step & 1 == 1;
            let length = label::of_step(step);
            (is_step && label::is_sum(self.labels[at], self.labels[from], length)).then_some(from)
        };
        NEAREST_FIRST.into_iter().find_map(comes_by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap::Grid;
    use nalgebra::Point2;

    /// Compares costs in tenths of a cell from `S` over `.`; `##` is a cell that cannot be reached.
    #[track_caller]
    fn check(world: &str, expected: &str) {
        let rows: Vec<Vec<char>> = world.split_whitespace().map(|r| r.chars().collect()).collect();
        let (height, width) = (rows.len(), rows[0].len());
        let grid = Grid::new(Point2::origin(), 1.0, width, height).unwrap();
        let at = |cell: Cell| rows[height - 1 - cell.y as usize][cell.x as usize];
        let last = |side: usize| i32::try_from(side).unwrap();
        let source = grid.cells().find(|c| at(*c) == 'S').unwrap();
        let costs = travel_costs(Steps::between(&grid, |i| at(grid.cell(i)) != '#'), source);
        let text = |cell| {
            costs
                .cost(grid.index(cell).unwrap())
                .map_or("##".into(), |c| format!("{:02}", (c * 10.0).round()))
        };
        let row = |y| (0..last(width)).map(|x| text(Cell::new(x, y))).collect::<Vec<_>>().join(" ");
        let drawn: Vec<String> = (0..last(height)).rev().map(row).collect();
        let expected: Vec<&str> =
            expected.lines().map(str::trim).filter(|l| !l.is_empty()).collect();
        assert_eq!(drawn, expected, "\n{}", drawn.join("\n"));
    }

    #[test]
    fn the_way_leads_round_obstacles() {
        check(
            "....
             .##.
             S#..",
            "20 24 34 44
             10 ## ## 48
             00 ## 62 58",
        );
    }

    #[test]
    fn diagonal_steps_cost_root_two() {
        check(
            "...
             ...
             S..",
            "20 24 28
             10 14 24
             00 10 20",
        );
    }

    #[test]
    fn what_is_walled_in_cannot_be_reached() {
        check(
            "S#.
             ##.",
            "00 ## ##
             ## ## ##",
        );
    }
}
