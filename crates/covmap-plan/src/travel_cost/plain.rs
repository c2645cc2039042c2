//! Dijkstra's algorithm as in textbooks, cell by cell: the reference in tests of the fast one.

use super::travel_costs;
use covmap::{Cell, Grid, STEPS, Steps};
use nalgebra::Point2;
use proptest::prelude::*;
use std::f64::consts::SQRT_2;

/// The way to a cell: its straight and diagonal steps, and the cell before it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Way {
    straight: u32,
    diagonal: u32,
    previous: Option<Cell>,
}

impl Way {
    fn length(&self) -> f64 {
        f64::from(self.straight) + SQRT_2 * f64::from(self.diagonal)
    }

    fn and(self, from: Cell, dx: i32, dy: i32) -> Self {
        let is_diagonal = dx != 0 && dy != 0;
        Self {
            straight: self.straight + u32::from(!is_diagonal),
            diagonal: self.diagonal + u32::from(is_diagonal),
            previous: Some(from),
        }
    }
}

/// The shortest ways; of equally short ways the one from the cell that was done first.
fn dijkstra(steps: &Steps, source: Cell) -> Vec<Option<Way>> {
    let grid = *steps.grid();
    let mut ways: Vec<Option<Way>> = vec![None; grid.len()];
    let mut open = vec![grid.index(source).unwrap()];
    ways[open[0]] = Some(Way { straight: 0, diagonal: 0, previous: None });
    while !open.is_empty() {
        let length = |index: usize| ways[index].unwrap().length();
        let nearest = (0..open.len()).min_by(|a, b| {
            length(open[*a]).total_cmp(&length(open[*b])).then(open[*a].cmp(&open[*b]))
        });
        let at = open.swap_remove(nearest.unwrap());
        let cell = grid.cell(at);
        for (step, (dx, dy)) in STEPS.into_iter().enumerate() {
            if steps.from(at) >> step & 1 == 0 {
                continue;
            }
            let next = grid.index(cell.offset(dx, dy)).unwrap();
            let way = ways[at].unwrap().and(cell, dx, dy);
            if ways[next].is_none_or(|known| way.length() < known.length()) {
                if ways[next].is_none() {
                    open.push(next);
                }
                ways[next] = Some(way);
            }
        }
    }
    ways
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn ways_are_those_of_dijkstra(
        width in 1..24usize, height in 1..24usize, blocked in 0..70u32,
        dice in prop::collection::vec(0..100u32, 24 * 24), source in 0..24 * 24usize,
        exceptions in prop::collection::vec((0..24 * 24usize, 0..8usize, any::<bool>()), 0..20)
    ) {
        let grid = Grid::new(Point2::origin(), 0.1, width, height).unwrap();
        let free: Vec<bool> = dice[..grid.len()].iter().map(|d| *d >= blocked).collect();
        let source = grid.cell(source % grid.len());
        let mut steps = Steps::between(&grid, |i| free[i]);
        for (from, step, open) in exceptions {
            let from = from % grid.len();
            if open { steps.open(from, step) } else { steps.close(from, step) }
        }
        let ours = travel_costs(steps.clone(), source);
        let plain = dijkstra(&steps, source);
        for (index, way) in plain.iter().enumerate() {
            let cell = grid.cell(index);
            match (way, ours.cost(index)) {
                (None, None) => prop_assert_eq!(ours.path_to(cell), None),
                (Some(way), Some(cost)) => {
                    prop_assert!((cost - 0.1 * way.length()).abs() < 1e-12);
                    let path = ours.path_to(cell).unwrap();
                    let (last, before) = (path.last(), path.iter().rev().nth(1));
                    prop_assert_eq!(last.copied(), way.previous.map(|_| cell));
                    let before = before.copied().or((!path.is_empty()).then_some(source));
                    prop_assert_eq!(before, way.previous);
                }
                (way, cost) => prop_assert!(false, "{:?}: {:?} but {:?}", cell, way, cost),
            }
        }
        let reached = plain.iter().filter(|way| way.is_some()).count();
        prop_assert_eq!(ours.reached().count(), reached);
    }
}
