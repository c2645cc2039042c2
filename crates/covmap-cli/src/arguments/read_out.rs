//! How the map is read.

use clap::Args;
use covmap_lab::{LabError, Reader};
use std::path::{Path, PathBuf};

/// The file of a read-out.
#[derive(Debug, Clone, Args)]
pub(crate) struct ReadOutFile {
    /// Read the map through the read-out that `fit` wrote as read_out.ron: coverage.png,
    /// entropy.png, map.pgm and all scores are of the calibrated posteriors. belief.bin, and what
    /// the planner believes, stay as they are [default: as the map has it]
    #[arg(long, value_name = "FILE")]
    pub(crate) read_out: Option<PathBuf>,
}

impl ReadOutFile {
    /// Reads and checks the file, for maps with a number of bins.
    pub(crate) fn load(&self, bins: usize) -> Result<Reader, LabError> {
        Reader::load(self.read_out.as_deref(), bins)
    }

    /// The file, if there is one.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.read_out.as_deref()
    }
}
