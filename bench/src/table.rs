//! The table that is printed.

use std::fmt::{Display, Formatter, Result};

/// One comparison.
#[derive(Debug)]
pub(crate) struct Row {
    /// What was done, how long it took \[s\].
    pub(crate) what: String,
    pub(crate) ours: f64,
    /// What it is compared with, how long that took \[s\].
    pub(crate) against: String,
    pub(crate) other: f64,
    /// How many times as long the other should take.
    pub(crate) target: f64,
}

/// All comparisons, and what else is to be said.
#[derive(Debug, Default)]
pub(crate) struct Table {
    rows: Vec<Row>,
    notes: Vec<String>,
}

impl Row {
    fn ratio(&self) -> f64 {
        self.other / self.ours
    }

    fn cells(&self) -> [String; 6] {
        let verdict = if self.ratio() < self.target { "falls short" } else { "" };
        [
            self.what.clone(),
            duration(self.ours),
            format!("{}: {}", self.against, duration(self.other)),
            format!("{} ×", number(self.ratio())),
            format!("{} ×", number(self.target)),
            verdict.to_owned(),
        ]
    }
}

impl Table {
    pub(crate) fn row(&mut self, row: Row) {
        self.rows.push(row);
    }

    pub(crate) fn note(&mut self, note: String) {
        self.notes.push(note);
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let head = ["what", "ours", "against", "ratio", "target", ""].map(str::to_owned);
        let lines: Vec<[String; 6]> =
            std::iter::once(head).chain(self.rows.iter().map(Row::cells)).collect();
        let length = |text: &String| text.chars().count();
        let width = |i: usize| lines.iter().map(|line| length(&line[i])).max().unwrap_or(0);
        let widths: [usize; 6] = std::array::from_fn(width);
        for (number, line) in lines.iter().enumerate() {
            let cells = line.iter().zip(widths).map(|(text, width)| format!(" {text:width$} "));
            writeln!(f, "|{}|", cells.collect::<Vec<_>>().join("|"))?;
            if number == 0 {
                let rules = widths.map(|width| "-".repeat(width + 2));
                writeln!(f, "|{}|", rules.join("|"))?;
            }
        }
        self.notes.iter().try_for_each(|note| write!(f, "\n{note}"))
    }
}

/// A duration as one reads it.
pub(crate) fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-3 => (s * 1e6, "µs"),
        s if s < 1.0 => (s * 1e3, "ms"),
        s => (s, "s"),
    };
    format!("{} {unit}", number(value))
}

/// Three digits, or all before the point.
fn number(value: f64) -> String {
    let digits = match value {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.digits$}")
}
