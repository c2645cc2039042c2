//! A drawing as pixels.

use super::scene::{Anchor, Scene, Shape};
use crate::picture::Rgb;
use crate::picture::canvas::Canvas;
use crate::picture::text::{text_path, text_width};
use tiny_skia::{Path, PathBuilder, Transform};

/// Number of pixels of a point of the drawing.
const SCALE: f32 = 2.0;
/// The longest side of an image \[pixels\]; a larger drawing is made smaller.
const LONGEST: f32 = 8000.0;

impl Scene {
    /// Returns the drawing as an image.
    #[allow(clippy::cast_possible_truncation, reason = "≤ 8000")]
    pub(super) fn paint(&self) -> Canvas {
        let scale = SCALE.min(LONGEST / self.width.max(self.height).max(1.0));
        let side = |length: f32| (length * scale).ceil() as u32;
        let mut canvas = Canvas::new(side(self.width), side(self.height), Rgb::WHITE);
        for shape in &self.shapes {
            shape.paint(&mut canvas, scale);
        }
        canvas
    }
}

impl Shape {
    fn paint(&self, canvas: &mut Canvas, scale: f32) {
        match self {
            Self::Line { points, color, width, dashes } => {
                let path = path(points, false, scale);
                if dashes.is_empty() {
                    canvas.stroke(path, *color, width * scale, 1.0);
                } else {
                    let dashes: Vec<f32> = dashes.iter().map(|v| v * scale).collect();
                    canvas.dash(path, *color, width * scale, &dashes);
                }
            }
            Self::Block { at, size, color } => {
                let [x, y] = at.map(|v| v * scale);
                canvas.rectangle(x, y, size[0] * scale, size[1] * scale, *color);
            }
            Self::Polygon { corners, fill, rim, width } => {
                let path = path(corners, true, scale);
                canvas.fill(path.clone(), *fill);
                canvas.stroke(path, *rim, width * scale, 1.0);
            }
            Self::Disc { center, radius, fill, rim, width } => {
                let [x, y] = center.map(|v| v * scale);
                let path = PathBuilder::from_circle(x, y, radius * scale);
                canvas.fill(path.clone(), *fill);
                canvas.stroke(path, *rim, width * scale, 1.0);
            }
            Self::Text { text, size, at, anchor, turned, color } => {
                let size = size * scale;
                let before = match anchor {
                    Anchor::Start => 0.0,
                    Anchor::Middle => text_width(text, size) / 2.0,
                    Anchor::End => text_width(text, size),
                };
                let [x, y] = at.map(|v| v * scale);
                let place = if *turned {
                    Transform::from_row(0.0, -1.0, 1.0, 0.0, x, y)
                } else {
                    Transform::from_translate(x, y)
                };
                let path = text_path(text, size, -before, 0.0);
                canvas.fill(path.and_then(|path| path.transform(place)), *color);
            }
        }
    }
}

fn path(points: &[[f32; 2]], closed: bool, scale: f32) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (index, point) in points.iter().enumerate() {
        let [x, y] = point.map(|v| v * scale);
        if index == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}
