//! The pixels of a picture.

use super::canvas::Canvas;
use super::color::Rgb;
use super::furniture::{Furniture, MARGIN};
use super::labels::place_labels;
use super::{Overlay, Picture};
use nalgebra::Point2;

/// The least width of the items under a map \[pixels\].
const LEAST_WIDTH: usize = 560;
const TITLE_SIZE: f32 = 26.0;
const SUBTITLE_SIZE: f32 = 17.0;
const LABEL_SIZE: f32 = 17.0;

impl Picture {
    /// Returns the number of pixels of a metre.
    pub(super) fn scale(&self) -> f64 {
        self.pixels_per_cell as f64 / (self.cells_per_pixel as f64 * self.grid.resolution())
    }

    /// Returns the pixel of the map at which a point of the world lies.
    #[allow(clippy::cast_possible_truncation, reason = "pixels")]
    fn to_pixel(&self, point: Point2<f64>) -> [f32; 2] {
        let from = point - self.grid.lower_left();
        let top = self.grid.height() as f64 * self.grid.resolution();
        [(from.x * self.scale()) as f32, ((top - from.y) * self.scale()) as f32]
    }

    /// Draws the whole picture.
    #[allow(clippy::cast_possible_truncation, reason = "a few thousand pixels")]
    pub(super) fn render(&self) -> Canvas {
        let map = self.render_map();
        let inner = (map.width() as usize).max(LEAST_WIDTH) as f32;
        let headings = [
            (self.title.as_deref(), TITLE_SIZE, Rgb::INK),
            (self.subtitle.as_deref(), SUBTITLE_SIZE, Rgb::GREY_INK),
        ];
        let headings: Vec<(&str, f32, Rgb)> = headings
            .into_iter()
            .filter_map(|(text, size, color)| text.map(|text| (text, size, color)))
            .collect();
        let above: f32 = headings.iter().map(|(_, size, _)| size * 1.5).sum();
        let map_top = (MARGIN + above).round();
        let furniture = Furniture::lay_out(self, inner);
        let below = map_top + map.height() as f32;
        let width = inner + 2.0 * MARGIN;
        let height = below + furniture.height() + MARGIN;
        let mut canvas = Canvas::new(width as u32, height.ceil() as u32, Rgb::WHITE);
        let mut baseline = MARGIN;
        for (text, size, color) in headings {
            let fitting = fit(text, size, inner);
            canvas.text(text, fitting, [MARGIN, baseline + 0.85 * size], color, false);
            baseline += size * 1.5;
        }
        canvas.paste(MARGIN as i32, map_top as i32, &map);
        let (map_width, map_height) = (map.width() as f32, map.height() as f32);
        canvas.frame(MARGIN - 0.5, map_top - 0.5, map_width + 1.0, map_height + 1.0, Rgb::GREY_INK);
        furniture.draw(&mut canvas, below);
        canvas
    }

    /// Draws the map alone, with all overlays and labels.
    fn render_map(&self) -> Canvas {
        let mut canvas = self.render_cells();
        for overlay in &self.overlays {
            #[allow(clippy::cast_possible_truncation, reason = "pixels")]
            match overlay {
                Overlay::Line { points, color, width } => {
                    let points: Vec<[f32; 2]> = points.iter().map(|p| self.to_pixel(*p)).collect();
                    canvas.polyline(&points, *color, *width as f32, 1.0);
                }
                Overlay::Marker { point, marker, color, size } => {
                    let at = self.to_pixel(*point);
                    if at.iter().all(|v| v.is_finite()) {
                        canvas.marker(at, *marker, *color, *size as f32);
                    }
                }
            }
        }
        let labels: Vec<(&str, [f32; 2])> =
            self.labels.iter().map(|(text, at)| (text.as_str(), self.to_pixel(*at))).collect();
        for (text, at) in place_labels(&labels, LABEL_SIZE, canvas.width(), canvas.height()) {
            canvas.text(text, LABEL_SIZE, at, Rgb::INK, true);
        }
        canvas
    }

    fn render_cells(&self) -> Canvas {
        let (columns, rows) = (self.grid.width(), self.grid.height());
        let (step, side) = (self.cells_per_pixel, self.pixels_per_cell);
        let (across, down) = (columns.div_ceil(step), rows.div_ceil(step));
        #[allow(clippy::cast_possible_truncation, reason = "a few thousand pixels")]
        let mut canvas = Canvas::new((across * side) as u32, (down * side) as u32, Rgb::WHITE);
        for y in 0..down {
            // Blocks of cells are counted from the top left, as pixels are.
            let block_rows = rows.saturating_sub((y + 1) * step)..rows - y * step;
            for x in 0..across {
                let block = x * step..((x + 1) * step).min(columns);
                let color = if step == 1 {
                    self.colors[block_rows.start * columns + block.start]
                } else {
                    let row = |row: usize| &self.colors[row * columns..][block.clone()];
                    average(block_rows.clone().flat_map(row))
                };
                canvas.block(x * side, y * side, side, side, color);
            }
        }
        canvas
    }
}

/// Returns the size at which text is at most `width` wide.
fn fit(text: &str, size: f32, width: f32) -> f32 {
    size * (width / super::text::text_width(text, size).max(1.0)).min(1.0)
}

fn average<'a>(colors: impl Iterator<Item = &'a Rgb>) -> Rgb {
    let (mut sum, mut count) = ([0u64; 3], 0u64);
    for Rgb(r, g, b) in colors {
        count += 1;
        for (sum, part) in sum.iter_mut().zip([r, g, b]) {
            *sum += u64::from(*part);
        }
    }
    #[allow(clippy::cast_possible_truncation, reason = "the mean of bytes")]
    let [r, g, b] = sum.map(|sum| ((sum + count / 2) / count.max(1)) as u8);
    Rgb(r, g, b)
}
