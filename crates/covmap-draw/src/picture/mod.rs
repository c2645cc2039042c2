//! Pictures of rasters, with lines, markers and words on them.

pub(crate) mod canvas;
mod color;
pub(crate) mod furniture;
mod labels;
mod render;
pub(crate) mod text;

pub use color::{ColorMap, Rgb, coverage_color};

use covmap::{Grid, Raster};
use covmap_io::FileError;
use nalgebra::Point2;
use std::io;
use std::path::Path;

/// The longest side of a map in a picture by default \[pixels\].
const USUAL_SIDE: usize = 1200;
/// The longest side of a map in any picture \[pixels\].
const LARGEST_SIDE: usize = 3600;

/// The symbol of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Marker {
    /// A filled disc.
    Disc,
    /// A circle.
    Ring,
    /// A diagonal cross.
    Cross,
    /// An arrow head.
    Arrow {
        /// Direction of the arrow \[rad\], counter-clockwise from the x axis.
        heading: f64,
    },
}

/// The symbol that an entry of the legend explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Key {
    /// Cells of a colour.
    Fill(Rgb),
    /// A line of a colour.
    Line(Rgb),
    /// A marker of a colour.
    Marker(Marker, Rgb),
}

#[derive(Debug, Clone)]
enum Overlay {
    Line { points: Vec<Point2<f64>>, color: Rgb, width: f64 },
    Marker { point: Point2<f64>, marker: Marker, color: Rgb, size: f64 },
}

#[derive(Debug, Clone)]
struct ColorBar {
    title: String,
    range: (f64, f64),
    /// From the lowest to the highest value.
    colors: Vec<Rgb>,
}

/// A picture of a map: coloured cells, with lines, markers and labels over them, and a title,
/// a scale bar and a legend around it.
///
/// Points are in the world \[m\], x to the right and y up; widths and sizes in pixels. Later items
/// lie above earlier ones; labels lie on top.
///
/// ```no_run
/// use covmap::{Grid, Raster};
/// use covmap_draw::{Key, Marker, Picture, Rgb, coverage_color};
/// use nalgebra::Point2;
///
/// let grid = Grid::new(Point2::origin(), 0.1, 200, 120)?;
/// let map = Raster::filled(grid, Some(0.0));
/// Picture::new(grid)
///     .title("Office, after 57 scans")
///     .cells(&map, |coverage| coverage_color(*coverage))
///     .polyline(&[Point2::new(1.0, 6.0), Point2::new(8.0, 6.5)], Rgb::BLUE, 2.5)
///     .marker(Point2::new(1.0, 6.0), Marker::Disc, Rgb::GREEN, 14.0)
///     .label("start", Point2::new(1.0, 6.0))
///     .scale_bar()
///     .legend(&[(Rgb::UNKNOWN, "unknown"), (Rgb::WHITE, "free")])
///     .key(Key::Line(Rgb::BLUE), "trajectory")
///     .save("coverage.png")?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Picture {
    grid: Grid,
    colors: Vec<Rgb>,
    pixels_per_cell: usize,
    /// Number of cells a side that share one pixel: 1, or more where a map is too large.
    cells_per_pixel: usize,
    overlays: Vec<Overlay>,
    labels: Vec<(String, Point2<f64>)>,
    title: Option<String>,
    subtitle: Option<String>,
    scale_bar: bool,
    keys: Vec<(Key, String)>,
    color_bar: Option<ColorBar>,
}

impl Picture {
    /// Creates a white picture of a grid. A cell has as many pixels as make the longer side of the
    /// grid about 1200 pixels; in a larger grid several cells share a pixel.
    pub fn new(grid: Grid) -> Self {
        let side = grid.width().max(grid.height());
        Self {
            grid,
            colors: vec![Rgb::WHITE; grid.len()],
            pixels_per_cell: ((USUAL_SIDE + USUAL_SIDE / 6) / side).clamp(1, USUAL_SIDE),
            cells_per_pixel: if side > USUAL_SIDE * 3 / 2 { side.div_ceil(USUAL_SIDE) } else { 1 },
            overlays: Vec::new(),
            labels: Vec::new(),
            title: None,
            subtitle: None,
            scale_bar: false,
            keys: Vec::new(),
            color_bar: None,
        }
    }

