//! Fig. 6: path length of scan counting over the share of sufficiently explored cells.

use super::output::Output;
use crate::paper::crossing::{Point, curve};
use crate::paper::runs::{Run, Runs};
use anyhow::Result;
use covmap_explore::statistics::Estimate;
use covmap_io::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_plan::Strategy;

/// Draws the figure for one or more configurations, each with its runs.
pub(crate) fn write(output: &Output, columns: &[(&str, &Runs)]) -> Result<()> {
    let rows = |(name, runs): &(&str, &Runs)| -> Vec<Vec<String>> {
        let row = |run: &Run| {
            let point = point(run);
            let strategy = format!("\"{}\"", run.strategy);
            let numbers = [point.share, point.path].map(|v| format!("{v:?}"));
            let key = [(*name).to_owned(), strategy, run.start.to_string(), run.seed.to_string()];
            key.into_iter().chain(numbers).collect()
        };
        runs.runs.iter().map(row).collect()
    };
    let rows: Vec<Vec<String>> = columns.iter().flat_map(rows).collect();
    output.table(
        "figure6",
        &["config", "strategy", "start", "seed", "explored", "path_m"],
        &rows,
    )?;
    let figure = Figure {
        title: "Fig. 6: length of the path over the share of sufficiently explored cells".into(),
        subtitle: "scan counting forced to reach n, measuring while driving; CL on coverage maps with 95 % interval".into(),
        panels: columns.iter().map(|(name, runs)| panel(name, runs).into()).collect(),
        columns: columns.len(),
    };
    output.figure("figure6", &figure)
}

fn panel(name: &str, runs: &Runs) -> Chart {
    let points = |is: &dyn Fn(&Strategy) -> bool| -> Vec<Point> {
        runs.runs.iter().filter(|run| is(&run.strategy)).map(point).collect()
    };
    let discounted = points(&|s| matches!(s, Strategy::Count { half_distance: Some(_), .. }));
    let plain = points(&|s| matches!(s, Strategy::Count { half_distance: None, .. }));
    let cl = points(&|s| *s == Strategy::Cl);
    let series = |name: &str, points: Vec<ChartPoint>, line: bool| Series {
        name: name.into(),
        points,
        line,
        marks: !line,
    };
    let as_points = |points: &[Point]| -> Vec<ChartPoint> {
        points.iter().map(|p| ChartPoint::new(p.share, p.path)).collect()
    };
    Chart {
        title: format!("{name}.ron"),
        subtitle: String::new(),
        x: ChartAxis::new("share of cells with H ≤ ε"),
        y: ChartAxis { from: Some(0.0), ..ChartAxis::new("path [m]") },
        series: vec![
            series("counting, discounted", as_points(&discounted), false),
            series("counting, every beam fully", as_points(&plain), false),
            series("CL on coverage maps", vec![cross(&cl)], false),
            series("monotone curve, discounted", as_points(&curve(&discounted)), true),
        ],
    }
}

fn point(run: &Run) -> Point {
    Point { path: run.value("path_length_m"), share: run.value("share_explored") }
}

/// The mean of CL, with the interval of its path.
fn cross(points: &[Point]) -> ChartPoint {
    let paths: Vec<f64> = points.iter().map(|p| p.path).collect();
    let shares: Vec<f64> = points.iter().map(|p| p.share).collect();
    let none = ChartPoint::new(f64::NAN, f64::NAN);
    let (Some(path), Some(share)) = (Estimate::of_mean(&paths), Estimate::of_mean(&shares)) else {
        return none;
    };
    let (low, high) = path.interval(0.95).unwrap_or((path.value, path.value));
    ChartPoint { x: share.value, y: path.value, low, high }
}
