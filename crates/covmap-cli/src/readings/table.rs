//! The frequencies of right, short, long and missing readings, by true distance.

use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_sonar::Range;

/// A reading this near to the truth is right \[m\].
const RIGHT: f64 = 0.15;
/// The ends of the rows' true distances \[m\]; readings of farther objects are not counted.
const ENDS: [f64; 6] = [0.5, 1.0, 2.0, 3.0, 4.0, 5.0];

/// The kinds of readings.
const KINDS: [&str; 4] = ["right", "short", "long", "no echo"];

/// The numbers of readings of each kind, by true distance.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct KindTable {
    counts: [[u32; KINDS.len()]; ENDS.len()],
}

impl FromIterator<(f64, Range)> for KindTable {
    fn from_iter<I: IntoIterator<Item = (f64, Range)>>(readings: I) -> Self {
        let mut table = Self::default();
        for (truth, range) in readings {
            let Some(row) = ENDS.iter().position(|end| truth < *end) else { continue };
            let kind = match range {
                Range::Echo(range) if (range - truth).abs() <= RIGHT => 0,
                Range::Echo(range) if range < truth => 1,
                Range::Echo(_) => 2,
                Range::NoEcho => 3,
                Range::Missing => continue,
            };
            table.counts[row][kind] += 1;
        }
        table
    }
}

impl KindTable {
    /// The columns of [`KindTable::lines`].
    pub(super) const HEADING: &str = "to_m,readings,right,short,long,no_echo";

    /// Returns the number of readings.
    pub(super) fn count(&self) -> u32 {
        self.counts.iter().flatten().sum()
    }

    /// Returns the shares of the kinds in a row, if it has readings.
    fn shares(&self, row: usize) -> Option<[f64; KINDS.len()]> {
        let total: u32 = self.counts[row].iter().sum();
        (total > 0).then(|| self.counts[row].map(|n| f64::from(n) / f64::from(total)))
    }

    /// Returns a line for each true distance.
    pub(super) fn lines(&self, separator: &str) -> Vec<String> {
        let line = |(row, end): (usize, &f64)| {
            let shares = self.shares(row)?.map(|share| format!("{share:.3}"));
            let total: u32 = self.counts[row].iter().sum();
            Some(format!("{end}{separator}{total}{separator}{}", shares.join(separator)))
        };
        ENDS.iter().enumerate().filter_map(line).collect()
    }

    /// Returns the mean log-likelihood of these readings' kinds under the frequencies of another
    /// table \[nats\]. Half a reading is added to each kind of the other table, and no kind is
    /// impossible.
    pub(super) fn log_likelihood_under(&self, model: &KindTable) -> f64 {
        let mut sum = 0.0;
        for (counts, expected) in self.counts.iter().zip(&model.counts) {
            let expected = expected.map(|n| f64::from(n) + 0.5);
            let total: f64 = expected.iter().sum();
            let kinds = counts.iter().zip(&expected);
            sum += kinds.map(|(n, e)| f64::from(*n) * (e / total).ln()).sum::<f64>();
        }
        sum / f64::from(self.count().max(1))
    }
}

/// Returns a panel for each kind.
pub(super) fn figure(rows: &[(&str, KindTable)]) -> Figure {
    let middle = |row: usize| 0.5 * (ENDS[row] + if row == 0 { 0.0 } else { ENDS[row - 1] });
    let panel = |(kind, name): (usize, &&str)| {
        let series = |(source, table): &(&str, KindTable)| {
            let point = |row| Some(ChartPoint::new(middle(row), table.shares(row)?[kind]));
            let points = (0..ENDS.len()).filter_map(point).collect();
            Series { name: (*source).to_owned(), points, line: true, marks: true }
        };
        Chart {
            title: (*name).to_owned(),
            subtitle: String::new(),
            x: ChartAxis::new("true distance [m]"),
            y: ChartAxis {
                from: Some(0.0),
                to: Some(1.0),
                ..ChartAxis::new("share of the readings")
            },
            series: rows.iter().map(series).collect(),
        }
    };
    Figure {
        title: "Readings of sonars, by true distance".into(),
        subtitle:
            "right: within 0.15 m; true distance: the nearest laser echo within 7.5° of the axis"
                .into(),
        panels: KINDS.iter().enumerate().map(panel).map(Into::into).collect(),
        columns: 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(readings: &[(f64, Range)]) -> KindTable {
        readings.iter().copied().collect()
    }

    #[test]
    fn a_reading_is_right_within_15_centimetres() {
        let readings = [
            (1.5, Range::Echo(1.62)),
            (1.5, Range::Echo(1.1)),
            (1.5, Range::Echo(3.0)),
            (1.5, Range::NoEcho),
            (1.5, Range::Missing),
            (7.0, Range::Echo(7.0)),
        ];
        let table = table(&readings);
        assert_eq!(table.lines(","), ["2,4,0.250,0.250,0.250,0.250"]);
        assert_eq!(table.count(), 4);
    }

    #[test]
    fn nothing_explains_readings_better_than_their_own_frequencies() {
        let real = table(&[(0.7, Range::Echo(0.7)), (0.7, Range::Echo(0.7)), (0.7, Range::NoEcho)]);
        let wrong = table(&[(0.7, Range::Echo(0.7)), (0.7, Range::NoEcho), (0.7, Range::NoEcho)]);
        let own = real.log_likelihood_under(&real);
        assert!(own > real.log_likelihood_under(&wrong));
        assert!(own > real.log_likelihood_under(&KindTable::default()));
    }
}