    /// Sets the number of pixels of a cell's side; fewer, where the picture would be larger than 3600 pixels.
    pub fn pixels_per_cell(&mut self, pixels: usize) -> &mut Self {
        let side = self.grid.width().max(self.grid.height());
        self.pixels_per_cell = pixels.clamp(1, (LARGEST_SIDE / side).max(1));
        self.cells_per_pixel = side.div_ceil(LARGEST_SIDE);
        self
    }

    /// Colours the cells. The raster may have another grid: each cell takes the colour of the
    /// raster at its centre, and keeps its own outside the raster.
    pub fn cells<T>(&mut self, raster: &Raster<T>, color: impl Fn(&T) -> Rgb) -> &mut Self {
        self.overlay(raster, 1.0, |value| Some(color(value)))
    }

    /// Colours cells over their present colours, as [`Self::cells`] does, but only where there is a
    /// colour, and only as far as `opacity` in [0, 1] says.
    pub fn overlay<T>(
        &mut self,
        raster: &Raster<T>,
        opacity: f64,
        color: impl Fn(&T) -> Option<Rgb>,
    ) -> &mut Self {
        let same = raster.grid() == &self.grid;
        for (index, out) in self.colors.iter_mut().enumerate() {
            let value = if same {
                Some(&raster[index])
            } else {
                let center = self.grid.center(self.grid.cell(index));
                raster.grid().cell_at(center).and_then(|cell| raster.get(cell))
            };
            if let Some(color) = value.and_then(&color) {
                *out = out.mix(color, opacity);
            }
        }
        self
    }

    /// Draws a line through points. A point that is not finite breaks the line; a single point is a
    /// dot. A line with a width that is negative or no number is not drawn.
    pub fn polyline(&mut self, points: &[Point2<f64>], color: Rgb, width: f64) -> &mut Self {
        self.overlays.push(Overlay::Line { points: points.to_vec(), color, width });
        self
    }

    /// Draws a marker of a diameter.
    pub fn marker(
        &mut self,
        point: Point2<f64>,
        marker: Marker,
        color: Rgb,
        size: f64,
    ) -> &mut Self {
        self.overlays.push(Overlay::Marker { point, marker, color, size });
        self
    }

    /// Writes a label beside a point, where it meets no other label and stays in the map.
    pub fn label(&mut self, text: &str, at: Point2<f64>) -> &mut Self {
        self.labels.push((text.to_string(), at));
        self
    }

    /// Writes a title above the map.
    pub fn title(&mut self, text: &str) -> &mut Self {
        self.title = Some(text.to_string());
        self
    }

    /// Writes a smaller line under the title.
    pub fn subtitle(&mut self, text: &str) -> &mut Self {
        self.subtitle = Some(text.to_string());
        self
    }

    /// Draws a bar of a round length in metres under the map.
    pub fn scale_bar(&mut self) -> &mut Self {
        self.scale_bar = true;
        self
    }

    /// Adds colours of cells to the legend under the map.
    pub fn legend(&mut self, entries: &[(Rgb, &str)]) -> &mut Self {
        entries.iter().for_each(|(color, text)| {
            self.key(Key::Fill(*color), text);
        });
        self
    }

    /// Adds an entry to the legend under the map.
    pub fn key(&mut self, key: Key, text: &str) -> &mut Self {
        self.keys.push((key, text.to_string()));
        self
    }

    /// Draws a bar of colours under the map, from the value `low` to the value `high`. `color` takes the
    /// share in [0, 1] of the way from `low` to `high`. The title should name the quantity and its unit.
    pub fn color_bar(
        &mut self,
        title: &str,
        low: f64,
        high: f64,
        color: impl Fn(f64) -> Rgb,
    ) -> &mut Self {
        let colors = (0..=255u8).map(|i| color(f64::from(i) / 255.0)).collect();
        self.color_bar = Some(ColorBar { title: title.to_string(), range: (low, high), colors });
        self
    }

    /// Returns the picture as pixels: its width, its height, and red, green and blue of each pixel,
    /// row by row from the top.
    pub fn pixels(&self) -> (u32, u32, Vec<u8>) {
        let canvas = self.render();
        (canvas.width(), canvas.height(), canvas.rgb())
    }

    /// Returns the picture as a PNG.
    ///
    /// # Errors
    /// If the picture is too large for a PNG.
    pub fn to_png(&self) -> io::Result<Vec<u8>> {
        self.render().to_png()
    }

    /// Writes the picture as a PNG. An old file is replaced.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), FileError> {
        self.render().save(path.as_ref())
    }
}

#[cfg(test)]
mod tests;
