//! Charts for reports: lines, points with error bars, and heat maps, as SVG and as PNG.
//!
//! Both are made of the same shapes, so that they look the same; letters are measured with the
//! font that is shipped, and the same data make the same bytes.

mod area;
mod drawing;
mod figure;
mod heat;
mod marks;
mod paint;
mod panel;
mod scale;
mod scene;
mod svg;

use crate::ColorMap;
use covmap_io::{FileError, Replace, write_file};
pub use drawing::{Drawing, TextAnchor};
use std::io;
use std::path::Path;

/// A chart of series of points over two axes.
///
/// Points that are not finite, or beyond ±10³⁰⁰, are left out and break their line, as are
/// values that are not positive on a logarithmic axis; a chart without points says so.
///
/// ```
/// use covmap_draw::{Chart, ChartAxis, ChartPoint, Series};
///
/// let errors = [(1.0, 0.062, 0.055, 0.071), (2.0, 0.041, 0.037, 0.046)];
/// let point = |(x, y, low, high)| ChartPoint { low, high, ..ChartPoint::new(x, y) };
/// let points = errors.map(point);
/// let chart = Chart {
///     title: "Error of the map".into(),
///     subtitle: "mean and 95 % interval of 5 seeds".into(),
///     x: ChartAxis::new("driven [m]"),
///     y: ChartAxis { from: Some(0.0), ..ChartAxis::new("mean error of the coverage") },
///     series: vec![Series {
///         name: "IG_CL".into(),
///         points: points.to_vec(),
///         line: true,
///         marks: true,
///     }],
/// };
/// assert!(chart.to_svg().contains("driven [m]"));
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chart {
    /// What it shows, above it; may be empty.
    pub title: String,
    /// A smaller line under the title: of what, how often; may be empty.
    pub subtitle: String,
    /// The axis to the right.
    pub x: ChartAxis,
    /// The axis upwards.
    pub y: ChartAxis,
    /// What is drawn; the later lies above the earlier.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChartAxis {
    /// The quantity and its unit, such as `driven [m]`.
    pub label: String,
    /// Where it begins; without, and if that is not finite, where the values do.
    pub from: Option<f64>,
    /// Where it ends; without, and if that is not finite, where the values do.
    pub to: Option<f64>,
    /// Whether equal lengths are equal ratios.
    pub logarithmic: bool,
    /// What the values 1, 2, 3, … are called, instead of round numbers, on the axis to the
    /// right of a chart; a line break in a name begins a second line.
    pub names: Vec<String>,
}

/// Points that belong together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend; without one it is not in the legend.
    pub name: String,
    /// In the order in which a line runs through them.
    pub points: Vec<ChartPoint>,
    /// Whether a line joins them.
    pub line: bool,
    /// Whether each has a mark.
    pub marks: bool,
}

/// A point with an error bar.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ChartPoint {
    /// To the right.
    pub x: f64,
    /// Upwards.
    pub y: f64,
    /// The lower end of the error bar; the same as `y`, or NaN: none.
    pub low: f64,
    /// The upper end of the error bar; the same as `y`, or NaN: none.
    pub high: f64,
    /// Whether its mark is drawn hollow, for a value that is not like the others, such as that
    /// of a run that was cut short. The subtitle should say what it means.
    pub hollow: bool,
}

/// A value over two axes as colours, such as p(c = x | d) over distance and coverage.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// What it shows, above it; may be empty.
    pub title: String,
    /// A smaller line under the title; may be empty.
    pub subtitle: String,
    /// The axis to the right.
    pub x: ChartAxis,
    /// The axis upwards.
    pub y: ChartAxis,
    /// The scale of the colours.
    pub value: ChartAxis,
    /// The edges of the columns, one more than there are; [`HeatMap::edges`] finds them from
    /// the centres.
    pub x_edges: Vec<f64>,
    /// The edges of the rows, one more than there are.
    pub y_edges: Vec<f64>,
    /// Row by row from the first pair of edges on. A cell without a value, or whose value is
    /// not finite, stays white.
    pub values: Vec<f64>,
    /// Which colours.
    pub color_map: ColorMap,
}

