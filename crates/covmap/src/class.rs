//! The class of a true coverage, and the bins beside it.

/// Tolerance of exact coverages: a coverage nearer than this to 0 or to 1 counts as 0 or 1.
const EXACT: f64 = 1e-9;

/// The class of a cell by its true coverage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Coverage 0.
    Free,
    /// A coverage between 0 and 1.
    Partial,
    /// Coverage 1.
    Solid,
}

impl Class {
    /// Returns the class of a true coverage.
    pub fn of(coverage: f64) -> Self {
        match coverage {
            c if c < EXACT => Self::Free,
            c if c > 1.0 - EXACT => Self::Solid,
            _ => Self::Partial,
        }
    }
}

/// Returns the bin below a coverage, and the fraction of the way to the next bin. The fraction
/// divides a coverage between the two bins. The bin is never the last one.
///
/// # Panics
/// Unless there are at least two bins.
pub fn lower_bin(coverage: f64, bins: usize) -> (usize, f64) {
    let place = coverage.clamp(0.0, 1.0) * (bins - 1) as f64;
    #[allow(clippy::cast_possible_truncation, reason = "below 64")]
    let k = (place.floor() as usize).min(bins - 2);
    let t = place - k as f64;
    (k, t)
}
