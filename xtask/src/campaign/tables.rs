//! What a campaign came to, as tables.

use super::record::{RunRecord, Value};
use crate::csv_file;
use crate::input::about;
use anyhow::Result;
use covmap_explore::Spread;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Writes `runs.csv`, `timings.csv` and `summary.csv`.
///
/// The first and the last are a function of the campaign and the program; the times are not.
pub(crate) fn write<'a>(
    dir: &Path,
    metrics: &[String],
    records: impl IntoIterator<Item = &'a RunRecord>,
) -> Result<()> {
    let records: &[&RunRecord] = &records.into_iter().collect::<Vec<_>>();
    csv_file::write(&dir.join("runs.csv"), |out| {
        let columns = records.first().map(|r| r.values.keys().cloned().collect::<Vec<_>>());
        let columns = columns.unwrap_or_default();
        writeln!(out, "{KEY},{}", columns.join(","))?;
        for record in records {
            let value = |name: &String| {
                record.values.get(name).map(|value| text(&value.to_string())).unwrap_or_default()
            };
            let values: Vec<String> = columns.iter().map(value).collect();
            writeln!(out, "{},{}", key(record), values.join(","))?;
        }
        Ok(())
    })?;
    csv_file::write(&dir.join("timings.csv"), |out| {
        let columns = records.first().map(|r| r.times.keys().cloned().collect::<Vec<_>>());
        let columns = columns.unwrap_or_default();
        writeln!(out, "{KEY},{}", columns.join(","))?;
        for record in records {
            let time = |name: &String| {
                record.times.get(name).map(|time| format!("{time:.6}")).unwrap_or_default()
            };
            let times: Vec<String> = columns.iter().map(time).collect();
            writeln!(out, "{},{}", key(record), times.join(","))?;
        }
        Ok(())
    })?;
    let summary = summary(metrics, records);
    csv_file::write(&dir.join("summary.csv"), |out| out.write_all(summary.as_bytes()))
}

/// Removes the tables, so that none is there that does not tell of what is.
pub(crate) fn remove(dir: &Path) -> Result<()> {
    for name in ["runs.csv", "timings.csv", "summary.csv"] {
        let file = dir.join(name);
        match std::fs::remove_file(&file) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(about(&file)(format!("cannot be removed: {error}")));
            }
            _ => {}
        }
    }
    Ok(())
}

const KEY: &str = "world,setting,strategy,start,seed";

fn key(record: &RunRecord) -> String {
    let key = &record.key;
    let names = [&key.world, &key.setting, &key.strategy].map(|name| text(name));
    format!("{},{},{}", names.join(","), key.start, key.seed)
}

/// A text in a table.
fn text(text: &str) -> String {
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// Mean, standard deviation and 95 % interval of each metric over starts and seeds, in the
/// order of the campaign.
fn summary(metrics: &[String], records: &[&RunRecord]) -> String {
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
    let mut table = "world,setting,strategy,metric,n,mean,sd,low,high\n".to_owned();
    for group in order {
        let name = group.map(text).join(",");
        for metric in metrics {
            let number = |record: &&RunRecord| match record.values.get(metric) {
                Some(Value::Number(number)) => Some(*number),
                Some(Value::Text(_)) | None => None,
            };
            let numbers: Vec<f64> = groups[&group].iter().filter_map(number).collect();
            let Some(spread) = Spread::of(&numbers) else { continue };
            let Spread { n, mean, deviation, interval } = spread;
            let rest = match deviation.zip(interval) {
                Some((sd, (low, high))) => [sd, low, high].map(digits).join(","),
                None => ",,".to_owned(),
            };
            let _ = writeln!(table, "{name},{metric},{n},{},{rest}", digits(mean));
        }
    }
    table
}

/// A number to nine digits: more than that of an interval depends on how the quantile of
/// Student's distribution is approximated.
fn digits(value: f64) -> String {
    format!("{value:.8e}").parse::<f64>().map_or_else(|_| value.to_string(), |v| v.to_string())
}
