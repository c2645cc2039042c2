//! Draws the charts of a report: lines with error bars, logarithmic axes, panels that share a
//! legend, and a heat map, each as SVG and PNG.
//!
//! The data are computed here: cells that are covered 20 % are measured again and again, and every
//! reading is multiplied into a histogram of their coverage.
//!
//! ```text
//! cargo run -p covmap-draw --example chart -- DIR
//! ```

use covmap::{Histogram, bin_coverage, product};
use covmap_draw::{Chart, ChartAxis, ChartPoint, ColorMap, Figure, HeatMap, Series};
use covmap_io::FileError;
use std::path::Path;
use std::process::ExitCode;

/// Coverage of each cell.
const COVERAGE: f64 = 0.2;
const BINS: usize = 11;
/// Number of cells over which the mean is taken; each is measured `READINGS` times.
const CELLS: u64 = 200;
const READINGS: usize = 60;
/// Standard deviations of a reading.
const NOISES: [f64; 4] = [0.1, 0.2, 0.4, 0.8];

fn main() -> ExitCode {
    let Some(dir) = std::env::args().nth(1) else {
        eprintln!("usage: chart DIR");
        return ExitCode::from(2);
    };
    match draw(Path::new(&dir)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn draw(dir: &Path) -> Result<(), FileError> {
    let files = |name: &str| (dir.join(format!("{name}.svg")), dir.join(format!("{name}.png")));
    let cells: Vec<Vec<Measured>> = NOISES.map(measured).to_vec();
    let (svg, png) = files("entropy");
    entropy(&cells).save(svg, png)?;
    let (svg, png) = files("error");
    error(&cells).save(svg, png)?;
    let (svg, png) = files("posteriors");
    posteriors(&cells).save(svg, png)?;
    let (svg, png) = files("one-cell");
    one_cell(&cells).save(svg, png)
}

/// The belief about a cell after 1, 2, … readings.
type Measured = Vec<Histogram>;

/// Measures all cells with a noise.
fn measured(noise: f64) -> Vec<Measured> {
    let cell = |seed: u64| {
        let mut random = Random(seed);
        let mut belief = Histogram::uniform(BINS);
        let measure = |_| {
            let reading = COVERAGE + noise * random.normal();
            let likelihood = |bin| {
                let off = (bin_coverage(bin, BINS) - reading) / noise;
                // A little for every coverage, so that no reading rules one out.
                libm::exp(-0.5 * off * off) + 0.01
            };
            let evidence: Vec<f64> = (0..BINS).map(likelihood).collect();
            let mut weights = vec![0.0; BINS];
            product(belief.probabilities(), &evidence, &mut weights);
            belief = Histogram::from_weights(&weights).unwrap_or_else(|| belief.clone());
            belief.clone()
        };
        (0..READINGS).map(measure).collect()
    };
    (1..=CELLS).map(cell).collect()
}

/// Numbers that look random, and are the same every time.
struct Random(u64);

impl Random {
    /// Draws a number in [0, 1): a linear congruential generator.
    fn uniform(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).unwrap_or(0)) / 4_294_967_296.0
    }

    /// Draws a nearly normal number: a sum of twelve has the variance 1.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

fn series(noise: f64, points: Vec<ChartPoint>) -> Series {
    Series { name: format!("σ = {noise}"), points, line: true, marks: true }
}

/// Returns the mean over all cells of a number after `readings` readings, with a bar from the 5th
/// to the 95th percentile.
fn point(cells: &[Measured], readings: usize, of: impl Fn(&Histogram) -> f64) -> ChartPoint {
    let mut values: Vec<f64> = cells.iter().map(|cell| of(&cell[readings - 1])).collect();
    values.sort_by(f64::total_cmp);
    let mean = values.iter().sum::<f64>() / count(values.len());
    let at = |share: usize| values[(values.len() - 1) * share / 100];
    ChartPoint { low: at(5), high: at(95), ..ChartPoint::new(count(readings), mean) }
}

fn count(n: usize) -> f64 {
    n as f64
}

/// Returns a chart of lines with error bars.
fn entropy(cells: &[Vec<Measured>]) -> Chart {
    let curve = |(noise, cells): (f64, &Vec<Measured>)| {
        let readings = (1..=READINGS).step_by(4);
        series(noise, readings.map(|n| point(cells, n, Histogram::entropy)).collect())
    };
    Chart {
        title: "Entropy of a cell that is measured again and again".into(),
        subtitle: format!(
            "simulated readings of cells that are covered 20 %; mean of {CELLS} cells, bars from the 5th to the 95th percentile"
        ),
        x: ChartAxis::new("readings"),
        y: ChartAxis { from: Some(0.0), ..ChartAxis::new("entropy [nats]") },
        series: NOISES.into_iter().zip(cells).map(curve).collect(),
    }
}

/// Returns a chart with two logarithmic axes.
fn error(cells: &[Vec<Measured>]) -> Chart {
    let off = |belief: &Histogram| (belief.mean() - COVERAGE).abs();
    let curve = |(noise, cells): (f64, &Vec<Measured>)| {
        let mean = |n| ChartPoint::new(count(n), point(cells, n, off).y);
        series(noise, [1, 2, 4, 8, 16, 32, READINGS].map(mean).to_vec())
    };
    // Of a mean of n numbers with σ = .4: √(2/π) · σ/√n.
    let expected = |n: f64| ChartPoint::new(n, 0.8 * 0.4 / n.sqrt());
    let expected = vec![expected(1.0), expected(count(READINGS))];
    let plain = Series {
        marks: false,
        name: "a mean of readings, σ = 0.4".into(),
        ..series(0.4, expected)
    };
    Chart {
        title: "Error of the expected coverage".into(),
        subtitle: format!(
            "simulated readings of cells that are covered 20 %; mean of {CELLS} cells"
        ),
        x: ChartAxis::logarithmic("readings"),
        y: ChartAxis::logarithmic("mean error of the coverage"),
        series: NOISES.into_iter().zip(cells).map(curve).chain([plain]).collect(),
    }
}

/// Returns panels that share a legend: the posterior after some numbers of readings.
fn posteriors(cells: &[Vec<Measured>]) -> Figure {
    let panel = |readings: usize| {
        let curve = |(noise, cells): (f64, &Vec<Measured>)| {
            let mean = |bin: usize| {
                let y = point(cells, readings, |belief| belief.probabilities()[bin]).y;
                ChartPoint::new(bin_coverage(bin, BINS), y)
            };
            series(noise, (0..BINS).map(mean).collect())
        };
        let chart = Chart {
            title: format!("after {readings}"),
            subtitle: String::new(),
            x: ChartAxis::new("coverage"),
            y: ChartAxis { from: Some(0.0), to: Some(1.0), ..ChartAxis::new("probability") },
            series: NOISES.into_iter().zip(cells).map(curve).collect(),
        };
        chart.into()
    };
    Figure {
        title: "The posterior of a cell that is covered 20 %".into(),
        subtitle: format!("simulated; mean of {CELLS} cells, by the number of readings"),
        panels: [1, 4, 16, READINGS].map(panel).to_vec(),
        columns: 4,
    }
}

/// Returns heat maps: the posterior of a single cell, reading by reading.
fn one_cell(cells: &[Vec<Measured>]) -> Figure {
    let readings: Vec<f64> = (1..=READINGS).map(count).collect();
    let coverages: Vec<f64> = (0..BINS).map(|bin| bin_coverage(bin, BINS)).collect();
    let panel = |(noise, cells): (f64, &Vec<Measured>)| {
        let row = |bin: usize| cells[0].iter().map(move |belief| belief.probabilities()[bin]);
        let map = HeatMap {
            title: format!("σ = {noise}"),
            subtitle: String::new(),
            x: ChartAxis::new("readings"),
            y: ChartAxis::new("coverage"),
            value: ChartAxis { from: Some(0.0), to: Some(1.0), ..ChartAxis::new("probability") },
            x_edges: HeatMap::edges(&readings),
            y_edges: HeatMap::edges(&coverages),
            values: (0..BINS).flat_map(row).collect(),
            color_map: ColorMap::Viridis,
        };
        map.into()
    };
    Figure {
        title: "The posterior of one simulated cell that is covered 20 %".into(),
        panels: NOISES.into_iter().zip(cells).map(panel).collect(),
        columns: 2,
        ..Figure::default()
    }
}
