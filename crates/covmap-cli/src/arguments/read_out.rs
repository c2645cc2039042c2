//! How the map is read.

use crate::input::about;
use anyhow::Result;
use clap::Args;
use covmap::{CoverageMap, ReadOut, ReadOutError};
use covmap_io::read_ron;
use std::borrow::Cow;
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

/// How a map is read.
#[derive(Debug, Clone, Default)]
pub(crate) struct Reader {
    read_out: Option<ReadOut>,
    /// The file, as it was typed.
    pub(crate) file: Option<PathBuf>,
}

impl ReadOutFile {
    /// Reads and checks the file, for maps with a number of bins.
    pub(crate) fn load(&self, bins: usize) -> Result<Reader> {
        let Some(file) = &self.read_out else { return Ok(Reader::default()) };
        let read_out: ReadOut = read_ron(file)?;
        if read_out.bins() != bins {
            return Err(about(file)(ReadOutError::OtherBins { bins: read_out.bins(), map: bins }));
        }
        Ok(Reader { read_out: Some(read_out), file: Some(file.clone()) })
    }

    /// The file, if there is one.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.read_out.as_deref()
    }
}

impl Reader {
    /// The map as it is read.
    pub(crate) fn read<'a>(&self, map: &'a CoverageMap) -> Result<Cow<'a, CoverageMap>> {
        Ok(match &self.read_out {
            None => Cow::Borrowed(map),
            Some(read_out) => Cow::Owned(map.read_by(read_out)?),
        })
    }

    /// The file in the words of a picture or of a report; nothing without one.
    pub(crate) fn in_words(&self) -> String {
        self.file.as_ref().map_or_else(String::new, |file| {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            format!(", read through {name}")
        })
    }
}
