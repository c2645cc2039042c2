//! Errors that name their file.

use anyhow::{Error, anyhow};
use std::fmt::Display;
use std::path::Path;

/// Returns an error about a file, in one sentence that names it.
pub(crate) fn about<E: Display>(path: &Path) -> impl Fn(E) -> Error {
    move |error| anyhow!("{}: {error}", path.display())
}
