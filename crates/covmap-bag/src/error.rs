//! Errors of bags.

use std::io;
use std::path::PathBuf;

/// Why a bag cannot be read or written: one sentence that names the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BagError {
    /// The operating system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// Not even the beginning of the file is that of MCAP.
    #[error("{}: is not an MCAP recording: {fault}", path.display())]
    NoBag {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: String,
    },
    /// A type whose definition is not known.
    #[error("messages of type {0} cannot be written: their definition is not known")]
    Type(&'static str),
    /// The bag cannot be written.
    #[error("the bag cannot be written: {0}")]
    Write(String),
}
