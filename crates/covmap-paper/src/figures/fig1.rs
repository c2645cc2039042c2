//! Fig. 1: occupancy against coverage for a cell with a coverage of 20 %.

use crate::error::Result;
use crate::partial_cells::{COVERAGE, MEASUREMENTS, PartialCell, spread};
use covmap_draw::FigureFolder;
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};

/// The interval between error bars, in measurements.
const BARS: usize = 10;

/// Draws the figure, and writes the numbers behind it.
pub(crate) fn write(output: &FigureFolder, cells: &[PartialCell], config: &str) -> Result<()> {
    output.table(
        "figure1",
        &["case", "measurements", "method", "mean", "low", "high"],
        &cells.iter().flat_map(rows).collect::<Vec<_>>(),
    )?;
    Ok(output.figure("figure1", &figure(cells, config))?)
}

fn figure(cells: &[PartialCell], config: &str) -> Figure {
    let seeds = cells.first().map_or(0, |cell| cell.series.len());
    Figure {
        title: "Fig. 1: a cell that is covered 20 %, measured again and again".into(),
        subtitle: format!(
            "{config}; mean of {seeds} seeds, bars from the 5th to the 95th percentile; occupancy by log-odds without clamps"
        ),
        panels: cells.iter().map(|cell| panel(cell).into()).collect(),
        columns: 2,
    }
}

fn panel(cell: &PartialCell) -> Chart {
    let line = |name: &str, points: Vec<ChartPoint>| Series {
        name: name.into(),
        points,
        line: true,
        marks: false,
    };
    let truth = [1.0, last()].map(|x| ChartPoint::new(x, COVERAGE)).to_vec();
    Chart {
        title: format!("({}) {}", cell.case, cell.what),
        subtitle: String::new(),
        x: ChartAxis { from: Some(0.0), to: Some(last()), ..ChartAxis::new("measurements") },
        y: ChartAxis { from: Some(0.0), to: Some(1.05), ..ChartAxis::new("occupancy or coverage") },
        series: vec![
            line("occupancy", points(cell, |series, k| series.occupancy[k])),
            line("most likely coverage", points(cell, |series, k| series.mode[k])),
            line("true coverage", truth),
        ],
    }
}

fn points(
    cell: &PartialCell,
    of: fn(&crate::partial_cells::Series, usize) -> f64,
) -> Vec<ChartPoint> {
    let point = |k: usize| {
        let (y, low, high) = spread(&cell.values(|series| of(series, k)));
        let has_bar = (k + 1).is_multiple_of(BARS);
        let (low, high) = if has_bar { (low, high) } else { (y, y) };
        ChartPoint { low, high, ..ChartPoint::new(count(k + 1), y) }
    };
    (0..MEASUREMENTS).map(point).collect()
}

fn rows(cell: &PartialCell) -> Vec<Vec<String>> {
    let row = |k: usize, method: &str, values: &[f64]| {
        let (mean, low, high) = spread(values);
        let numbers = [mean, low, high].map(|v| format!("{v:?}"));
        let names = [cell.case.to_string(), (k + 1).to_string(), method.to_owned()];
        names.into_iter().chain(numbers).collect()
    };
    let both = |k: usize| {
        let occupancy = cell.values(|series| series.occupancy[k]);
        let mode = cell.values(|series| series.mode[k]);
        [row(k, "occupancy", &occupancy), row(k, "coverage", &mode)]
    };
    (0..MEASUREMENTS).flat_map(both).collect()
}

fn last() -> f64 {
    count(MEASUREMENTS)
}

fn count(k: usize) -> f64 {
    k as f64
}
