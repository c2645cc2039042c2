//! The limit on memory.

use super::values::gib;
use clap::Args;

/// The limit on memory.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct Memory {
    /// Memory limit in GiB: tasks that would take more are refused, such as large worlds, fine
    /// cells, or rings of thousands of sensors
    #[arg(long, global = true, value_name = "GIB", default_value_t = 4.0, value_parser = gib)]
    pub(crate) memory: f64,
}
