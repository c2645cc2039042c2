//! Messages to the user, a line each: control characters are escaped, and numbers are short.

use clap::error::{ContextKind, ContextValue};
use covmap_io::escaped;
use covmap_lab::files::Remarks;
use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Mutex;

/// The largest number of digits that a user types; counts have at most 20.
const MOST_DIGITS: usize = 20;
/// The first line that could not be written, if any.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints a line; [`finish`] reports failures.
pub fn line(text: impl Display) {
    keep(writeln!(io::stdout(), "{}", tame(text)));
}

/// Prints bytes for another program; [`finish`] tells whether that worked.
pub fn as_it_is(bytes: &[u8]) {
    keep(io::stdout().write_all(bytes));
}

/// Prints the message of clap, and returns the exit code.
pub fn clap(mut told: clap::Error) -> ExitCode {
    let typed = |(kind, value): (ContextKind, &ContextValue)| match value {
        ContextValue::String(text) => Some((kind, ContextValue::String(escaped(text).to_string()))),
        _ => None,
    };
    let typed: Vec<_> = told.context().filter_map(typed).collect();
    for (kind, text) in typed {
        told.insert(kind, text);
    }
    let printed = told.print();
    if !told.use_stderr() {
        keep(printed);
    }
    u8::try_from(told.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}

/// Prints an error, in one sentence.
pub fn error(error: &anyhow::Error) {
    let _ = writeln!(io::stderr(), "error: {}", tame(format_args!("{error:#}")));
}

/// Prints a remark that is not an error.
pub fn note(text: impl Display) {
    let _ = writeln!(io::stderr(), "note: {}", tame(text));
}

/// Prints the remarks about the file of a world.
pub fn remarks(remarks: &Remarks) {
    remarks.warnings.iter().for_each(note);
    remarks.areas.iter().for_each(line);
}

/// Returns whether all lines were written.
///
/// # Errors
/// The error of the first line that was not written.
pub fn finish() -> io::Result<()> {
    keep(io::stdout().flush());
    let failed = FAILED.lock().ok().and_then(|mut failed| failed.take());
    failed.map_or(Ok(()), Err)
}

fn keep(written: io::Result<()>) {
    if let (Err(error), Ok(mut failed)) = (written, FAILED.lock()) {
        failed.get_or_insert(error);
    }
}

/// Returns a text as it is printed.
fn tame(text: impl Display) -> String {
    short_numbers(&escaped(&text).to_string())
}

/// Writes numbers of hundreds of digits with an exponent, which is as exact; otherwise a float is
/// printed with all its zeros.
fn short_numbers(text: &str) -> String {
    let (mut short, mut rest) = (String::new(), text);
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, number) = rest.split_at(start);
        let end = number.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(number.len());
        let number = number[..end].trim_end_matches('.');
        let after = &rest[start + number.len()..];
        // The digits of a name are not a number.
        let named = |c: char| c.is_alphanumeric() || "_/.".contains(c);
        let alone = !before.ends_with(named) && !after.starts_with(char::is_alphanumeric);
        let value =
            if number.len() > MOST_DIGITS && alone { number.parse::<f64>().ok() } else { None };
        short.push_str(before);
        short.push_str(&value.map_or(number.to_owned(), |value| format!("{value:e}")));
        rest = after;
    }
    short + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_names_are_as_they_are() {
        let text = |large: f64, small: f64| {
            format!("(-{large}, {small}; 0.30000000000000004) in out/123456789012345678901234.ron.")
        };
        let short = "(-1e300, 2.5e-30; 0.30000000000000004) in out/123456789012345678901234.ron.";
        assert_eq!(tame(text(1e300, 2.5e-30)), short);
        assert_eq!(tame("18446744073709551615 runs. v1.2\n"), "18446744073709551615 runs. v1.2\\n");
    }
}
