//! Numbers in sentences.

/// Numbers up to this length are written digit by digit.
const LONGEST: usize = 12;

/// Formats a number for a sentence, such as an error message: with all of its digits, and with an
/// exponent where zeros would fill the line.
#[must_use]
pub fn short(number: &f64) -> String {
    let (plain, exponent) = (number.to_string(), format!("{number:e}"));
    if plain.len() <= LONGEST.max(exponent.len()) { plain } else { exponent }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_short_and_exact() {
        assert_eq!(short(&0.1), "0.1");
        assert_eq!(short(&-12.0), "-12");
        assert_eq!(short(&(0.1 + 0.2)), "0.30000000000000004");
        assert_eq!(short(&1e-12), "1e-12");
        assert_eq!(short(&1e300), "1e300");
        assert_eq!(short(&-2.5e-200), "-2.5e-200");
        assert_eq!(short(&f64::NAN), "NaN");
        assert_eq!(short(&f64::INFINITY), "inf");
    }
}
