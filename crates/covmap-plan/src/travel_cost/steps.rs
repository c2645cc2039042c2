//! The eight steps between cells, which of them are allowed, and which of them a shortest way
//! needs to try.

use covmap::Grid;

/// The steps `(dx, dy)`, counter-clockwise from the right: even ones are straight, odd ones
/// diagonal. A set of steps is a byte with a bit for each.
pub(super) const STEPS: [(i32, i32); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

const STRAIGHT: u8 = 0b0101_0101;

/// The steps of a set, in order.
pub(super) fn steps_in(mut set: u8) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let step = set.trailing_zeros();
        set &= set.wrapping_sub(1);
        (step < 8).then_some(step as usize)
    })
}

/// The steps that are allowed in a cell whose traversable neighbours are `near`: no corner is
/// cut, so a diagonal one needs both cells beside it.
#[inline]
pub(super) fn allowed(near: u8) -> u8 {
    near & (STRAIGHT | near.rotate_left(1) & near.rotate_right(1))
}

/// The steps that go on from a cell which `step` has led to; the others lead to cells that
/// have another way, no longer, past this cell.
///
/// Of all shortest ways the one with its diagonal steps as early as possible is enough: the
/// pruning of jump point search. After a diagonal step those are the same step and the two
/// straight ones that it is made of. After a straight step it is the same step; where the
/// cell behind to the left is blocked, no diagonal step leads past this cell to the left, so
/// that the steps left and ahead left go on as well, and likewise to the right.
#[inline]
pub(super) fn onward(near: u8, step: usize) -> u8 {
    #[allow(clippy::cast_possible_truncation, reason = "one of eight")]
    let turn = step as u32;
    let ahead = if step % 2 == 1 {
        0b1000_0011
    } else {
        // As seen when looking to the right: bit 3 is behind to the left, bit 5 to the right.
        let blocked = !near.rotate_right(turn);
        1 | (((blocked >> 3) & 1) * 0b0000_0110) | (((blocked >> 5) & 1) * 0b1100_0000)
    };
    ahead.rotate_left(turn) & allowed(near)
}

/// For each cell of a grid the set of steps that lead to a traversable cell.
pub(super) fn neighbourhoods(grid: &Grid, traversable: impl Fn(usize) -> bool) -> Vec<u8> {
    let (width, bordered) = (grid.width(), grid.width() + 2);
    let mut free = vec![0u8; bordered * (grid.height() + 2)];
    let rows = free.chunks_exact_mut(bordered).skip(1).take(grid.height());
    for (y, row) in rows.enumerate() {
        for (x, free) in row[1..=width].iter_mut().enumerate() {
            *free = u8::from(traversable(y * width + x));
        }
    }
    let mut near = vec![0u8; grid.len()];
    for (y, near) in near.chunks_exact_mut(width).enumerate() {
        let row = |dy: usize| &free[(y + dy) * bordered..(y + dy + 1) * bordered];
        let three = |dy: usize| [0, 1, 2].map(|dx| &row(dy)[dx..dx + width]);
        let (below, beside, above) = (three(0), three(1), three(2));
        for (x, near) in near.iter_mut().enumerate() {
            *near = beside[2][x]
                | above[2][x] << 1
                | above[1][x] << 2
                | above[0][x] << 3
                | beside[0][x] << 4
                | below[0][x] << 5
                | below[1][x] << 6
                | below[2][x] << 7;
        }
    }
    near
}
