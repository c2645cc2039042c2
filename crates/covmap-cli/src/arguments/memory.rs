//! How much memory may be taken.

use super::values::gib;
use clap::Args;

/// How much memory may be taken.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct Memory {
    /// Refuse what would take more memory than this, in GiB: large worlds, fine cells, rings of
    /// thousands of sensors
    #[arg(long, global = true, value_name = "GIB", default_value_t = 4.0, value_parser = gib)]
    pub(crate) memory: f64,
}
