//! Foreign names and texts as part of one line.

use std::fmt::{self, Display, Write as _};
use std::path::Path;

/// Shows a text on one line, in which no character controls the terminal: control characters, line
/// separators, and characters that change the direction of the text become `\u{1b}` and the like.
///
/// ```
/// assert_eq!(covmap_io::escaped("a\u{1b}[31m\nb").to_string(), r"a\u{1b}[31m\nb");
/// ```
pub fn escaped(text: &(impl Display + ?Sized)) -> impl Display {
    fmt::from_fn(move |f| write!(Escaping(f), "{text}"))
}

/// Shows a path on one line, as [`escaped`] does.
pub fn shown(path: &(impl AsRef<Path> + ?Sized)) -> impl Display {
    let path = path.as_ref();
    fmt::from_fn(move |f| write!(Escaping(f), "{}", path.display()))
}

/// Writer that escapes all text written through it.
struct Escaping<'a, 'b>(&'a mut fmt::Formatter<'b>);

impl fmt::Write for Escaping<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for part in text.split_inclusive(rules) {
            let mut chars = part.chars();
            match chars.next_back() {
                Some(last) if rules(last) => {
                    self.0.write_str(chars.as_str())?;
                    write!(self.0, "{}", last.escape_default())?;
                }
                _ => self.0.write_str(part)?,
            }
        }
        Ok(())
    }
}

/// Returns whether a character has any effect beyond its own glyph.
fn rules(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}')
        || matches!(c, '\u{2066}'..='\u{2069}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rules_the_terminal_is_escaped_and_all_else_is_not() {
        let wild = "a\u{1b}[31m\r\n\t\0\u{7f}\u{9b}\u{202e}\u{2028}é–🦀 b";
        let tame = r"a\u{1b}[31m\r\n\t\u{0}\u{7f}\u{9b}\u{202e}\u{2028}é–🦀 b";
        assert_eq!(escaped(&wild).to_string(), tame);
        assert_eq!(escaped(&tame).to_string(), tame, "escaped twice is escaped once");
        assert_eq!(shown("out/a\nb.ron").to_string(), r"out/a\nb.ron");
    }
}
