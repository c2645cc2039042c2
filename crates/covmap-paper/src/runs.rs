//! The runs of one setting of a campaign, paired by start and seed.

use covmap_campaign::{Campaign, RunRecord, Value};
use covmap_plan::Strategy;
use covmap_statistics::{Estimate, Grouped, bootstrap};
use std::collections::BTreeMap;

/// The number of resamples of starts, and their seed.
const RESAMPLES: usize = 2000;
const SEED: u64 = 2003;

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedRun {
    pub world: String,
    pub strategy: Strategy,
    pub start: usize,
    pub seed: u64,
    pub values: BTreeMap<String, f64>,
    /// Whether the run ended before its world was explored.
    pub cut_short: bool,
}

/// Runs with the same configuration and the same way of measuring.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Runs {
    /// The runs, in the order of the campaign.
    pub runs: Vec<RecordedRun>,
}

/// The units of a paired comparison.
///
/// A unit is one start and seed with several strategies, in their order. Units are grouped by
/// start.
#[derive(Debug, Clone, Default)]
pub struct Units(pub(crate) Grouped<Vec<f64>>);

impl RecordedRun {
    /// Returns a number of the run; NaN if the run has none of this name.
    pub fn value(&self, metric: &str) -> f64 {
        self.values.get(metric).copied().unwrap_or(f64::NAN)
    }
}

impl Runs {
    /// Returns the runs of a campaign's setting, from its records.
    pub fn of(campaign: &Campaign, setting: &str, records: &[RunRecord]) -> Self {
        let own = campaign.settings.iter().filter_map(|s| s.strategies.as_ref()).flatten();
        let names: BTreeMap<String, Strategy> =
            campaign.strategies.iter().chain(own).map(|s| (s.to_string(), *s)).collect();
        let run = |record: &RunRecord| {
            let key = &record.key;
            let number = |(name, value): (&String, &Value)| match value {
                Value::Number(number) => Some((name.clone(), *number)),
                Value::Text(_) => None,
            };
            let mut values: BTreeMap<String, f64> =
                record.values.iter().filter_map(number).collect();
            values.extend(record.times.iter().map(|(name, time)| (name.clone(), *time)));
            let strategy = *names.get(&key.strategy)?;
            let (world, start, seed) = (key.world.clone(), key.start, key.seed);
            let cut_short = record.is_cut_short();
            Some(RecordedRun { world, strategy, start, seed, values, cut_short })
        };
        let mine = records.iter().filter(|record| record.key.setting == setting);
        Self { runs: mine.filter_map(run).collect() }
    }

    /// Returns the worlds, in the order of the campaign.
    pub fn worlds(&self) -> Vec<String> {
        let mut worlds: Vec<String> = Vec::new();
        for run in &self.runs {
            if !worlds.contains(&run.world) {
                worlds.push(run.world.clone());
            }
        }
        worlds
    }

    /// Returns the runs in one world.
    pub fn in_world(&self, world: &str) -> Self {
        Self { runs: self.runs.iter().filter(|run| run.world == world).cloned().collect() }
    }

    /// Returns the strategies, in the order of the campaign.
    pub fn strategies(&self) -> Vec<Strategy> {
        let mut strategies: Vec<Strategy> = Vec::new();
        for run in &self.runs {
            if !strategies.contains(&run.strategy) {
                strategies.push(run.strategy);
            }
        }
        strategies
    }

    /// Returns the runs of one strategy.
    pub fn with(&self, strategy: Strategy) -> impl Iterator<Item = &RecordedRun> {
        self.runs.iter().filter(move |run| run.strategy == strategy)
    }

    /// Returns the number of runs of one strategy that ended before their world was explored.
    pub fn cut_short(&self, strategy: Strategy) -> usize {
        self.with(strategy).filter(|run| run.cut_short).count()
    }

    /// Returns this number in words, out of all runs of the strategy.
    pub fn cut_short_of(&self, strategy: Strategy) -> String {
        format!("{} of {}", self.cut_short(strategy), self.with(strategy).count())
    }

    /// Returns the numbers of a metric for one strategy.
    pub fn values(&self, strategy: Strategy, metric: &str) -> Vec<f64> {
        self.with(strategy).map(|run| run.value(metric)).filter(|v| v.is_finite()).collect()
    }

    /// Returns a metric of several strategies, by unit; units that lack a strategy are left out.
    pub fn paired(&self, strategies: &[Strategy], metric: &str) -> Units {
        self.paired_by(strategies, |run| run.value(metric))
    }

    /// Returns a number of the runs of several strategies, by unit.
    pub fn paired_by(&self, strategies: &[Strategy], of: impl Fn(&RecordedRun) -> f64) -> Units {
        let mut units: BTreeMap<(usize, &str, u64), Vec<Option<f64>>> = BTreeMap::new();
        for run in &self.runs {
            for (place, _) in strategies.iter().enumerate().filter(|(_, s)| **s == run.strategy) {
                let unit = units.entry((run.start, &run.world, run.seed));
                let unit = unit.or_insert_with(|| vec![None; strategies.len()]);
                unit[place] = Some(of(run)).filter(|value| value.is_finite());
            }
        }
        let mut groups: BTreeMap<usize, Vec<Vec<f64>>> = BTreeMap::new();
        for ((start, ..), values) in units {
            if let Some(values) = values.into_iter().collect::<Option<Vec<f64>>>() {
                groups.entry(start).or_default().push(values);
            }
        }
        Units(groups.into_values().collect())
    }
}

