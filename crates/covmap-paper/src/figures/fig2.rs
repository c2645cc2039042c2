//! Fig. 2: the posterior of that cell after 30 measurements.

use crate::error::Result;
use crate::partial_cells::{COVERAGE, FIG_2, PartialCell, spread};
use covmap::bin_coverage;
use covmap_draw::FigureFolder;
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};

/// Draws the figure for one or more configurations, each with its name.
pub(crate) fn write(output: &FigureFolder, configs: &[(&str, &[PartialCell])]) -> Result<()> {
    let rows = configs.iter().flat_map(|(name, cells)| cells.iter().map(move |c| (name, c)));
    let rows: Vec<Vec<String>> = rows.flat_map(|(name, cell)| table(name, cell)).collect();
    let columns = ["config", "case", "coverage", "mean", "low", "high"];
    output.table("figure2", &columns, &rows)?;
    Ok(output.figure("figure2", &figure(configs))?)
}

fn figure(configs: &[(&str, &[PartialCell])]) -> Figure {
    let cases = configs.first().map_or(0, |(_, cells)| cells.len());
    let seeds = configs.first().and_then(|(_, cells)| cells.first()).map_or(0, |c| c.series.len());
    Figure {
        title: format!("Fig. 2: the posterior of the cell after {FIG_2} measurements"),
        subtitle: format!("mean of {seeds} seeds, bars from the 5th to the 95th percentile"),
        panels: (0..cases).map(|case| panel(configs, case).into()).collect(),
        columns: 2,
    }
}

fn panel(configs: &[(&str, &[PartialCell])], case: usize) -> Chart {
    let truth = [0.0, 1.0].map(|y| ChartPoint::new(COVERAGE, y)).to_vec();
    let curve = |(name, cells): &(&str, &[PartialCell])| Series {
        name: (*name).to_owned(),
        points: points(&cells[case]),
        line: true,
        marks: true,
    };
    let truth = Series { name: "true coverage".into(), points: truth, line: true, marks: false };
    let cell = &configs[0].1[case];
    Chart {
        title: format!("({}) {}", cell.case, cell.what),
        subtitle: String::new(),
        x: ChartAxis { from: Some(-0.03), to: Some(1.03), ..ChartAxis::new("coverage") },
        y: ChartAxis { from: Some(0.0), to: Some(1.0), ..ChartAxis::new("probability") },
        series: configs.iter().map(curve).chain([truth]).collect(),
    }
}

fn points(cell: &PartialCell) -> Vec<ChartPoint> {
    let point = |(x, (y, low, high))| ChartPoint { low, high, ..ChartPoint::new(x, y) };
    bins(cell).map(point).collect()
}

/// Returns the coverage of each bin, with mean and percentiles of its probability.
fn bins(cell: &PartialCell) -> impl Iterator<Item = (f64, (f64, f64, f64))> + '_ {
    let bins = cell.series.first().map_or(0, |series| series.posterior.len());
    (0..bins).map(move |bin| {
        (bin_coverage(bin, bins), spread(&cell.values(|series| series.posterior[bin])))
    })
}

fn table(config: &str, cell: &PartialCell) -> Vec<Vec<String>> {
    let row = |(coverage, (mean, low, high)): (f64, (f64, f64, f64))| {
        let numbers = [coverage, mean, low, high].map(|v| format!("{v:?}"));
        [config.to_owned(), cell.case.to_string()].into_iter().chain(numbers).collect()
    };
    bins(cell).map(row).collect()
}
