//! Whether gains are kept.

/// Whether E\[I\] is kept up to date.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Upkeep {
    /// Gains and their bounds are kept until a change makes them stale.
    Kept,
    /// Gains are evaluated anew whenever they are asked for, and have no bounds. This takes less
    /// memory, and less time if few are asked for.
    OnDemand,
}
