//! Lengths of ways as whole numbers.
//!
//! A way of a straight and b diagonal steps has the length a + b·√2. As a whole number it is
//! a·P + b·Q with Q/P a convergent of √2. Two different ways of less than P steps differ by
//! at least 1/(2.83·P) cells in length, and Q/P is nearer to √2 than 1/(2.83·P²), so whole
//! numbers compare as lengths do: only equal lengths are equal numbers. P exceeds the number of
//! cells of the largest grid.

/// The length of the shortest way known so far, in multiples of 256; the low eight bits are the set of
/// steps that ways of this length end with.
pub(super) type Label = u64;

/// No way is known.
pub(super) const UNREACHED: Label = Label::MAX;

const P: u64 = 93_222_358;
const Q: u64 = 131_836_323;

/// The length of a straight step.
pub(super) const STRAIGHT: Label = P << 8;
/// The length of a diagonal step.
pub(super) const DIAGONAL: Label = Q << 8;

/// The length of one of [`covmap::STEPS`].
pub(super) fn of_step(step: usize) -> Label {
    if step.is_multiple_of(2) { STRAIGHT } else { DIAGONAL }
}

/// Offers a cell a way of some length that ends with a step. Returns whether the way is shorter than
/// the known ones, or as short and new.
#[inline]
pub(super) fn improve(label: &mut Label, length: Label, step: usize) -> bool {
    let bit = 1 << step;
    if length > *label {
        return false;
    }
    if length ^ *label < 256 {
        let is_new = *label & bit == 0;
        *label |= bit;
        return is_new;
    }
    *label = length | bit;
    true
}

/// The length of a label alone, as a whole number.
pub(super) fn length(label: Label) -> u64 {
    label >> 8
}

/// Whether the length of a label is the length of another label plus that of a step.
pub(super) fn is_sum(label: Label, before: Label, step: Label) -> bool {
    before != UNREACHED && length(label) == length(before + step)
}

/// The length of a label in sides of cells, correctly rounded; `None` where no way leads.
pub(super) fn in_cells(label: Label) -> Option<f64> {
    let in_cells = |label: Label| length(label) as f64 / P as f64;
    (label != UNREACHED).then(|| in_cells(label))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_lengths_compare_as_lengths_do() {
        assert_eq!(2 * P * P + 1, Q * Q);
        assert!(P > 4 * covmap::MAX_CELLS as u64);
        assert!((covmap::MAX_CELLS as u64) * Q < 1 << 53);
    }
}
