//! The meaning of a reading to the model.

/// Meaning of a reading to the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// An echo from this range \[m\], within the usable range.
    Echo(f64),
    /// An echo from this range \[m\], beyond the usable range: free space before it.
    Beyond(f64),
    /// No echo: perhaps free space, perhaps a wall that does not answer.
    NoEcho,
}
