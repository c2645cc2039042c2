//! Fig. 6: path length of scan counting over the share of sufficiently explored cells.

use crate::crossing::{Point, curve};
use crate::error::Result;
use crate::runs::{RecordedRun, Runs};
use covmap_campaign::{PARAMETERS, parameters};
use covmap_draw::FigureFolder;
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_plan::Strategy;
use covmap_statistics::Estimate;

/// Draws the figure for one or more configurations, each with its runs.
pub(crate) fn write(output: &FigureFolder, columns: &[(&str, &Runs)]) -> Result<()> {
    let rows = |(name, runs): &(&str, &Runs)| -> Vec<Vec<String>> {
        runs.runs.iter().map(|run| row(name, run)).collect()
    };
    let rows: Vec<Vec<String>> = columns.iter().flat_map(rows).collect();
    let header = [&["config", "strategy"], &PARAMETERS[..], &NUMBERS].concat();
    output.table("figure6", &header, &rows)?;
    let cut_short = columns.iter().any(|(_, runs)| runs.runs.iter().any(|run| run.cut_short));
    let figure = Figure {
        title: "Fig. 6: length of the path over the share of sufficiently explored cells".into(),
        subtitle: format!(
            "scan counting forced to reach n, measuring while driving; CL on coverage maps with 95 % interval{}",
            if cut_short { HOLLOW } else { "" }
        ),
        panels: columns.iter().map(|(name, runs)| panel(name, runs).into()).collect(),
        columns: columns.len(),
    };
    Ok(output.figure("figure6", &figure)?)
}

/// The columns of the table after the strategy and its parameters; `cut_short` is 1 for a run that
/// was cut short.
const NUMBERS: [&str; 5] = ["start", "seed", "cut_short", "explored", "path_m"];

/// The meaning of a hollow mark.
const HOLLOW: &str = "; hollow: cut short, and to the end both would be larger";

fn row(config: &str, run: &RecordedRun) -> Vec<String> {
    let Point { path, share } = point(run);
    let cut_short = u8::from(run.cut_short).to_string();
    [config.to_owned(), format!("\"{}\"", run.strategy)]
        .into_iter()
        .chain(parameters(&run.strategy))
        .chain([run.start.to_string(), run.seed.to_string(), cut_short])
        .chain([share, path].map(|v| format!("{v:?}")))
        .collect()
}

fn panel(name: &str, runs: &Runs) -> Chart {
    let of = |is: &dyn Fn(&Strategy) -> bool| -> Vec<&RecordedRun> {
        runs.runs.iter().filter(|run| is(&run.strategy)).collect()
    };
    let discounted = of(&|s| matches!(s, Strategy::Count { half_distance: Some(_), .. }));
    let plain = of(&|s| matches!(s, Strategy::Count { half_distance: None, .. }));
    let cl = of(&|s| *s == Strategy::Cl);
    let series = |name: &str, points: Vec<ChartPoint>, line: bool| Series {
        name: name.into(),
        points,
        line,
        marks: !line,
    };
    let as_points = |runs: &[&RecordedRun]| -> Vec<ChartPoint> {
        let drawn = |run: &&RecordedRun| {
            let Point { path, share } = point(run);
            ChartPoint { hollow: run.cut_short, ..ChartPoint::new(share, path) }
        };
        runs.iter().map(drawn).collect()
    };
    let curve: Vec<Point> = curve(&discounted.iter().map(|run| point(run)).collect::<Vec<_>>());
    let curve = curve.iter().map(|point| ChartPoint::new(point.share, point.path)).collect();
    Chart {
        title: format!("{name}.ron"),
        subtitle: String::new(),
        x: ChartAxis::new("share of cells with H ≤ ε"),
        y: ChartAxis { from: Some(0.0), ..ChartAxis::new("path [m]") },
        series: vec![
            series("counting, discounted", as_points(&discounted), false),
            series("counting, every beam fully", as_points(&plain), false),
            series("CL on coverage maps", vec![cross(&cl)], false),
            series("monotone curve, discounted", curve, true),
        ],
    }
}

fn point(run: &RecordedRun) -> Point {
    Point { path: run.value("path_length_m"), share: run.value("share_explored") }
}

/// Returns the mean of CL, with the interval of its path.
fn cross(runs: &[&RecordedRun]) -> ChartPoint {
    let points: Vec<Point> = runs.iter().map(|run| point(run)).collect();
    let paths: Vec<f64> = points.iter().map(|p| p.path).collect();
    let shares: Vec<f64> = points.iter().map(|p| p.share).collect();
    let none = ChartPoint::new(f64::NAN, f64::NAN);
    let (Some(path), Some(share)) = (Estimate::of_mean(&paths), Estimate::of_mean(&shares)) else {
        return none;
    };
    let (low, high) = path.interval(0.95).unwrap_or((path.value, path.value));
    let hollow = runs.iter().any(|run| run.cut_short);
    ChartPoint { low, high, hollow, ..ChartPoint::new(share.value, path.value) }
}
