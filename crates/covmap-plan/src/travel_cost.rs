//! d_c(l, x): how far it is to each view-point.

use covmap::{Cell, Grid};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

const UNREACHED: u32 = u32::MAX;

/// A length as its numbers of straight and of diagonal steps: equal lengths are equal to
/// the last bit however they came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Steps {
    straight: u32,
    diagonal: u32,
}

impl Steps {
    fn in_cells(self) -> f64 {
        f64::from(self.straight) + std::f64::consts::SQRT_2 * f64::from(self.diagonal)
    }
}

#[derive(PartialEq, Eq)]
struct Front {
    steps: Steps,
    index: u32,
}

impl Ord for Front {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_length = self.steps.in_cells().total_cmp(&other.steps.in_cells());
        by_length.then(self.index.cmp(&other.index))
    }
}

impl PartialOrd for Front {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The shortest ways from one cell to all that can be reached from it.
#[derive(Debug, Clone)]
pub struct TravelCosts {
    grid: Grid,
    steps: Vec<Steps>,
    previous: Vec<u32>,
    reached: Vec<u32>,
}

/// The shortest ways from `source` over traversable cells to all others: eight neighbours,
/// steps of 1 and √2 cells, and no corner cut: a diagonal step needs both cells beside it.
///
/// The source itself need not be traversable.
///
/// # Panics
/// If the source lies outside the grid.
pub fn travel_costs(grid: &Grid, source: Cell, traversable: impl Fn(usize) -> bool) -> TravelCosts {
    let index = |cell: Cell| grid.index(cell).and_then(|i| u32::try_from(i).ok());
    let start = index(source).unwrap_or_else(|| panic!("{source:?} lies outside the grid"));
    let unreached = Steps { straight: UNREACHED, diagonal: 0 };
    let mut steps = vec![unreached; grid.len()];
    let mut previous = vec![UNREACHED; grid.len()];
    let mut reached = Vec::new();
    let mut heap = BinaryHeap::new();
    steps[start as usize] = Steps { straight: 0, diagonal: 0 };
    heap.push(Reverse(Front { steps: steps[start as usize], index: start }));
    let free = |cell: Cell| index(cell).filter(|i| traversable(*i as usize));
    while let Some(Reverse(front)) = heap.pop() {
        if front.steps != steps[front.index as usize] {
            continue;
        }
        reached.push(front.index);
        let cell = grid.cell(front.index as usize);
        for dy in -1..=1 {
            for dx in -1..=1 {
                let Some(next) = free(cell.offset(dx, dy)).filter(|_| (dx, dy) != (0, 0)) else {
                    continue;
                };
                let diagonal = dx != 0 && dy != 0;
                if diagonal
                    && (free(cell.offset(dx, 0)).is_none() || free(cell.offset(0, dy)).is_none())
                {
                    continue;
                }
                let Steps { straight: s, diagonal: d } = front.steps;
                let longer = if diagonal { (s, d + 1) } else { (s + 1, d) };
                let longer = Steps { straight: longer.0, diagonal: longer.1 };
                if longer.in_cells() < steps[next as usize].in_cells() {
                    steps[next as usize] = longer;
                    previous[next as usize] = front.index;
                    heap.push(Reverse(Front { steps: longer, index: next }));
                }
            }
        }
    }
    TravelCosts { grid: *grid, steps, previous, reached }
}

impl TravelCosts {
    /// d_c of the cell with a row-major index \[m\]; `None` if it cannot be reached.
    pub fn cost(&self, index: usize) -> Option<f64> {
        let steps = self.steps[index];
        (steps.straight != UNREACHED).then(|| steps.in_cells() * self.grid.resolution())
    }

    /// All cells that can be reached, nearest first, by their row-major index.
    pub fn reached(&self) -> impl Iterator<Item = usize> {
        self.reached.iter().map(|i| *i as usize)
    }

    /// The cells of the shortest way to a cell, without the source and with the cell itself;
    /// empty for the source; `None` if the cell cannot be reached.
    pub fn path_to(&self, cell: Cell) -> Option<Vec<Cell>> {
        let mut at = self.grid.index(cell)?;
        self.cost(at)?;
        let mut path = Vec::new();
        while self.previous[at] != UNREACHED {
            path.push(self.grid.cell(at));
            at = self.previous[at] as usize;
        }
        path.reverse();
        Some(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    /// Costs in tenths of a cell from `S` over `.`, `##` where nothing can stand.
    #[track_caller]
    fn check(world: &str, expected: &str) {
        let rows: Vec<Vec<char>> = world.split_whitespace().map(|r| r.chars().collect()).collect();
        let (height, width) = (rows.len(), rows[0].len());
        let grid = Grid::new(Point2::origin(), 1.0, width, height).unwrap();
        let at = |cell: Cell| rows[height - 1 - cell.y as usize][cell.x as usize];
        let last = |side: usize| i32::try_from(side).unwrap();
        let source = grid.cells().find(|c| at(*c) == 'S').unwrap();
        let costs = travel_costs(&grid, source, |i| at(grid.cell(i)) != '#');
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
    fn the_way_leads_round_obstacles_and_cuts_no_corner() {
        check(
            "....
             .##.
             S#..",
            "20 30 40 50
             10 ## ## 60
             00 ## 80 70",
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