/// A part of a figure.
#[derive(Debug, Clone, PartialEq)]
pub enum Panel {
    /// Series over two axes.
    Chart(Chart),
    /// A value over two axes.
    HeatMap(HeatMap),
}

/// Several charts side by side.
///
/// If the same name means the same series in all of them, they share one legend.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figure {
    /// What all of them show; may be empty.
    pub title: String,
    /// A smaller line under the title; may be empty.
    pub subtitle: String,
    /// Row by row from the top left.
    pub panels: Vec<Panel>,
    /// How many stand side by side: 1 to 12; any other number counts as the nearest of these.
    pub columns: usize,
}

impl ChartAxis {
    /// A linear axis as long as its values need.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// An axis of things that have names: the values 1, 2, 3, …
    pub fn named(label: impl Into<String>, names: Vec<String>) -> Self {
        let to = names.len() as f64 + 0.5;
        Self { from: Some(0.5), to: Some(to), names, ..Self::new(label) }
    }

    /// A logarithmic axis as long as its values need.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self { logarithmic: true, ..Self::new(label) }
    }
}

impl ChartPoint {
    /// A point without an error bar.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, low: y, high: y, hollow: false }
    }
}

impl HeatMap {
    /// The edges of cells with these centres: half-way between two of them.
    pub fn edges(centers: &[f64]) -> Vec<f64> {
        let step = |a: usize, b: usize| (centers[b] - centers[a]) / 2.0;
        match centers.len() {
            0 => Vec::new(),
            1 => vec![centers[0] - 0.5, centers[0] + 0.5],
            n => {
                let inner = centers.windows(2).map(|pair| pair[0].midpoint(pair[1]));
                let first = centers[0] - step(0, 1);
                let last = centers[n - 1] + step(n - 2, n - 1);
                std::iter::once(first).chain(inner).chain([last]).collect()
            }
        }
    }
}

impl From<Chart> for Panel {
    fn from(chart: Chart) -> Self {
        Self::Chart(chart)
    }
}

impl From<HeatMap> for Panel {
    fn from(map: HeatMap) -> Self {
        Self::HeatMap(map)
    }
}

impl Figure {
    fn of(panel: impl Into<Panel>) -> Self {
        Self { panels: vec![panel.into()], columns: 1, ..Self::default() }
    }

    /// The figure as an SVG document.
    pub fn to_svg(&self) -> String {
        self.lay_out().to_svg()
    }

    /// The figure as a PNG of twice as many pixels a side.
    ///
    /// # Errors
    /// If it is too large for that.
    pub fn to_png(&self) -> io::Result<Vec<u8>> {
        self.lay_out().paint().to_png()
    }

    /// Writes the figure as an SVG and as a PNG of twice as many pixels a side. Old files are
    /// replaced.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn save(&self, svg: impl AsRef<Path>, png: impl AsRef<Path>) -> Result<(), FileError> {
        let scene = self.lay_out();
        write_file(svg, scene.to_svg().as_bytes(), Replace::Any)?;
        scene.paint().save(png.as_ref())
    }
}

impl Chart {
    /// The chart as an SVG document.
    pub fn to_svg(&self) -> String {
        Figure::of(self.clone()).to_svg()
    }

    /// Writes the chart as an SVG and as a PNG of twice as many pixels a side.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn save(&self, svg: impl AsRef<Path>, png: impl AsRef<Path>) -> Result<(), FileError> {
        Figure::of(self.clone()).save(svg, png)
    }
}

impl HeatMap {
    /// The heat map as an SVG document.
    pub fn to_svg(&self) -> String {
        Figure::of(self.clone()).to_svg()
    }

    /// Writes the heat map as an SVG and as a PNG of twice as many pixels a side.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn save(&self, svg: impl AsRef<Path>, png: impl AsRef<Path>) -> Result<(), FileError> {
        Figure::of(self.clone()).save(svg, png)
    }
}

#[cfg(test)]
mod tests;
