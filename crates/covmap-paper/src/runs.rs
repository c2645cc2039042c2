//! The runs of one setting of a campaign, paired by start and seed.

use covmap_campaign::{Campaign, RunRecord, Value};
use covmap_plan::Strategy;
use covmap_statistics::{Estimate, Grouped, bootstrap};
use std::collections::BTreeMap;

/// So often starts are resampled, and with which seed.
const RESAMPLES: usize = 2000;
const SEED: u64 = 2003;

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    pub world: String,
    pub strategy: Strategy,
    pub start: usize,
    pub seed: u64,
    pub values: BTreeMap<String, f64>,
    /// Whether it ended before all was explored.
    pub cut_short: bool,
}

/// Runs with the same configuration and the same way to measure.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Runs {
    /// In the order of the campaign.
    pub runs: Vec<Run>,
}

/// One unit of a paired comparison: the same start and seed with several strategies, in their
/// order. Units are grouped by start.
#[derive(Debug, Clone, Default)]
pub struct Units(pub(crate) Grouped<Vec<f64>>);

impl Run {
    /// A number of the run; NaN if it has none of this name.
    pub fn value(&self, metric: &str) -> f64 {
        self.values.get(metric).copied().unwrap_or(f64::NAN)
    }
}

impl Runs {
    /// The runs of a campaign's setting, from what was recorded.
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
            Some(Run { world, strategy, start, seed, values, cut_short })
        };
        let mine = records.iter().filter(|record| record.key.setting == setting);
        Self { runs: mine.filter_map(run).collect() }
    }

    /// The worlds, in the order of the campaign.
    pub fn worlds(&self) -> Vec<String> {
        let mut worlds: Vec<String> = Vec::new();
        for run in &self.runs {
            if !worlds.contains(&run.world) {
                worlds.push(run.world.clone());
            }
        }
        worlds
    }

    /// The runs in one world.
    pub fn in_world(&self, world: &str) -> Self {
        Self { runs: self.runs.iter().filter(|run| run.world == world).cloned().collect() }
    }

    /// The strategies, in the order of the campaign.
    pub fn strategies(&self) -> Vec<Strategy> {
        let mut strategies: Vec<Strategy> = Vec::new();
        for run in &self.runs {
            if !strategies.contains(&run.strategy) {
                strategies.push(run.strategy);
            }
        }
        strategies
    }

    /// The runs of one strategy.
    pub fn with(&self, strategy: Strategy) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(move |run| run.strategy == strategy)
    }

    /// How many runs of one strategy ended before all was explored.
    pub fn cut_short(&self, strategy: Strategy) -> usize {
        self.with(strategy).filter(|run| run.cut_short).count()
    }

    /// The same in words: of how many.
    pub fn cut_short_of(&self, strategy: Strategy) -> String {
        format!("{} of {}", self.cut_short(strategy), self.with(strategy).count())
    }

    /// The numbers of a metric for one strategy.
    pub fn values(&self, strategy: Strategy, metric: &str) -> Vec<f64> {
        self.with(strategy).map(|run| run.value(metric)).filter(|v| v.is_finite()).collect()
    }

    /// A metric of several strategies, by unit; units that lack one of them are left out.
    pub fn paired(&self, strategies: &[Strategy], metric: &str) -> Units {
        self.paired_by(strategies, |run| run.value(metric))
    }

    /// A number of the runs of several strategies, by unit.
    pub fn paired_by(&self, strategies: &[Strategy], of: impl Fn(&Run) -> f64) -> Units {
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
    /// One number for each unit, made of its numbers.
    pub fn each(&self, of: impl Fn(&[f64]) -> f64) -> Self {
        let group = |units: &Vec<Vec<f64>>| units.iter().map(|unit| vec![of(unit)]).collect();
        Self(self.0.iter().map(group).collect())
    }

    /// A statistic of the units with its error, by resampling starts.
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

    /// The mean of the strategy at a place.
    pub fn mean(&self, place: usize) -> Option<Estimate> {
        self.estimate(|units| Some(mean(units, place)))
    }

    /// The ratio of two means, that at the place `a` over that at `b`.
    pub fn ratio(&self, a: usize, b: usize) -> Option<Estimate> {
        self.estimate(|units| Some(mean(units, a) / mean(units, b)))
    }

    /// The mean paired difference, that at the place `a` less that at `b`.
    pub fn difference(&self, a: usize, b: usize) -> Option<Estimate> {
        self.estimate(|units| Some(mean(units, a) - mean(units, b)))
    }
}

/// The mean over units of what is at a place.
pub(crate) fn mean(units: &[&Vec<f64>], place: usize) -> f64 {
    let n = units.len() as f64;
    units.iter().map(|unit| unit[place]).sum::<f64>() / n
}

/// A run for tests: strategy, start, seed and numbers by name.
/// Extended counting with n* is done up to this at most: four times the paper's 130.
pub(crate) const MOST_COUNTS: f64 = 520.0;

/// The largest number of measurements that a cell had in any run of CL when it first fulfilled
/// H ≤ ε, and the largest with the discount of extended counting; 0 without runs.
pub(crate) fn measured_until_explored(runs: &Runs) -> [f64; 2] {
    let most = |metric: &str| runs.values(Strategy::Cl, metric).into_iter().fold(0.0, f64::max);
    [most("measurements.until_explored"), most("measurements.until_explored_discounted")]
}

#[cfg(test)]
pub(crate) type Row<'a> = (&'a str, usize, u64, &'a [(&'a str, f64)]);

/// Runs for tests.
#[cfg(test)]
pub(crate) fn made_up(rows: &[Row<'_>]) -> Runs {
    let run = |(strategy, start, seed, values): &Row<'_>| Run {
        world: "apartment".into(),
        strategy: strategy.parse().unwrap(),
        start: *start,
        seed: *seed,
        values: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
        cut_short: false,
    };
    Runs { runs: rows.iter().map(run).collect() }
}

/// A series for tests: for each strategy and metric a mean, with a small spread over four starts
/// and two seeds, and a smaller one that neither strategies nor metrics share.
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
