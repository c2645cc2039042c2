//! Places that may be a passage although they look blocked.

use crate::planner::{Candidates, Planner};
use crate::travel_costs;
use covmap::{Cell, CoverageMap, Grid, Steps, neighbour, step_between};
use covmap_gain::ViewPoints;

/// A passage is worth trying if the robot could stand beyond it on this many times the area of its
/// body, about a square metre; a passage to a pocket behind a bump is not.
pub(crate) const ROOM: usize = 4;

impl Planner {
    /// L(c) beyond the nearest passage that looks blocked but was not tried, for a robot that can reach
    /// no candidate; `None` if there is no such passage.
    ///
    /// Passages over cells that the robot never bumped at come first; then passages over any cells, by
    /// steps that it never bumped at.
    pub(crate) fn candidates_beyond_a_passage(
        &mut self,
        map: &CoverageMap,
        from: Cell,
    ) -> Option<Candidates> {
        let longest = self.parameters().longest_passage(self.grid.resolution())?;
        let steps = self.traversable.steps();
        let here = travel_costs(steps.clone(), from);
        let is_cut_off = |i: usize| self.traversable.at(i) && here.cost(i).is_none();
        let cut_off: Vec<usize> = (0..self.grid.len()).filter(|i| is_cut_off(*i)).collect();
        self.gains.refresh_sight(&ViewPoints::of(&self.grid, cut_off.iter().copied()));
        let may_be = |i: &usize| !self.measured.is_spent(*i) && self.gains.has_reason(*i);
        let mut offered = cut_off.into_iter().filter(may_be).collect();
        self.leave_out_vain(map, &mut offered, self.least_change);
        let is_candidate = |i: usize| offered.binary_search(&i).is_ok();
        let is_cut_off = |i: usize| self.traversable.at(i) && here.cost(i).is_none();
        let least = ROOM * self.traversable.body_cells();
        let rooms = regions(&steps, least, is_cut_off, is_candidate);
        let nearest = |only_untried: bool| {
            nearest_passage(
                &self.grid,
                longest,
                |i| here.cost(i).map(|d| d / self.grid.resolution()),
                |i| {
                    (!only_untried || self.traversable.is_untried(i))
                        && !self.exploration.is_outside(i)
                },
                |i, step| !self.traversable.is_barred(i, step),
                |i| rooms[i],
            )
        };
        let passage = nearest(true).or_else(|| nearest(false))?;
        let mut open = steps;
        for ends in passage.windows(2) {
            let step = step_between(self.grid.cell(ends[0]), self.grid.cell(ends[1]))?;
            open.open(ends[0], step);
        }
        let costs = travel_costs(open, from);
        let is_reached = |i: &usize| is_candidate(*i) && costs.cost(*i).is_some();
        let indices = (0..self.grid.len()).filter(is_reached).collect();
        let passage = passage[1..passage.len() - 1].to_vec();
        Some(Candidates { indices, costs, passage })
    }
}

/// An untried way from a reachable cell to a cell beyond a passage: the row-major indices of its
/// cells, including both ends; `None` if there is none.
///
/// `travel_cost` is the travel cost of each reachable cell \[cells\]. Between the ends lie at most
/// `longest` cells, and each of them fulfils `may_try`; each step fulfils `may_try_step`. The search
/// reaches every cell over as few untried cells as possible; the way is the one with the least travel
/// cost to a cell that `is_beyond`.
pub(crate) fn nearest_passage(
    grid: &Grid,
    longest: usize,
    travel_cost: impl Fn(usize) -> Option<f64>,
    may_try: impl Fn(usize) -> bool,
    may_try_step: impl Fn(usize, usize) -> bool,
    is_beyond: impl Fn(usize) -> bool,
) -> Option<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let mut previous = vec![UNSEEN; grid.len()];
    let mut front: Vec<(f64, usize)> =
        (0..grid.len()).filter_map(|index| Some((travel_cost(index)?, index))).collect();
    front.iter().for_each(|(_, index)| previous[*index] = *index);
    let mut nearest: Option<(f64, usize, usize)> = None;
    // Of passages with the same number of cells, the nearest comes first.
    for length in 0..=longest {
        let mut next = Vec::new();
        front.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(cost, at) in &front {
            for step in 0..8 {
                let Some(to) = neighbour(grid, at, step) else { continue };
                if previous[to] != UNSEEN || !may_try_step(at, step) {
                    continue;
                }
                let cost = cost + if step % 2 == 0 { 1.0 } else { std::f64::consts::SQRT_2 };
                if is_beyond(to) {
                    if nearest.is_none_or(|(least, ..)| cost < least) {
                        nearest = Some((cost, at, to));
                    }
                } else if length < longest && may_try(to) {
                    next.push((cost, at, to));
                }
            }
        }
        next.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        front.clear();
        for (cost, at, to) in next {
            if previous[to] == UNSEEN {
                previous[to] = at;
                front.push((cost, to));
            }
        }
    }
    nearest.map(|(_, last, beyond)| way_from(&previous, last, beyond))
}

