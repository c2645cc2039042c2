//! The printed table.

use std::fmt::{Display, Formatter, Result};

/// One comparison.
#[derive(Debug)]
pub(crate) struct RatioRow {
    /// The work, and its duration \[s\].
    pub(crate) what: String,
    pub(crate) ours: f64,
    /// The other way, and its duration \[s\].
    pub(crate) against: String,
    pub(crate) other: f64,
    /// The target of the ratio of the other duration to ours.
    pub(crate) target: f64,
}

/// All comparisons, and further notes.
#[derive(Debug, Default)]
pub(crate) struct RatioTable {
    rows: Vec<RatioRow>,
    notes: Vec<String>,
}

impl RatioRow {
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

impl RatioTable {
    pub(crate) fn row(&mut self, row: RatioRow) {
        self.rows.push(row);
    }

    pub(crate) fn note(&mut self, note: String) {
        self.notes.push(note);
    }
}

impl Display for RatioTable {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let head = ["what", "ours", "against", "ratio", "target", ""].map(str::to_owned);
        let lines: Vec<[String; 6]> =
            std::iter::once(head).chain(self.rows.iter().map(RatioRow::cells)).collect();
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

/// Returns a duration for a reader.
pub(crate) fn duration(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-3 => (s * 1e6, "µs"),
        s if s < 1.0 => (s * 1e3, "ms"),
        s => (s, "s"),
    };
    format!("{} {unit}", number(value))
}

/// Returns a number with three digits, or with all digits before the point.
fn number(value: f64) -> String {
    let digits = match value {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.digits$}")
}
