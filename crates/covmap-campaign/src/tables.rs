//! The results of a campaign as tables.
//!
//! If runs of a campaign are missing, the names of its tables say so, as in `runs-8-of-12.csv`: they are
//! not the result of the campaign.

use crate::parameters::{PARAMETERS, parameters};
use crate::record::{RunRecord, Value};
use covmap_io::{FileError, csv};
use covmap_plan::Strategy;
use covmap_statistics::Spread;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

const RUNS: &str = "runs";
const TIMINGS: &str = "timings";
const SUMMARY: &str = "summary";

/// Writes the tables `runs`, `timings` and `summary` of the recorded runs, out of `of` runs, and removes
/// the tables of another number of runs.
///
/// `runs` and `summary` are a function of the campaign and the program; `timings` is not.
pub(crate) fn write<'a>(
    dir: &Path,
    metrics: &[String],
    records: impl IntoIterator<Item = &'a RunRecord>,
    of: usize,
) -> Result<(), FileError> {
    let records: &[&RunRecord] = &records.into_iter().collect::<Vec<_>>();
    let name = |table: &str| match records.len() {
        all if all == of => format!("{table}.csv"),
        some => format!("{table}-{some}-of-{of}.csv"),
    };
    let names = [RUNS, TIMINGS, SUMMARY].map(name);
    remove_but(dir, &names)?;
    let [runs, timings, summary] = names.map(|name| dir.join(name));
    csv::write(&runs, |out| {
        let columns = records.first().map(|r| r.values.keys().cloned().collect::<Vec<_>>());
        let columns = columns.unwrap_or_default();
        writeln!(out, "{KEY},{},{}", PARAMETERS.join(","), columns.join(","))?;
        for record in records {
            let value = |name: &String| {
                record
                    .values
                    .get(name)
                    .map(|value| csv::field(&value.to_string()))
                    .unwrap_or_default()
            };
            let values: Vec<String> = columns.iter().map(value).collect();
            writeln!(out, "{},{}", key(record), values.join(","))?;
        }
        Ok(())
    })?;
    csv::write(&timings, |out| {
        let columns = records.first().map(|r| r.times.keys().cloned().collect::<Vec<_>>());
        let columns = columns.unwrap_or_default();
        writeln!(out, "{KEY},{},{}", PARAMETERS.join(","), columns.join(","))?;
        for record in records {
            let time = |name: &String| {
                record.times.get(name).map(|time| format!("{time:.6}")).unwrap_or_default()
            };
            let times: Vec<String> = columns.iter().map(time).collect();
            writeln!(out, "{},{}", key(record), times.join(","))?;
        }
        Ok(())
    })?;
    let rows = summarised(metrics, records);
    csv::write(&summary, |out| out.write_all(rows.as_bytes()))
}

/// Removes the tables, as they will not fit the recorded runs any longer.
pub(crate) fn remove(dir: &Path) -> Result<(), FileError> {
    remove_but(dir, &[])
}

fn remove_but(dir: &Path, kept: &[String]) -> Result<(), FileError> {
    let entries = std::fs::read_dir(dir).map_err(FileError::io(dir, "read"))?;
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_table(&name) && !kept.contains(&name) {
            let file = entry.path();
            std::fs::remove_file(&file).map_err(FileError::io(&file, "removed"))?;
        }
    }
    Ok(())
}

/// Whether a name is that of a table, such as `runs.csv` or `runs-8-of-12.csv`.
fn is_table(name: &str) -> bool {
    let Some(name) = name.strip_suffix(".csv") else { return false };
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    [RUNS, TIMINGS, SUMMARY].iter().filter_map(|table| name.strip_prefix(table)).any(|rest| {
        let numbers = rest.strip_prefix('-').and_then(|rest| rest.split_once("-of-"));
        rest.is_empty() || numbers.is_some_and(|(some, of)| is_number(some) && is_number(of))
    })
}

const KEY: &str = "world,setting,strategy,start,seed";

/// The fields of the key, and the strategy's parameters.
fn key(record: &RunRecord) -> String {
    let key = &record.key;
    let names = [&key.world, &key.setting, &key.strategy].map(|name| csv::field(name));
    format!("{},{},{},{}", names.join(","), key.start, key.seed, numbers(&key.strategy))
}

/// The parameters of a strategy, by its spelling.
fn numbers(strategy: &str) -> String {
    let strategy = strategy.parse::<Strategy>();
    strategy.map_or_else(|_| Default::default(), |strategy| parameters(&strategy)).join(",")
}

/// Mean, standard deviation and 95 % interval of each metric over starts and seeds, in the
/// order of the campaign, with the number of these runs that were cut short.
fn summarised(metrics: &[String], records: &[&RunRecord]) -> String {
    let mut order: Vec<[&str; 3]> = Vec::new();
    let mut groups: BTreeMap<[&str; 3], Vec<&RunRecord>> = BTreeMap::new();
    for record in records {
        let key = &record.key;
        let group = [key.world.as_str(), &key.setting, &key.strategy];
        let runs = groups.entry(group).or_default();
        if runs.is_empty() {
            order.push(group);
        }
        runs.push(record);
    }
    let parameters = PARAMETERS.join(",");
    let mut table =
        format!("world,setting,strategy,{parameters},metric,n,cut_short,mean,sd,low,high\n");
    for group in order {
        let runs = &groups[&group];
        let name = format!("{},{}", group.map(csv::field).join(","), numbers(group[2]));
        let cut_short = runs.iter().filter(|record| record.is_cut_short()).count();
        for metric in metrics {
            let number = |record: &&RunRecord| match record.values.get(metric) {
                Some(Value::Number(number)) => Some(*number),
                Some(Value::Text(_)) | None => None,
            };
            let numbers: Vec<f64> = runs.iter().filter_map(number).collect();
            let Some(spread) = Spread::of(&numbers) else { continue };
            let Spread { n, mean, deviation, interval } = spread;
            let rest = match deviation.zip(interval) {
                Some((sd, (low, high))) => [sd, low, high].map(digits).join(","),
                None => ",,".to_owned(),
            };
            let _ = writeln!(table, "{name},{metric},{n},{cut_short},{},{rest}", digits(mean));
        }
    }
    table
}

/// A number to nine digits: further digits of an interval depend on the approximation of the quantile of
/// Student's distribution.
fn digits(value: f64) -> String {
    format!("{value:.8e}").parse::<f64>().map_or_else(|_| value.to_string(), |v| v.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_a_campaign_writes_is_one_of_its_tables() {
        for name in ["runs.csv", "timings.csv", "summary-0-of-12.csv", "runs-8-of-12.csv"] {
            assert!(is_table(name), "{name}");
        }
        for name in ["runs", "runs-old.csv", "runs-8-of-.csv", "runs-8-of-12.csv.bak", "my.csv"] {
            assert!(!is_table(name), "{name}");
        }
    }
}
