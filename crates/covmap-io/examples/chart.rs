//! Draws the charts of a report: lines with error bars, a logarithmic axis, the profiles of a
//! fit, and a heat map, each as SVG and PNG.
//!
//! ```text
//! cargo run -p covmap-io --example chart -- DIR
//! ```

use covmap_io::{Chart, ChartAxis, ChartPoint, ColorMap, Figure, FileError, HeatMap, Series};
use std::path::Path;
use std::process::ExitCode;

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
    let (svg, png) = files("strategies");
    strategies().save(svg, png)?;
    let (svg, png) = files("decades");
    decades().save(svg, png)?;
    let (svg, png) = files("profiles");
    profiles().save(svg, png)?;
    let (svg, png) = files("model");
    model().save(svg, png)
}

fn series(name: &str, points: Vec<ChartPoint>) -> Series {
    Series { name: name.into(), points, line: true, marks: true }
}

/// The entropy that five strategies leave, with the spread of several runs.
fn strategies() -> Chart {
    let names = ["CL", "IG", "IG_WIN(3 m)", "IG_CL(0.3)", "random view-points"];
    let rates = [41.0, 55.0, 33.0, 27.0, 90.0];
    let curve = |rate: f64| {
        let point = |i: i32| {
            let x = 8.0 * f64::from(i);
            let y = 100.0 / (1.0 + x / rate) + 4.0 * libm::sin(x / rate);
            let spread = 2.0 + 0.05 * (100.0 - y);
            ChartPoint { x, y, low: y - spread, high: y + spread }
        };
        (0..=15).map(point).collect()
    };
    Chart {
        title: "Entropy left after so many metres".into(),
        subtitle: "Office, 20 × 12 m, ring of 24 sonars; mean and 95 % interval of 5 seeds".into(),
        x: ChartAxis::new("driven [m]"),
        y: ChartAxis { from: Some(0.0), ..ChartAxis::new("entropy of the map [% of the start]") },
        series: names.iter().zip(rates).map(|(name, rate)| series(name, curve(rate))).collect(),
    }
}

/// Two logarithmic axes.
fn decades() -> Chart {
    let power = |scale: f64, exponent: f64| -> Vec<ChartPoint> {
        let point = |i: i32| {
            let x = libm::pow(10.0, f64::from(i) / 3.0);
            let y = scale * libm::pow(x, exponent);
            ChartPoint { x, y, low: y / 1.5, high: y * 1.4 }
        };
        (0..=12).map(point).collect()
    };
    Chart {
        title: "Time of a decision".into(),
        subtitle: "median and quartiles of 1000 decisions".into(),
        x: ChartAxis::logarithmic("candidates"),
        y: ChartAxis::logarithmic("time [s]"),
        series: vec![
            series("as printed", power(4e-4, 1.0)),
            series("with a cache of beams", power(1e-4, 0.7)),
            Series {
                marks: false,
                ..series("a second", vec![ChartPoint::new(1.0, 1.0), ChartPoint::new(1e4, 1.0)])
            },
        ],
    }
}

/// How the likelihood falls around its best, for each of twelve parameters.
fn profiles() -> Figure {
    let names = [
        "σ_in [m]",
        "σ_out [m]",
        "α",
        "β",
        "opening angle [rad]",
        "free [m]",
        "range of trust [m]",
        "λ [1/m]",
        "p(echo)",
        "ξ",
        "width of the peak",
        "τ",
    ];
    let panel = |(index, name): (usize, &&str)| {
        let best = 0.02 * libm::pow(2.7, f64::from(u8::try_from(index % 7).unwrap_or(0)));
        let profile = |bend: f64| -> Vec<ChartPoint> {
            let point = |i: i32| {
                let x = best * (1.0 + f64::from(i) / 12.0);
                ChartPoint::new(x, -21_480.0 - bend * f64::from(i * i) - f64::from(i))
            };
            (-8..=8).map(point).collect()
        };
        let chart = Chart {
            title: String::new(),
            subtitle: String::new(),
            x: ChartAxis::new(*name),
            y: ChartAxis::new(if index % 4 == 0 { "log-likelihood [nats]" } else { "" }),
            series: vec![
                series("fitted to all scans", profile(2.0 + index as f64)),
                series("held-out scans", profile(1.5)),
            ],
        };
        chart.into()
    };
    Figure {
        title: "Profiles of the likelihood".into(),
        subtitle: "each parameter alone, the others as fitted".into(),
        panels: names.iter().enumerate().map(panel).collect(),
        columns: 4,
    }
}

/// A sensor model: p(c = x | d) over the distance from the measured range.
fn model() -> Figure {
    let panel = |range: f64| {
        let distances: Vec<f64> = (0..120).map(|i| (f64::from(i) + 0.5) * 0.025).collect();
        let coverages: Vec<f64> = (0..21).map(|i| f64::from(i) / 20.0).collect();
        let density = |distance: f64, coverage: f64| {
            let offset = (distance - range) / (0.1 + 0.05 * range);
            let mean = 0.8 * libm::exp(-offset * offset) + if offset > 1.0 { 0.4 } else { 0.0 };
            let width = 0.12 + if offset > 1.0 { 0.3 } else { 0.0 };
            libm::exp(-0.5 * ((coverage - mean) / width) * ((coverage - mean) / width))
                / width
                / 20.0
        };
        let row = |c: &f64| distances.iter().map(|d| density(*d, *c)).collect::<Vec<f64>>();
        let map = HeatMap {
            title: format!("Range {range} m"),
            subtitle: String::new(),
            x: ChartAxis::new("distance of the cell [m]"),
            y: ChartAxis::new("coverage"),
            value: ChartAxis { from: Some(0.0), ..ChartAxis::new("p(c = x | d)") },
            x_edges: HeatMap::edges(&distances),
            y_edges: HeatMap::edges(&coverages),
            values: coverages.iter().flat_map(row).collect(),
            color_map: ColorMap::Viridis,
        };
        map.into()
    };
    Figure {
        title: "Coverage of a cell, given a range".into(),
        panels: [0.6, 1.2, 1.8, 2.4].map(panel).to_vec(),
        columns: 2,
        ..Figure::default()
    }
}
