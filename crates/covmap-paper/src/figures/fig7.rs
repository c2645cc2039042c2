//! Fig. 7: scans (a) and paths (b) of the strategies, trajectories of IG (c) and CL (d).

use super::map_figure::{self, Trajectory};
use crate::error::Result;
use crate::runs::Runs;
use crate::session::Series as Campaigned;
use covmap_campaign::{PARAMETERS, RunKey, load_paths, parameters};
use covmap_draw::FigureFolder;
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_plan::Strategy;

/// The charts of Fig. 7: a metric, and its names.
const METRICS: [(&str, &str, &str); 2] = [
    ("scans", "(a) number of measurements", "scans"),
    ("path_length_m", "(b) length of the path", "path [m]"),
];

/// Draws (a) and (b) for some named series of runs, as `NAME.svg` and `.png`.
pub(crate) fn write(
    output: &FigureFolder,
    name: &str,
    title: &str,
    columns: &[(&str, &Runs)],
) -> Result<()> {
    let strategies = columns.first().map(|(_, runs)| runs.strategies()).unwrap_or_default();
    let rows = |(column, runs): &(&str, &Runs)| -> Vec<Vec<String>> {
        let of =
            |strategy: &Strategy| METRICS.map(|(metric, ..)| row(column, runs, *strategy, metric));
        strategies.iter().flat_map(of).collect()
    };
    let rows: Vec<Vec<String>> = columns.iter().flat_map(rows).collect();
    let header = [&["series", "strategy"], &PARAMETERS[..], &NUMBERS].concat();
    output.table(name, &header, &rows)?;
    let panel = |(metric, title, axis): (&str, &str, &str)| {
        chart(columns, &strategies, (metric, title, axis)).into()
    };
    let runs = columns.iter().map(|(_, runs)| runs.runs.len() / strategies.len().max(1)).max();
    let cut_short = columns.iter().any(|(_, runs)| runs.runs.iter().any(|run| run.cut_short));
    let figure = Figure {
        title: title.into(),
        subtitle: format!(
            "mean of {} paired runs, with the 95 % interval by resampling starts; logarithmic{}",
            runs.unwrap_or(0),
            if cut_short { HOLLOW } else { "" }
        ),
        panels: METRICS.map(panel).to_vec(),
        columns: 1,
    };
    Ok(output.figure(name, &figure)?)
}

/// The columns of the table after the strategy and its parameters.
const NUMBERS: [&str; 6] = ["metric", "n", "cut_short", "mean", "low", "high"];

/// The meaning of a hollow mark.
const HOLLOW: &str =
    "; hollow: some of the runs were cut short, and to their end the mean would be larger";

/// Returns the numbers of a row, whether they can be drawn or not; an unknown interval is left
/// empty.
fn row(column: &str, runs: &Runs, strategy: Strategy, metric: &str) -> Vec<String> {
    let mean = runs.paired(&[strategy], metric).mean(0);
    let (low, high) = mean.and_then(|mean| mean.interval(0.95)).unzip();
    let numbers = [mean.map(|mean| mean.value), low, high];
    let numbers = numbers.map(|v| v.map(|v| format!("{v:?}")).unwrap_or_default());
    let n = runs.values(strategy, metric).len().to_string();
    [column.to_owned(), format!("\"{strategy}\"")]
        .into_iter()
        .chain(parameters(&strategy))
        .chain([metric.to_owned(), n, runs.cut_short(strategy).to_string()])
        .chain(numbers)
        .collect()
}

