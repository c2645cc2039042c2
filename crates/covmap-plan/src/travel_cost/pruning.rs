//! The steps that a shortest way needs to try.

use covmap::opposite;

/// Mask of a cell with eight traversable neighbours, where none of the steps around is an exception.
pub(super) const OPEN: u16 = 0xff;

/// The steps of a set, in order.
pub(super) fn steps_in(mut set: u8) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let step = set.trailing_zeros();
        set &= set.wrapping_sub(1);
        (step < 8).then_some(step as usize)
    })
}

/// The steps of a cell's [`covmap::Steps::masks`] that go on after `step` has led to the cell. Every
/// other step leads to a cell with another way, no longer, past this cell.
///
/// Of all shortest ways, the one with its diagonal steps as early as possible is enough: the
/// pruning of jump point search. After a straight step the same step goes on; if the cell to the left
/// is blocked, no way past this cell leads ahead to the left, so the diagonal step there goes on as
/// well, and likewise to the right. After a diagonal step the same step and its two straight
/// components go on; if the cell behind to the left is blocked, the diagonal step to the left goes on
/// as well, and likewise to the right. Where steps were opened or closed one by one, all steps go on
/// except the step back.
#[inline]
pub(super) fn onward(mask: u16, step: usize) -> u8 {
    let [near, exception] = mask.to_le_bytes();
    if exception != 0 {
        return near & !(1 << opposite(step));
    }
    #[allow(clippy::cast_possible_truncation, reason = "one of eight")]
    let turn = step as u32;
    // Looking along the step, bit 0 is ahead, bit 2 to the left, bit 6 to the right.
    let blocked = !near.rotate_right(turn);
    let ahead = if step % 2 == 1 {
        0b1000_0011 | (blocked >> 3 & 1) << 2 | (blocked >> 5 & 1) << 6
    } else {
        1 | (blocked >> 2 & 1) << 1 | (blocked >> 6 & 1) << 7
    };
    ahead.rotate_left(turn) & near
}
