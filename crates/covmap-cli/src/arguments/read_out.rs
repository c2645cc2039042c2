//! The read-out of the map.

use clap::Args;
use covmap_lab::{LabError, Reader};
use std::path::{Path, PathBuf};

/// The file of a read-out.
#[derive(Debug, Clone, Args)]
pub(crate) struct ReadOutFile {
    /// Read the map through the read-out that `fit` wrote as read_out.ron: coverage.png,
    /// entropy.png, map.pgm and all scores then show the calibrated posteriors. belief.bin and the
    /// planner's belief stay as they are [default: no read-out]
    #[arg(long, value_name = "FILE")]
    pub(crate) read_out: Option<PathBuf>,
}

impl ReadOutFile {
    /// Reads and checks the file, for maps with a number of bins.
    pub(crate) fn load(&self, bins: usize) -> Result<Reader, LabError> {
        Reader::load(self.read_out.as_deref(), bins)
    }

    /// Returns the path of the file, if any.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.read_out.as_deref()
    }
}
