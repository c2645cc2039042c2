//! Words to the user.

use std::fmt::Display;
use std::io::Write;

/// Prints a line; whoever closed the pipe does not want to read it.
pub(crate) fn line(text: impl Display) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints what went wrong, in one sentence.
pub(crate) fn error(error: &anyhow::Error) {
    let _ = writeln!(std::io::stderr(), "error: {error:#}");
}

/// Prints something to know that is no error.
pub(crate) fn note(text: impl Display) {
    let _ = writeln!(std::io::stderr(), "note: {text}");
}
