//! Shapes and text on pixels.

use super::Marker;
use super::color::Rgb;
use super::text::text_path;
use covmap_io::{FileError, Replace, write_file};
use std::io;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke,
    StrokeDash, Transform,
};

/// The widest line \[pixels\].
const WIDEST: f32 = 1e4;

/// An image to draw on; points in pixels from the top left.
#[derive(Debug, Clone)]
pub(crate) struct Canvas(Pixmap);

fn paint(color: Rgb, opacity: f32) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    let alpha = (opacity.clamp(0.0, 1.0) * 255.0).round();
    #[allow(clippy::cast_possible_truncation, reason = "in 0..=255")]
    paint.set_color_rgba8(color.0, color.1, color.2, alpha as u8);
    paint
}

impl Canvas {
    /// Creates a canvas of one colour. Sides of 0 count as 1.
    pub(crate) fn new(width: u32, height: u32, color: Rgb) -> Self {
        let pixmap = Pixmap::new(width.max(1), height.max(1));
        let mut pixmap = pixmap.expect("a few thousand pixels a side");
        pixmap.fill(tiny_skia::Color::from_rgba8(color.0, color.1, color.2, 255));
        Self(pixmap)
    }

    pub(crate) fn width(&self) -> u32 {
        self.0.width()
    }

    pub(crate) fn height(&self) -> u32 {
        self.0.height()
    }

    /// Returns the pixels row by row from the top: red, green, blue.
    pub(crate) fn rgb(&self) -> Vec<u8> {
        self.0.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
    }

    /// Returns the image as a PNG.
    pub(crate) fn to_png(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width(), self.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb())?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Writes the image as a PNG.
    pub(crate) fn save(&self, path: &std::path::Path) -> Result<(), FileError> {
        let png = self.to_png().map_err(FileError::io(path, "written"))?;
        write_file(path, &png, Replace::Any)
    }

    /// Colours a rectangle of whole pixels, which must lie in the canvas.
    pub(crate) fn block(&mut self, x: usize, y: usize, width: usize, height: usize, color: Rgb) {
        let row = self.0.width() as usize * 4;
        let pixels = self.0.data_mut();
        for y in y..y + height {
            for pixel in pixels[y * row + x * 4..][..width * 4].chunks_exact_mut(4) {
                pixel.copy_from_slice(&[color.0, color.1, color.2, 255]);
            }
        }
    }

    /// Draws another canvas with its top left corner at a pixel.
    pub(crate) fn paste(&mut self, x: i32, y: i32, other: &Canvas) {
        let paint = PixmapPaint::default();
        self.0.draw_pixmap(x, y, other.0.as_ref(), &paint, Transform::identity(), None);
    }

    /// Fills an outline.
    pub(crate) fn fill(&mut self, path: Option<Path>, color: Rgb) {
        if let Some(path) = path {
            let paint = paint(color, 1.0);
            self.0.fill_path(&path, &paint, FillRule::Winding, Transform::identity(), None);
        }
    }

    /// Draws along a path, at most [`WIDEST`] wide; nothing if the width is negative or no number.
    pub(crate) fn stroke(&mut self, path: Option<Path>, color: Rgb, width: f32, opacity: f32) {
        if let Some(path) = path.filter(|_| width >= 0.0) {
            let width = width.min(WIDEST);
            let (line_cap, line_join) = (LineCap::Round, LineJoin::Round);
            let stroke = Stroke { width, line_cap, line_join, ..Stroke::default() };
            self.0.stroke_path(&path, &paint(color, opacity), &stroke, Transform::identity(), None);
        }
    }

    /// Draws along a path with dashes: `dashes` has the lengths drawn and left out in turn \[pixels\].
    pub(crate) fn dash(&mut self, path: Option<Path>, color: Rgb, width: f32, dashes: &[f32]) {
        if let Some(path) = path {
            let dash = StrokeDash::new(dashes.to_vec(), 0.0);
            let stroke = Stroke { width, line_join: LineJoin::Round, dash, ..Stroke::default() };
            self.0.stroke_path(&path, &paint(color, 1.0), &stroke, Transform::identity(), None);
        }
    }

