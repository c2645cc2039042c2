//! `beside`: runs of `explore` side by side, with the accuracy that their scans and metres bought.

use crate::arguments::Beside;
use crate::terminal::say;
use anyhow::{Result, bail};
use covmap_draw::FigureFolder;
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Series};
use covmap_fit::{ExampleScore, Weighting};
use covmap_io::csv;
use covmap_io::read_json;
use serde::Deserialize;
use std::path::Path;
use std::process::ExitCode;

/// The keys of a `summary.json` that the table needs.
#[derive(Deserialize)]
struct Summary {
    world: String,
    strategy: String,
    seed: u64,
    resolution: f64,
    scans: u32,
    path_length_m: f64,
    completeness: f64,
    measured: ExampleScore,
}

/// One run.
struct RunRow {
    name: String,
    summary: Summary,
}

pub(crate) fn run(arguments: &Beside) -> Result<ExitCode> {
    let rows = arguments.runs.iter().map(|dir| RunRow::read(dir)).collect::<Result<Vec<_>>>()?;
    let output = FigureFolder::create(&arguments.out, arguments.force.replace())?;
    let table: Vec<Vec<String>> = rows.iter().map(RunRow::fields).collect();
    let quoted = |row: &Vec<String>| row.iter().map(|field| csv::field(field)).collect();
    output.table("runs", &COLUMNS, &table.iter().map(quoted).collect::<Vec<_>>())?;
    output.figure("runs", &figure(&rows))?;
    if !arguments.quiet {
        aligned(&table).into_iter().for_each(say::line);
        say::line(output.dir().display());
    }
    Ok(ExitCode::SUCCESS)
}

const COLUMNS: [&str; 11] = [
    "run",
    "world",
    "r_m",
    "strategy",
    "seed",
    "scans",
    "path_m",
    "completeness",
    "class_mean",
    "error_partial",
    "walls_found",
];

impl RunRow {
    fn read(dir: &Path) -> Result<Self> {
        let summary = dir.join("summary.json");
        if !summary.is_file() {
            bail!("{}: no summary.json; name folders that `explore` wrote", dir.display());
        }
        let name = dir.file_name().unwrap_or(dir.as_os_str()).to_string_lossy();
        Ok(Self { name: name.into_owned(), summary: read_json(summary)? })
    }

    /// Returns the class mean of the log-likelihood \[nats\]; `None` if nothing was measured.
    fn class_mean(&self) -> Option<f64> {
        let measured = &self.summary.measured;
        (measured.all.cells > 0).then(|| Weighting::Classes.objective(measured))
    }

    /// Returns the share of the first layer of walls that is found; `None` if there is none.
    fn walls_found(&self) -> Option<f64> {
        let walls = &self.summary.measured.solid;
        (walls.cells > 0).then_some(walls.found)
    }

    fn fields(&self) -> Vec<String> {
        let Summary {
            world, strategy, seed, resolution, scans, path_length_m, completeness, ..
        } = &self.summary;
        let partial = &self.summary.measured.partial;
        let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.3}"));
        vec![
            self.name.clone(),
            world.clone(),
            resolution.to_string(),
            strategy.clone(),
            seed.to_string(),
            scans.to_string(),
            format!("{path_length_m:.0}"),
            format!("{completeness:.3}"),
            number(self.class_mean()),
            number((partial.cells > 0).then_some(partial.error_of_mode)),
            number(self.walls_found()),
        ]
    }

    /// Returns the name of the run's series; COUNT strategies are one series, whatever their number
    /// of scans.
    fn series(&self) -> String {
        let Summary { strategy, .. } = &self.summary;
        let counts = strategy.starts_with("COUNT:");
        if counts { "COUNT".into() } else { strategy.clone() }
    }
}

/// Returns the table for the terminal, with columns as wide as their longest field.
fn aligned(rows: &[Vec<String>]) -> Vec<String> {
    let header: Vec<String> = COLUMNS.iter().map(ToString::to_string).collect();
    let all: Vec<&Vec<String>> = std::iter::once(&header).chain(rows).collect();
    let width =
        |column: usize| all.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..COLUMNS.len()).map(width).collect();
    let line = |row: &&Vec<String>| {
        let fields = row.iter().zip(&widths).map(|(field, width)| format!("{field:<width$}"));
        fields.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    all.iter().map(line).collect()
}

fn figure(rows: &[RunRow]) -> Figure {
    let panel = |title: &str, y: &str, of: &dyn Fn(&RunRow) -> Option<f64>| {
        let of_x = |label: &str, x: &dyn Fn(&RunRow) -> f64| Chart {
            title: title.into(),
            subtitle: String::new(),
            // The scans and paths of strategies differ by factors.
            x: ChartAxis { logarithmic: true, ..ChartAxis::new(label) },
            y: ChartAxis::new(y),
            series: series(rows, |row| Some((x(row), of(row)?))),
        };
        let scans = of_x("scans", &|row| f64::from(row.summary.scans));
        [scans, of_x("driven [m]", &|row| row.summary.path_length_m)]
    };
    let panels = [
        panel(
            "How well the map explains the truth",
            "class mean of the log-likelihood [nats]",
            &RunRow::class_mean,
        ),
        panel("Walls that are found", "share of the first layer", &RunRow::walls_found),
    ];
    Figure {
        title: "What scans and metres buy".into(),
        subtitle: format!("{} runs; a line joins those of one strategy", rows.len()),
        panels: panels.into_iter().flatten().map(Into::into).collect(),
        columns: 2,
    }
}

/// Returns a line for each strategy, in the order of first appearance.
fn series(rows: &[RunRow], point: impl Fn(&RunRow) -> Option<(f64, f64)>) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    for row in rows {
        let Some((x, y)) = point(row) else { continue };
        let name = row.series();
        let at = all.iter().position(|series| series.name == name).unwrap_or_else(|| {
            all.push(Series { name, line: true, marks: true, ..Series::default() });
            all.len() - 1
        });
        all[at].points.push(ChartPoint::new(x, y));
    }
    all.iter_mut().for_each(|series| series.points.sort_by(|a, b| a.x.total_cmp(&b.x)));
    all
}
