//! The mean of a series of runs, with its confidence interval.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Mean, standard deviation and interval of some numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Number of values.
    pub n: usize,
    /// Mean of the values.
    pub mean: f64,
    /// Standard deviation of the values, with n − 1 in the denominator; `None` for a single value.
    pub deviation: Option<f64>,
    /// The 95 % confidence interval of the mean by Student's t; `None` for a single value.
    pub interval: Option<(f64, f64)>,
}

impl Spread {
    /// Returns the spread of some numbers; `None` for none.
    ///
    /// The numbers are taken as independent, which runs that share a start are not quite.
    pub fn of(values: &[f64]) -> Option<Self> {
        let n = values.len();
        let count = n as f64;
        if n == 0 {
            return None;
        }
        let mean = values.iter().fold(0.0, |sum, value| sum + value) / count;
        let alone = Self { n, mean, deviation: None, interval: None };
        let Ok(student) = StudentsT::new(0.0, 1.0, count - 1.0) else { return Some(alone) };
        let squares = values.iter().fold(0.0, |sum, value| sum + (value - mean) * (value - mean));
        let deviation = (squares / (count - 1.0)).sqrt();
        let half = student.inverse_cdf(0.975) * deviation / count.sqrt();
        Some(Self {
            deviation: Some(deviation),
            interval: Some((mean - half, mean + half)),
            ..alone
        })
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "a mean of small numbers is exact")]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_five_numbers_is_that_of_a_table() {
        // t(4; .975) = 2.776445.
        let spread = Spread::of(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        assert_eq!((spread.n, spread.mean), (5, 3.0));
        let deviation = 2.5f64.sqrt();
        assert!((spread.deviation.unwrap() - deviation).abs() < 1e-12);
        let (low, high) = spread.interval.unwrap();
        let half = 2.776_445 * deviation / 5.0f64.sqrt();
        assert!((low - (3.0 - half)).abs() < 1e-5 && (high - (3.0 + half)).abs() < 1e-5);
    }

    #[test]
    fn one_number_has_no_interval_and_none_has_no_mean() {
        let alone = Spread { n: 1, mean: 7.0, deviation: None, interval: None };
        assert_eq!(Spread::of(&[7.0]), Some(alone));
        assert_eq!(Spread::of(&[]), None);
    }
}
