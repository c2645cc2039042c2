//! Numbers in sentences.

/// The longest number that is written digit by digit.
const LONGEST: usize = 20;

/// A number for a sentence, such as that of an error: with all of its digits, and with an exponent
/// where zeros would fill the line.
#[must_use]
pub fn short(number: &f64) -> String {
    let plain = number.to_string();
    if plain.len() <= LONGEST { plain } else { format!("{number:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_short_and_exact() {
        assert_eq!(short(&0.1), "0.1");
        assert_eq!(short(&-12.0), "-12");
        assert_eq!(short(&1e300), "1e300");
        assert_eq!(short(&-2.5e-200), "-2.5e-200");
        assert_eq!(short(&f64::NAN), "NaN");
        assert_eq!(short(&f64::INFINITY), "inf");
    }
}