impl Units {
    /// Returns one number for each unit, computed from its numbers.
    pub fn each(&self, of: impl Fn(&[f64]) -> f64) -> Self {
        let group = |units: &Vec<Vec<f64>>| units.iter().map(|unit| vec![of(unit)]).collect();
        Self(self.0.iter().map(group).collect())
    }

    /// Returns a statistic of the units with its error, by resampling starts.
    pub fn estimate(&self, statistic: impl Fn(&[&Vec<f64>]) -> Option<f64>) -> Option<Estimate> {
        bootstrap(
            &self.0,
            RESAMPLES,
            SEED,
            |units| {
                if units.is_empty() { None } else { statistic(units) }
            },
        )
    }

    /// Returns the mean of the strategy at index `place`.
    pub fn mean(&self, place: usize) -> Option<Estimate> {
        self.estimate(|units| Some(mean(units, place)))
    }

    /// Returns the ratio of two means, the one at index `a` over the one at `b`.
    pub fn ratio(&self, a: usize, b: usize) -> Option<Estimate> {
        self.estimate(|units| Some(mean(units, a) / mean(units, b)))
    }

    /// Returns the mean paired difference, the value at index `a` less the one at `b`.
    pub fn difference(&self, a: usize, b: usize) -> Option<Estimate> {
        self.estimate(|units| Some(mean(units, a) - mean(units, b)))
    }
}

/// Returns the mean over units of the value at index `place`.
pub(crate) fn mean(units: &[&Vec<f64>], place: usize) -> f64 {
    let n = units.len() as f64;
    units.iter().map(|unit| unit[place]).sum::<f64>() / n
}

/// The cap on n* for extended counting: four times the paper's 130.
pub(crate) const MOST_COUNTS: f64 = 520.0;

/// Returns the largest number of measurements, plain and discounted, of a cell that first fulfilled
/// H ≤ ε.
///
/// Both are maxima over all runs of CL, the second with the discount of extended counting; 0
/// without runs.
pub(crate) fn measured_until_explored(runs: &Runs) -> [f64; 2] {
    let most = |metric: &str| runs.values(Strategy::Cl, metric).into_iter().fold(0.0, f64::max);
    [most("measurements.until_explored"), most("measurements.until_explored_discounted")]
}

#[cfg(test)]
pub(crate) type Row<'a> = (&'a str, usize, u64, &'a [(&'a str, f64)]);

/// Returns runs for tests.
#[cfg(test)]
pub(crate) fn made_up(rows: &[Row<'_>]) -> Runs {
    let run = |(strategy, start, seed, values): &Row<'_>| RecordedRun {
        world: "apartment".into(),
        strategy: strategy.parse().unwrap(),
        start: *start,
        seed: *seed,
        values: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
        cut_short: false,
    };
    Runs { runs: rows.iter().map(run).collect() }
}

/// Returns a series for tests: for each strategy and metric, a mean with a small spread over four
/// starts and two seeds.
///
/// A second, smaller spread is shared by neither strategies nor metrics.
#[cfg(test)]
pub(crate) fn series(strategies: &[(&str, &[(&str, f64)])]) -> Runs {
    const OWN: [[f64; 4]; 3] =
        [[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0], [1.0, -1.0, -1.0, 1.0]];
    let spread = |i: usize, start: usize, seed: u64| {
        let own = 0.001 * (1.0 + i as f64) * OWN[i % 3][start];
        1.0 + own + 0.01 * ((start as f64) - 1.5) + 0.004 * (seed as f64 - 1.5)
    };
    let mut runs = Vec::new();
    for (place, (strategy, values)) in strategies.iter().enumerate() {
        for start in 0..4usize {
            for seed in 1..=2u64 {
                let values: Vec<(&str, f64)> = values
                    .iter()
                    .enumerate()
                    .map(|(i, (name, value))| (*name, value * spread(place + i, start, seed)))
                    .collect();
                runs.extend(made_up(&[(*strategy, start, seed, &values)]).runs);
            }
        }
    }
    Runs { runs }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_paired_by_start_and_seed_and_unpaired_ones_left_out() {
        let rows: [Row<'_>; 5] = [
            ("CL", 0, 1, &[("scans", 10.0)]),
            ("IG", 0, 1, &[("scans", 4.0)]),
            ("CL", 1, 1, &[("scans", 20.0)]),
            ("IG", 1, 1, &[("scans", 6.0)]),
            ("CL", 2, 1, &[("scans", 900.0)]),
        ];
        let runs = made_up(&rows);
        let units = runs.paired(&[Strategy::Cl, Strategy::Ig], "scans");
        assert_eq!(units.0, [vec![vec![10.0, 4.0]], vec![vec![20.0, 6.0]]]);
        assert!((units.ratio(0, 1).unwrap().value - 3.0).abs() < 1e-12);
        assert!((units.difference(1, 0).unwrap().value + 10.0).abs() < 1e-12);
        assert!(runs.paired(&[Strategy::Cl], "path").mean(0).is_none());
    }
}