fn chart(
    columns: &[(&str, &Runs)],
    strategies: &[Strategy],
    (metric, title, axis): (&str, &str, &str),
) -> Chart {
    let names = strategies.iter().map(|strategy| strategy.to_string().replacen(':', "\n", 1));
    let series = |(index, (name, runs)): (usize, &(&str, &Runs))| {
        // The series stand side by side.
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

/// Returns the mean of a strategy with its interval, as drawn.
fn point(runs: &Runs, strategy: Strategy, metric: &str, x: f64) -> ChartPoint {
    let Some(mean) = runs.paired(&[strategy], metric).mean(0) else {
        return ChartPoint::new(x, f64::NAN);
    };
    let (low, high) = mean.interval(0.95).unwrap_or((mean.value, mean.value));
    // On a logarithmic axis, a bar to zero or below would be endless, and one to nearly zero would
    // leave no room for the others. Both are drawn up to the frame.
    let low = if low < mean.value / 10.0 { f64::NEG_INFINITY } else { low };
    let hollow = runs.cut_short(strategy) > 0;
    ChartPoint { low, high, hollow, ..ChartPoint::new(x, mean.value) }
}

/// Draws (c) and (d), the first run of IG and of CL of a setting.
///
/// # Errors
/// If the run's paths were not kept, or cannot be read.
pub(crate) fn write_trajectories(
    output: &FigureFolder,
    series: &Campaigned,
    setting: &str,
    suffix: &str,
) -> Result<()> {
    let Some(world) = series.campaign.worlds.first() else { return Ok(()) };
    for (letter, strategy) in [('c', Strategy::Ig), ('d', Strategy::Cl)] {
        let name = strategy.to_string();
        let is_wanted = |key: &RunKey| {
            key.strategy == name && key.setting == setting && key.world == world.name
        };
        let Some(record) = series.records.iter().find(|record| is_wanted(&record.key)) else {
            continue;
        };
        let paths = load_paths(&series.dir, &record.key)?;
        let title = format!("Fig. 7 ({letter}): path of {name}");
        let cut_short = record.is_cut_short();
        let trajectory = Trajectory { title, subtitle: record.key.to_string(), paths, cut_short };
        map_figure::write_trajectory(
            output,
            &format!("figure7{letter}{suffix}"),
            world,
            &trajectory,
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::{Row, made_up};

    /// Returns the rows of `figure7.csv` and the drawing of runs of CL from different starts;
    /// `cut_short` of them were cut short.
    fn drawn(scans: &[f64], cut_short: usize) -> (Vec<Vec<String>>, String) {
        let values: Vec<[(&str, f64); 2]> =
            scans.iter().map(|n| [("scans", *n), ("path_length_m", 1.0)]).collect();
        let rows: Vec<Row<'_>> =
            values.iter().enumerate().map(|(start, v)| ("CL", start, 1, &v[..])).collect();
        let mut runs = made_up(&rows);
        runs.runs.iter_mut().take(cut_short).for_each(|run| run.cut_short = true);
        let dir = tempfile::tempdir().unwrap();
        let output = FigureFolder::create(dir.path(), covmap_io::Replace::Same).unwrap();
        write(&output, "figure7", "Fig. 7", &[("a", &runs)]).unwrap();
        let table = std::fs::read_to_string(output.path("figure7.csv")).unwrap();
        let mut lines = table.lines();
        assert_eq!(
            lines.next().unwrap(),
            "series,strategy,alpha,radius,times,half_distance,metric,n,cut_short,mean,low,high"
        );
        let rows = lines.map(|line| line.split(',').map(str::to_owned).collect()).collect();
        (rows, std::fs::read_to_string(output.path("figure7.svg")).unwrap())
    }

    #[test]
    fn the_table_has_the_interval_as_it_is_though_no_logarithm_can_show_it() {
        let (rows, svg) = drawn(&[1.0, 1.0, 100.0], 0);
        let [mean, low, high] = [9, 10, 11].map(|i| rows[0][i].parse::<f64>().unwrap());
        assert!((mean - 34.0).abs() < 1e-9);
        // The interval is symmetric about the mean; by Student's t with two degrees of freedom it
        // reaches below zero.
        assert!(low < 0.0 && ((mean - low) - (high - mean)).abs() < 1e-9, "{low} {high}");
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn an_interval_that_is_not_known_is_left_empty() {
        let (rows, _) = drawn(&[7.0], 0);
        assert_eq!(rows[0][6..], ["scans", "1", "0", "7.0", "", ""]);
    }

    #[test]
    fn runs_that_were_cut_short_are_counted_and_their_marks_hollow() {
        let marks = |svg: &str| svg.matches("fill=\"#ffffff\"").count();
        let (rows, whole) = drawn(&[7.0, 8.0, 9.0], 0);
        assert_eq!(rows[0][8], "0");
        let (rows, cut) = drawn(&[7.0, 8.0, 9.0], 2);
        assert!(rows.iter().all(|row| row[7] == "3" && row[8] == "2"), "{rows:?}");
        assert_eq!(marks(&cut) - marks(&whole), 2, "in either panel");
        assert!(cut.contains("hollow") && !whole.contains("hollow"));
    }
}
