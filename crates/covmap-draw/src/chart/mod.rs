//! Charts for reports: lines, points with error bars, and heat maps, as SVG and as PNG.
//!
//! Both formats are made of the same shapes, so they look the same. Letters are measured with the
//! shipped font, and the same data make the same bytes.

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
/// Points that are not finite, or beyond ±10³⁰⁰, are left out and break their line, as are values
/// that are not positive on a logarithmic axis. A chart without points says so.
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
    /// Title above the chart; may be empty.
    pub title: String,
    /// A smaller line under the title, on the data and their number; may be empty.
    pub subtitle: String,
    /// The axis to the right.
    pub x: ChartAxis,
    /// The axis upwards.
    pub y: ChartAxis,
    /// Series of the chart; later ones lie above earlier ones.
    pub series: Vec<Series>,
}

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ChartAxis {
    /// The quantity and its unit, such as `driven [m]`.
    pub label: String,
    /// Beginning of the axis; that of the values if it is `None` or not finite.
    pub from: Option<f64>,
    /// End of the axis; that of the values if it is `None` or not finite.
    pub to: Option<f64>,
    /// Whether equal lengths are equal ratios.
    pub logarithmic: bool,
    /// Names of the values 1, 2, 3, … on the axis to the right of a chart, instead of round
    /// numbers; a line break in a name begins a second line.
    pub names: Vec<String>,
}

/// Points that belong together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Name in the legend; a series without a name is not in the legend.
    pub name: String,
    /// Points in the order of the line through them.
    pub points: Vec<ChartPoint>,
    /// Whether a line joins the points.
    pub line: bool,
    /// Whether each point has a mark.
    pub marks: bool,
}

/// A point with an error bar.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ChartPoint {
    /// Value to the right.
    pub x: f64,
    /// Value upwards.
    pub y: f64,
    /// The lower end of the error bar; `y` or NaN for none.
    pub low: f64,
    /// The upper end of the error bar; `y` or NaN for none.
    pub high: f64,
    /// Whether the mark is hollow, for a value unlike the others, such as that of a run that was
    /// cut short. The subtitle should explain hollow marks.
    pub hollow: bool,
}

/// A value over two axes as colours, such as p(c = x | d) over distance and coverage.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Title above the heat map; may be empty.
    pub title: String,
    /// A smaller line under the title; may be empty.
    pub subtitle: String,
    /// The axis to the right.
    pub x: ChartAxis,
    /// The axis upwards.
    pub y: ChartAxis,
    /// The scale of the colours.
    pub value: ChartAxis,
    /// The edges of the columns, one more than there are columns; [`HeatMap::edges`] finds the
    /// edges from the centres.
    pub x_edges: Vec<f64>,
    /// The edges of the rows, one more than there are rows.
    pub y_edges: Vec<f64>,
    /// Values, row by row from the first pair of edges on. A cell whose value is missing or not
    /// finite stays white.
    pub values: Vec<f64>,
    /// Colours of the values.
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
/// The charts share one legend if the same name means the same series in all of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figure {
    /// Title of the figure; may be empty.
    pub title: String,
    /// A smaller line under the title; may be empty.
    pub subtitle: String,
    /// Panels, row by row from the top left.
    pub panels: Vec<Panel>,
    /// Number of panels side by side: 1 to 12; any other number counts as the nearest of these.
    pub columns: usize,
}

impl ChartAxis {
    /// Returns a linear axis as long as its values need.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// Returns an axis of things that have names: the values 1, 2, 3, …
    pub fn named(label: impl Into<String>, names: Vec<String>) -> Self {
        let to = names.len() as f64 + 0.5;
        Self { from: Some(0.5), to: Some(to), names, ..Self::new(label) }
    }

    /// Returns a logarithmic axis as long as its values need.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self { logarithmic: true, ..Self::new(label) }
    }
}

impl ChartPoint {
    /// Returns a point without an error bar.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y, low: y, high: y, hollow: false }
    }
}

impl HeatMap {
    /// Returns the edges of cells with these centres: half-way between two centres.
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

    /// Returns the figure as an SVG document.
    pub fn to_svg(&self) -> String {
        self.lay_out().to_svg()
    }

    /// Returns the figure as a PNG of twice as many pixels a side.
    ///
    /// # Errors
    /// If the figure is too large for a PNG.
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
    /// Returns the chart as an SVG document.
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
    /// Returns the heat map as an SVG document.
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
