//! Distance fields, against the Dijkstra's algorithm of two libraries.

use crate::clock::race;
use crate::table::{RatioRow, RatioTable};
use crate::{Measuring, tiles};
use anyhow::{Context, Result};
use covmap::{Cell, Grid, Steps};
use covmap_plan::{TravelCosts, travel_costs};
use pathfinding::num_traits::Zero;
use petgraph::graph::{NodeIndex, UnGraph};
use std::cmp::Ordering;
use std::f64::consts::SQRT_2;
use std::ops::Add;

/// The steps to the right or up; the other steps are the reverse.
const FORWARD: [(i32, i32); 4] = [(1, 0), (-1, 1), (0, 1), (1, 1)];

/// The free cells, with the steps of `travel_costs`.
struct Floor {
    grid: Grid,
    free: Vec<bool>,
}

impl Floor {
    fn at(&self, cell: Cell) -> Option<u32> {
        let index = self.grid.index(cell).filter(|i| self.free[*i])?;
        u32::try_from(index).ok()
    }

    /// Returns the target and the length of a step.
    fn step(&self, from: Cell, (dx, dy): (i32, i32)) -> Option<(u32, f64)> {
        let to = self.at(from.offset(dx, dy))?;
        Some((to, if dx == 0 || dy == 0 { 1.0 } else { SQRT_2 }))
    }

    fn steps(&self, from: u32) -> impl Iterator<Item = (u32, f64)> {
        let cell = self.grid.cell(from as usize);
        let back = FORWARD.map(|(dx, dy)| (-dx, -dy));
        FORWARD.into_iter().chain(back).filter_map(move |by| self.step(cell, by))
    }

    fn graph(&self) -> UnGraph<(), f64> {
        let mut graph = UnGraph::with_capacity(self.grid.len(), 4 * self.grid.len());
        (0..self.grid.len()).for_each(|_| {
            graph.add_node(());
        });
        for cell in self.grid.cells() {
            let Some(from) = self.at(cell) else { continue };
            for (to, length) in FORWARD.into_iter().filter_map(|by| self.step(cell, by)) {
                graph.add_edge(NodeIndex::from(from), NodeIndex::from(to), length);
            }
        }
        graph
    }
}

/// A length with a total order.
#[derive(Debug, Clone, Copy)]
struct Length(f64);

impl Ord for Length {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Length {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Length {}

impl Add for Length {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Zero for Length {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

pub(crate) fn compare(bench: &Measuring<'_>, table: &mut RatioTable) -> Result<()> {
    let Measuring { config, extent, progress } = bench;
    let side = extent.large;
    progress.say(&format!("distance fields on {side} × {side} cells …"));
    let world = tiles::offices(side, config.sonar.surface)?;
    let grid = world.grid(0.1)?;
    let free = world.coverage(&grid).values().iter().map(|c| *c <= 0.0).collect();
    let floor = Floor { grid, free };
    let start = world.given_start().context("the office has a start")?;
    let source = grid.cell_at(start.translation.vector.into()).context("the start is inside")?;
    let from = floor.at(source).context("the start is free")?;

    let ours = || travel_costs(Steps::between(&grid, |i| floor.free[i]), source);
    let field = ours();
    let graph = floor.graph();
    let petgraph = || petgraph::algo::dijkstra(&graph, from.into(), None, |e| *e.weight());
    let successors = |n: &u32| floor.steps(*n).map(|(to, by)| (to, Length(by)));
    let pathfinding = || pathfinding::directed::dijkstra::dijkstra_all(&from, successors);

    let same = petgraph().into_iter().map(|(n, d)| (n.index(), d)).collect::<Vec<_>>();
    let difference = largest_difference(&field, same);
    // The library leaves out the start.
    let others = pathfinding().into_iter().map(|(n, (_, d))| (n as usize, d.0));
    let same = others.chain([(from as usize, 0.0)]).collect();
    let difference = difference.max(largest_difference(&field, same));
    let what = format!("a distance field on {side} × {side} cells, steps of 1 and √2");
    let mut row = |name: &str, (ours, other): (f64, f64)| {
        let (what, against) = (what.clone(), format!("dijkstra of {name}"));
        table.row(RatioRow { what, ours, against, other, target: 20.0 });
    };
    row("petgraph", race(extent.rounds.min(3), ours, petgraph));
    row("pathfinding", race(extent.rounds.min(3), ours, pathfinding));
    table.note(format!(
        "distance field: {} cells reached; largest difference: {difference:.1e} m",
        field.reached().count()
    ));
    Ok(())
}

/// Returns the largest difference of lengths in cells from our field \[m\]; infinite if the reached
/// cells differ.
fn largest_difference(field: &TravelCosts, lengths: Vec<(usize, f64)>) -> f64 {
    if lengths.len() != field.reached().count() {
        return f64::INFINITY;
    }
    let difference = |(index, length): (usize, f64)| {
        field.cost(index).map_or(f64::INFINITY, |cost| (cost - 0.1 * length).abs())
    };
    lengths.into_iter().map(difference).fold(0.0, f64::max)
}
