//! Fig. 7: scans (a) and paths (b) of the strategies, trajectories of IG (c) and CL (d).

use super::map_figure::{self, Trajectory};
use super::output::Output;
use crate::campaign::load_paths;
use crate::paper::runs::Runs;
use crate::paper::session::Series as Campaigned;
use anyhow::Result;
use covmap_io::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_plan::Strategy;

/// The charts of Fig. 7: a metric, and what it is called.
const METRICS: [(&str, &str, &str); 2] = [
    ("scans", "(a) number of measurements", "scans"),
    ("path_length_m", "(b) length of the path", "path [m]"),
];

/// Draws (a) and (b) for some series of runs, each with its name, as `NAME.svg` and `.png`.
pub(crate) fn write(
    output: &Output,
    name: &str,
    title: &str,
    columns: &[(&str, &Runs)],
) -> Result<()> {
    let strategies = columns.first().map(|(_, runs)| runs.strategies()).unwrap_or_default();
    let mut rows = Vec::new();
    for (column, runs) in columns {
        for strategy in &strategies {
            for (metric, ..) in METRICS {
                let point = point(runs, *strategy, metric, 0.0);
                let n = runs.values(*strategy, metric).len();
                let numbers = [point.y, point.low, point.high].map(|v| format!("{v:?}"));
                let key = [(*column).to_owned(), format!("\"{strategy}\""), metric.to_owned()];
                rows.push(key.into_iter().chain([n.to_string()]).chain(numbers).collect());
            }
        }
    }
    let header = ["series", "strategy", "metric", "n", "mean", "low", "high"];
    output.table(name, &header, &rows)?;
    let panel = |(metric, title, axis): (&str, &str, &str)| {
        chart(columns, &strategies, (metric, title, axis)).into()
    };
    let runs = columns.iter().map(|(_, runs)| runs.runs.len() / strategies.len().max(1)).max();
    let figure = Figure {
        title: title.into(),
        subtitle: format!(
            "mean of {} paired runs, with the 95 % interval by resampling starts; logarithmic",
            runs.unwrap_or(0)
        ),
        panels: METRICS.map(panel).to_vec(),
        columns: 1,
    };
    output.figure(name, &figure)
}

fn chart(
    columns: &[(&str, &Runs)],
    strategies: &[Strategy],
    (metric, title, axis): (&str, &str, &str),
) -> Chart {
    let names = strategies.iter().map(|strategy| strategy.to_string().replace('(', "\n("));
    #[allow(clippy::cast_precision_loss, reason = "a few strategies")]
    let series = |(index, (name, runs)): (usize, &(&str, &Runs))| {
        // Beside each other.
        let aside = 0.16 * (index as f64 - 0.5 * (columns.len() as f64 - 1.0));
        let at = |(place, strategy): (usize, &Strategy)| {
            point(runs, *strategy, metric, place as f64 + 1.0 + aside)
        };
        Series {
            name: (*name).to_owned(),
            points: strategies.iter().enumerate().map(at).collect(),
            line: false,
            marks: true,
        }
    };
    Chart {
        title: title.into(),
        subtitle: String::new(),
        x: ChartAxis::named("", names.collect()),
        y: ChartAxis::logarithmic(axis),
        series: columns.iter().enumerate().map(series).collect(),
    }
}

/// The mean of a strategy with its interval.
fn point(runs: &Runs, strategy: Strategy, metric: &str, x: f64) -> ChartPoint {
    let Some(mean) = runs.paired(&[strategy], metric).mean(0) else {
        return ChartPoint::new(x, f64::NAN);
    };
    let (low, high) = mean.interval(0.95).unwrap_or((mean.value, mean.value));
    // Below zero nothing can be drawn on a logarithmic axis.
    ChartPoint { x, y: mean.value, low: low.max(mean.value / 10.0), high }
}

/// Draws (c) and (d), the first run of IG and of CL of a setting.
///
/// # Errors
/// If its paths were not kept, or cannot be read.
pub(crate) fn write_trajectories(
    output: &Output,
    series: &Campaigned,
    setting: &str,
    suffix: &str,
) -> Result<()> {
    let Some(world) = series.campaign.worlds.first() else { return Ok(()) };
    for (letter, strategy) in [('c', Strategy::Ig), ('d', Strategy::Cl)] {
        let name = strategy.to_string();
        let mut keys = series.records.iter().map(|record| &record.key);
        let found = keys
            .find(|key| key.strategy == name && key.setting == setting && key.world == world.name);
        let Some(key) = found else { continue };
        let paths = load_paths(&series.dir, key)?;
        let title = format!("Fig. 7 ({letter}): path of {name}");
        let trajectory = Trajectory { title, subtitle: key.to_string(), paths };
        map_figure::write_trajectory(
            output,
            &format!("figure7{letter}{suffix}"),
            world,
            &trajectory,
        )?;
    }
    Ok(())
}