    /// Fills a rectangle.
    pub(crate) fn rectangle(&mut self, x: f32, y: f32, width: f32, height: f32, color: Rgb) {
        let rect = Rect::from_xywh(x, y, width, height);
        self.fill(rect.map(PathBuilder::from_rect), color);
    }

    /// Draws the outline of a rectangle.
    pub(crate) fn frame(&mut self, x: f32, y: f32, width: f32, height: f32, color: Rgb) {
        let rect = Rect::from_xywh(x, y, width, height);
        self.stroke(rect.map(PathBuilder::from_rect), color, 1.0, 1.0);
    }

    /// Draws a line through points; a single point is a dot. Points that are not finite break the line.
    pub(crate) fn polyline(&mut self, points: &[[f32; 2]], color: Rgb, width: f32, opacity: f32) {
        let mut path = PathBuilder::new();
        for piece in points.split(|p| !p.iter().all(|v| v.is_finite())) {
            let Some(([x, y], rest)) = piece.split_first() else { continue };
            path.move_to(*x, *y);
            // A line without length has round ends, which make the dot.
            if rest.is_empty() {
                path.line_to(*x + 0.01, *y);
            }
            rest.iter().for_each(|[x, y]| path.line_to(*x, *y));
        }
        self.stroke(path.finish(), color, width, opacity);
    }

    /// Draws a marker of a diameter, with a light rim that makes it visible on any ground.
    pub(crate) fn marker(&mut self, [x, y]: [f32; 2], marker: Marker, color: Rgb, size: f32) {
        let radius = size / 2.0;
        let line = (size / 6.0).max(2.0);
        let rim = (size / 8.0).clamp(1.5, 3.0);
        let light = Rgb::WHITE;
        let circle = |radius: f32| PathBuilder::from_circle(x, y, radius);
        match marker {
            Marker::Disc => {
                self.fill(circle(radius + rim), light);
                self.fill(circle(radius), color);
            }
            Marker::Ring => {
                self.stroke(circle(radius - line / 2.0), light, line + 2.0 * rim, 1.0);
                self.stroke(circle(radius - line / 2.0), color, line, 1.0);
            }
            Marker::Cross => {
                let arm = radius - line / 2.0;
                let strokes = [
                    [x - arm, y - arm],
                    [x + arm, y + arm],
                    [f32::NAN, 0.0],
                    [x - arm, y + arm],
                    [x + arm, y - arm],
                ];
                self.polyline(&strokes, light, line + 2.0 * rim, 1.0);
                self.polyline(&strokes, color, line, 1.0);
            }
            Marker::Arrow { heading } => {
                let path = arrow(x, y, heading, radius);
                self.stroke(path.clone(), light, 2.0 * rim, 1.0);
                self.fill(path, color);
            }
        }
    }

    /// Writes text from `x` on; with a halo for text on a picture.
    pub(crate) fn text(
        &mut self,
        text: &str,
        size: f32,
        [x, baseline]: [f32; 2],
        color: Rgb,
        halo: bool,
    ) {
        let path = text_path(text, size, x, baseline);
        if halo {
            self.stroke(path.clone(), Rgb::WHITE, size / 3.0, 0.95);
        }
        self.fill(path, color);
    }
}

/// Returns an arrow head with a notch, centred at a point; `heading` is counter-clockwise, y up.
fn arrow(x: f32, y: f32, heading: f64, radius: f32) -> Option<Path> {
    let (sin, cos) = libm::sincos(heading);
    #[allow(clippy::cast_possible_truncation, reason = "pixels")]
    let (sin, cos) = (sin as f32, cos as f32);
    let mut path = PathBuilder::new();
    let place = |along: f32, left: f32| {
        (x + radius * (along * cos - left * sin), y - radius * (along * sin + left * cos))
    };
    let (x0, y0) = place(1.15, 0.0);
    path.move_to(x0, y0);
    for (along, left) in [(-0.85, 0.8), (-0.45, 0.0), (-0.85, -0.8)] {
        let (x, y) = place(along, left);
        path.line_to(x, y);
    }
    path.close();
    path.finish()
}