/// Marks the cells of the regions of members that have at least `least` cells and a cell that `is_wanted`.
pub(crate) fn regions(
    steps: &Steps,
    least: usize,
    is_member: impl Fn(usize) -> bool,
    is_wanted: impl Fn(usize) -> bool,
) -> Vec<bool> {
    let mut large = vec![false; steps.grid().len()];
    for region in steps.regions(is_member) {
        if region.len() >= least && region.iter().any(|i| is_wanted(*i)) {
            region.into_iter().for_each(|i| large[i] = true);
        }
    }
    large
}

/// The cells of the passage that ends with the cells `last` and `beyond`, from its first cell on.
fn way_from(previous: &[usize], last: usize, beyond: usize) -> Vec<usize> {
    let mut way = vec![beyond, last];
    let mut at = last;
    while previous[at] != at {
        at = previous[at];
        way.push(at);
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    /// Compares the passage in a picture: `r` is a cell that the robot can reach, `b` a cell beyond, `?` a
    /// cell that may open, and `o` a cell of the passage. The robot is in the first cell.
    #[track_caller]
    fn check(longest: usize, picture: &str, expected: Option<&str>) {
        let cells: Vec<u8> = picture.bytes().filter(|c| *c != b'\n').collect();
        let width = picture.find('\n').unwrap();
        let grid = Grid::new(Point2::origin(), 0.1, width, cells.len() / width).unwrap();
        let cells = &cells;
        let is = |what: u8| move |i: usize| cells[i] == what;
        let travel_cost = |i: usize| (cells[i] == b'r').then(|| (i % width + i / width) as f64);
        let any = |_, _| true;
        let passage = nearest_passage(&grid, longest, travel_cost, is(b'?'), any, is(b'b'));
        let drawn = passage.map(|passage| {
            let mut drawn: Vec<u8> = picture.bytes().collect();
            passage.iter().filter(|i| cells[**i] == b'?').for_each(|i| drawn[i + i / width] = b'o');
            String::from_utf8(drawn).unwrap()
        });
        assert_eq!(drawn.as_deref(), expected);
    }

    #[test]
    fn the_passage_is_the_nearest_that_is_short_enough() {
        let wall = "rr???bb\nrrr??bb\nrrr??bb\nrrrr?bb\n";
        check(3, wall, Some("rr???bb\nrrroobb\nrrr??bb\nrrrr?bb\n"));
        check(2, wall, Some("rr???bb\nrrroobb\nrrr??bb\nrrrr?bb\n"));
        check(1, wall, Some("rr???bb\nrrr??bb\nrrr??bb\nrrrrobb\n"));
        check(0, wall, None);
    }

    #[test]
    fn bumps_and_the_outside_are_no_passage() {
        check(9, "rr#bb\nrr#bb\n", None);
        check(9, "rr#bb\nrr?bb\n", Some("rr#bb\nrrobb\n"));
    }

    #[test]
    fn where_nothing_lies_beyond_there_is_no_passage() {
        check(9, "rr???\nrr???\n", None);
    }
}
