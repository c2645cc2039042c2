//! The reader of a map: as it is, or through a read-out.

use crate::error::{Result, about};
use covmap::{CoverageMap, ReadOut, ReadOutError};
use covmap_io::read_ron;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Reader of a map: as it is, or through the read-out in a file.
#[derive(Debug, Clone, Default)]
pub struct Reader {
    read_out: Option<ReadOut>,
    /// The file of the read-out, as the user typed it.
    pub file: Option<PathBuf>,
}

impl Reader {
    /// Reads and checks a file, for maps with a number of bins; without a file, maps are read as they are.
    ///
    /// # Errors
    /// If the file cannot be read, or is for maps with another number of bins.
    pub fn load(file: Option<&Path>, bins: usize) -> Result<Self> {
        let Some(file) = file else { return Ok(Self::default()) };
        let read_out: ReadOut = read_ron(file)?;
        if read_out.bins() != bins {
            return Err(about(file)(ReadOutError::OtherBins { bins: read_out.bins(), map: bins }));
        }
        Ok(Self { read_out: Some(read_out), file: Some(file.to_owned()) })
    }

    /// Returns the map as it is read.
    ///
    /// # Errors
    /// If the read-out is for maps with another number of bins.
    pub fn read<'a>(&self, map: &'a CoverageMap) -> Result<Cow<'a, CoverageMap>> {
        Ok(match &self.read_out {
            None => Cow::Borrowed(map),
            Some(read_out) => Cow::Owned(map.read_by(read_out)?),
        })
    }

    /// Returns the file in words for a picture or a report; empty without a file.
    pub fn in_words(&self) -> String {
        self.file.as_ref().map_or_else(String::new, |file| {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            format!(", read through {name}")
        })
    }
}
