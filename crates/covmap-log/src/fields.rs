//! The fields of a line.

use super::SkipReason;
use super::skipped::Damage;
use nalgebra::{Isometry2, Vector2};
use std::fmt::Display;

/// The largest distance of a robot from the origin \[m\].
const FARTHEST: f64 = 1e7;
/// The latest time of a clock \[s\].
const LATEST: f64 = 1e13;

/// A range as written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Written {
    /// The value \[m\].
    pub(super) value: f64,
    /// The worth of one unit in the last decimal place \[m\]; 0 if unknown.
    pub(super) place: f64,
}

/// The words of a line, taken one after the other.
pub(super) struct Fields<'a> {
    words: Vec<&'a str>,
    next: usize,
}

impl<'a> Fields<'a> {
    pub(super) fn new(line: &'a str) -> Self {
        Self { words: line.split_ascii_whitespace().collect(), next: 0 }
    }

    /// Returns the number of words left.
    pub(super) fn left(&self) -> usize {
        self.words.len() - self.next
    }

    /// Returns whether the line ends as CARMEN ends its lines: with a host that is not a number,
    /// and a time.
    pub(super) fn ends_with_host_and_time(&self) -> bool {
        let number = |word: &&str| word.parse::<f64>().is_ok();
        matches!(self.words[self.next..], [.., host, time] if !number(&host) && number(&time))
    }

    /// Returns whether the line ends in a number.
    pub(super) fn ends_with_number(&self) -> bool {
        self.words.last().is_some_and(|word| word.parse::<f64>().is_ok())
    }

    pub(super) fn word(&mut self, field: impl Display) -> Result<&'a str, Damage> {
        let word = self.words.get(self.next).copied();
        self.skip(1);
        word.ok_or_else(|| unreadable(field, "is missing; the line is cut short"))
    }

    /// Reads any number, also NaN.
    fn any_number(&mut self, field: impl Display + Copy) -> Result<f64, Damage> {
        let word = self.word(field)?;
        word.parse().map_err(|_| unreadable(field, &format!("`{}` is not a number", short(word))))
    }

    /// Reads a number whose absolute value is at most `most`.
    fn number_up_to(&mut self, field: impl Display + Copy, most: f64) -> Result<f64, Damage> {
        let value = self.any_number(field)?;
        let good = (-most..=most).contains(&value);
        good.then_some(value).ok_or_else(|| unreadable(field, &format!("{value} is out of range")))
    }

    pub(super) fn number(&mut self, field: impl Display + Copy) -> Result<f64, Damage> {
        self.number_up_to(field, FARTHEST)
    }

    /// Reads a number, if the next word is one.
    pub(super) fn number_if_any(&mut self) -> Option<f64> {
        self.number_up_to("", LATEST).ok()
    }

    /// Reads a time in units; `per_second` of them make a second.
    pub(super) fn time(&mut self, field: &str, per_second: f64) -> Result<f64, Damage> {
        Ok(self.number_up_to(field, LATEST)? / per_second)
    }

    pub(super) fn count(&mut self, field: &str) -> Result<usize, Damage> {
        let word = self.word(field)?;
        word.parse().map_err(|_| unreadable(field, &format!("`{}` is not a count", short(word))))
    }

    /// Reads a pose from three fields, given the number of their units in a metre and in a radian.
    pub(super) fn pose(
        &mut self,
        fields: [&str; 3],
        per_metre: f64,
        per_radian: f64,
    ) -> Result<Isometry2<f64>, Damage> {
        let [x, y, theta] = fields;
        let place = Vector2::new(self.number(x)?, self.number(y)?) / per_metre;
        Ok(Isometry2::new(place, self.number(theta)? / per_radian))
    }

    /// Reads `count` ranges in units; `per_metre` of them make a metre. NaN and infinity are allowed.
    pub(super) fn ranges(&mut self, count: usize, per_metre: f64) -> Result<Vec<Written>, Damage> {
        let range = |i, fields: &mut Self| {
            let word = fields.words.get(fields.next).copied().unwrap_or_default();
            let value = fields.any_number(format_args!("range {i}"))? / per_metre;
            Ok(Written { value, place: last_place(word) / per_metre })
        };
        (0..count.min(self.left())).map(|i| range(i, self)).collect()
    }

    /// Skips some words.
    pub(super) fn skip(&mut self, count: usize) {
        self.next = self.next.saturating_add(count).min(self.words.len());
    }
}

/// Returns the worth of one unit in the last decimal place of a number: 0.01 for `10.70`.
fn last_place(word: &str) -> f64 {
    if word.contains(['e', 'E', 'n', 'N']) {
        return 0.0;
    }
    let decimals = word.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    (0..decimals.min(17)).fold(1.0, |place, _| place / 10.0)
}

fn unreadable(field: impl Display, fault: &str) -> Damage {
    Damage::new(SkipReason::Unreadable, format!("{field}: {fault}"))
}

/// Returns a word, or its beginning.
fn short(word: &str) -> String {
    word.chars().take(20).collect()
}
