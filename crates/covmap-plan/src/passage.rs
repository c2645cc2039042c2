//! Places that may be a passage though they look blocked.

use covmap::{Cell, Grid};
use std::collections::VecDeque;

/// The cells of the blocked passage to which, and through which, it is nearest from where the
/// robot is to what lies beyond; of at most `longest` cells, by their row-major index; `None`
/// if there is none.
///
/// `travel_cost` tells how far each cell is \[cells\] that the robot can reach. In the passage
/// every step leads to one of the four neighbours, over cells that `may_open`, as few as
/// possible; it ends beside a cell that `is_beyond`.
pub(crate) fn nearest_passage(
    grid: &Grid,
    longest: usize,
    travel_cost: impl Fn(usize) -> Option<f64>,
    may_open: impl Fn(usize) -> bool,
    is_beyond: impl Fn(usize) -> bool,
) -> Option<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let mut previous = vec![UNSEEN; grid.len()];
    let mut front = VecDeque::new();
    for (index, previous) in previous.iter_mut().enumerate() {
        if let Some(cost) = travel_cost(index) {
            *previous = index;
            front.push_back((index, cost, 0));
        }
    }
    let mut nearest: Option<(f64, usize)> = None;
    // Costs grow by one from cell to cell, so that each length stays in this order.
    front
        .make_contiguous()
        .sort_by(|a: &(usize, f64, usize), b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    while let Some((at, cost, length)) = front.pop_front() {
        for next in neighbours(grid, at).filter(|next| previous[*next] == UNSEEN) {
            if length > 0 && is_beyond(next) && nearest.is_none_or(|(least, _)| cost < least) {
                nearest = Some((cost, at));
            }
        }
        if length == longest {
            continue;
        }
        for next in neighbours(grid, at) {
            if previous[next] == UNSEEN && may_open(next) {
                previous[next] = at;
                front.push_back((next, cost + 1.0, length + 1));
            }
        }
    }
    nearest.map(|(_, last)| way_back(&previous, last))
}

/// The cells of all regions that hang together by their sides, of at least `least` cells, one of
/// which `is_wanted`.
pub(crate) fn regions(
    grid: &Grid,
    least: usize,
    is_member: impl Fn(usize) -> bool,
    is_wanted: impl Fn(usize) -> bool,
) -> Vec<bool> {
    let mut seen = vec![false; grid.len()];
    let mut large = vec![false; grid.len()];
    for first in 0..grid.len() {
        if seen[first] || !is_member(first) {
            continue;
        }
        seen[first] = true;
        let mut region = vec![first];
        let mut done = 0;
        while let Some(&at) = region.get(done) {
            done += 1;
            for next in neighbours(grid, at) {
                if !seen[next] && is_member(next) {
                    seen[next] = true;
                    region.push(next);
                }
            }
        }
        if region.len() >= least && region.iter().any(|i| is_wanted(*i)) {
            region.into_iter().for_each(|i| large[i] = true);
        }
    }
    large
}

fn neighbours(grid: &Grid, index: usize) -> impl Iterator<Item = usize> {
    let Cell { x, y } = grid.cell(index);
    let grid = *grid;
    [(x, y - 1), (x - 1, y), (x + 1, y), (x, y + 1)]
        .into_iter()
        .filter_map(move |(x, y)| grid.index(Cell::new(x, y)))
}

/// The cells of the passage that ends at `last`, without the one from which it begins.
fn way_back(previous: &[usize], last: usize) -> Vec<usize> {
    let mut way = Vec::new();
    let mut at = last;
    while previous[at] != at {
        way.push(at);
        at = previous[at];
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    /// Of a picture with `r` where the robot can be, `b` beyond, and `?` what may open: the
    /// same with the passage as `o`.
    /// The robot is in the first cell.
    #[track_caller]
    fn check(longest: usize, picture: &str, expected: Option<&str>) {
        let cells: Vec<u8> = picture.bytes().filter(|c| *c != b'\n').collect();
        let width = picture.find('\n').unwrap();
        let grid = Grid::new(Point2::origin(), 0.1, width, cells.len() / width).unwrap();
        let cells = &cells;
        let is = |what: u8| move |i: usize| cells[i] == what;
        let travel_cost = |i: usize| (cells[i] == b'r').then(|| (i % width + i / width) as f64);
        let passage = nearest_passage(&grid, longest, travel_cost, is(b'?'), is(b'b'));
        let drawn = passage.map(|passage| {
            let mut drawn: Vec<u8> = picture.bytes().collect();
            passage.iter().for_each(|i| drawn[i + i / width] = b'o');
            String::from_utf8(drawn).unwrap()
        });
        assert_eq!(drawn.as_deref(), expected);
    }

    #[test]
    fn the_passage_is_the_nearest_that_is_short_enough() {
        let wall = "rr???bb\nrrr??bb\nrrr??bb\nrrrr?bb\n";
        check(3, wall, Some("rrooobb\nrrr??bb\nrrr??bb\nrrrr?bb\n"));
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
