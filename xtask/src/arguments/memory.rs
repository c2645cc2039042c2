//! How much memory may be taken.

use clap::Args;

/// How much memory may be taken.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct Memory {
    /// Refuse what would take more memory than this, in GiB: large worlds, fine cells, rings of
    /// thousands of sensors
    #[arg(long, global = true, value_name = "GIB", default_value_t = 4.0, value_parser = gib)]
    pub(crate) memory: f64,
}

fn gib(text: &str) -> Result<f64, String> {
    let gib = text.parse().ok().filter(|gib| (0.01..=1e6).contains(gib));
    gib.ok_or_else(|| "it must be a number from 0.01 to 1000000, in GiB".to_owned())
}
