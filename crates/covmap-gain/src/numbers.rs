//! Conversions of numbers that lose nothing that matters.

use covmap::lanes::LANES;

/// The number of columns on either side of a row that can be read as if they were cells.
pub(crate) const PAD: usize = LANES;

/// Converts a count, exactly below 2⁵³.
pub(crate) fn as_f64(count: usize) -> f64 {
    count as f64
}

/// Converts a number of a table, which is kept as f32 for speed.
pub(crate) fn to_f32(x: f64) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "that is the purpose")]
    let x = x as f32;
    x
}
