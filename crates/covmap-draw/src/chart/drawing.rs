//! Drawings other than charts: any combination of lines, blocks and text.

use super::Figure;
use super::panel::Heading;
use super::scene::{Anchor, Scene, Shape};
use crate::picture::{Rgb, text::text_width};
use std::io;

/// The white around a drawing.
const MARGIN: f32 = 18.0;

/// Position of text at its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextAnchor {
    /// The text begins at the point.
    Start,
    /// The middle of the text is at the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// A diagram of lines, blocks, polygons and text, as SVG and as PNG, in the manner of a [`Figure`].
///
/// Lengths are points of the drawing, from its top left to the right and downwards. Later shapes
/// lie above earlier ones. The same calls make the same bytes.
///
/// ```
/// use covmap_draw::{Drawing, Rgb, TextAnchor};
///
/// let mut drawing = Drawing::new("A wall", "seen from above", [300.0, 120.0]);
/// let top = drawing.top();
/// drawing.block([40.0, top], [200.0, 20.0], Rgb::INK);
/// drawing.text("brick", 12.0, [140.0, top + 40.0], TextAnchor::Middle, Rgb::INK);
/// assert!(drawing.to_svg().contains("brick"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    scene: Scene,
    top: f32,
}

impl Drawing {
    /// Creates a drawing of a width and a height, with a title and a smaller line under it; both
    /// may be empty.
    pub fn new(title: &str, subtitle: &str, size: [f64; 2]) -> Self {
        let [width, height] = narrow(size);
        let mut scene = Scene { width, height, name: title.to_owned(), shapes: Vec::new() };
        let heading = Heading::new((title, 20.0), (subtitle, 13.0), width - 2.0 * MARGIN);
        heading.draw(&mut scene, [MARGIN, MARGIN]);
        let above = heading.height();
        let top = MARGIN + if above > 0.0 { (above + 14.0).ceil() } else { 0.0 };
        Self { scene, top }
    }

    /// Returns the height under title and subtitle.
    pub fn top(&self) -> f64 {
        f64::from(self.top)
    }

    /// Draws a line through points.
    pub fn line(&mut self, points: &[[f64; 2]], color: Rgb, width: f64) {
        self.scene.line(points.iter().copied().map(narrow).collect(), color, short(width), &[]);
    }

    /// Draws a dashed line through points.
    pub fn dashed(&mut self, points: &[[f64; 2]], color: Rgb, width: f64) {
        let points = points.iter().copied().map(narrow).collect();
        self.scene.line(points, color, short(width), &[5.0, 3.5]);
    }

    /// Draws a filled rectangle, by its upper left corner and its size.
    pub fn block(&mut self, at: [f64; 2], size: [f64; 2], color: Rgb) {
        self.scene.block(narrow(at), narrow(size), color);
    }

    /// Draws the outline of a rectangle, by its upper left corner and its size.
    pub fn frame(&mut self, at: [f64; 2], size: [f64; 2], color: Rgb, width: f64) {
        let ([left, top], [right, bottom]) = (at, [at[0] + size[0], at[1] + size[1]]);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        self.line(&corners, color, width);
    }

    /// Draws a filled polygon with a rim.
    pub fn polygon(&mut self, corners: &[[f64; 2]], fill: Rgb, rim: Rgb, width: f64) {
        let corners = corners.iter().copied().map(narrow).collect();
        self.scene.shapes.push(Shape::Polygon { corners, fill, rim, width: short(width) });
    }

    /// Draws a filled disc with a rim.
    pub fn disc(&mut self, center: [f64; 2], radius: f64, fill: Rgb, rim: Rgb) {
        let (center, radius) = (narrow(center), short(radius));
        self.scene.shapes.push(Shape::Disc { center, radius, fill, rim, width: 1.0 });
    }

    /// Writes a line of text of a size, with its baseline at a point.
    pub fn text(&mut self, text: &str, size: f64, at: [f64; 2], anchor: TextAnchor, color: Rgb) {
        let anchor = match anchor {
            TextAnchor::Start => Anchor::Start,
            TextAnchor::Middle => Anchor::Middle,
            TextAnchor::End => Anchor::End,
        };
        self.scene.text(text, short(size), narrow(at), anchor, color);
    }

    /// Writes a line of text upwards, with its middle at a point.
    pub fn turned_text(&mut self, text: &str, size: f64, at: [f64; 2], color: Rgb) {
        self.scene.turned_text(text, short(size), narrow(at), color);
    }

    /// Returns the length of a line of text of a size.
    pub fn text_width(text: &str, size: f64) -> f64 {
        f64::from(text_width(text, short(size)))
    }

    /// Places a figure with its upper left corner at a point, and returns its size.
    pub fn place(&mut self, figure: &Figure, at: [f64; 2]) -> [f64; 2] {
        let Scene { width, height, shapes, .. } = figure.lay_out();
        let at = narrow(at);
        self.scene.shapes.extend(shapes.into_iter().map(|shape| shape.moved(at)));
        [f64::from(width), f64::from(height)]
    }

    /// Returns the drawing as an SVG document.
    pub fn to_svg(&self) -> String {
        self.scene.to_svg()
    }

    /// Returns the drawing as a PNG of twice as many pixels a side.
    ///
    /// # Errors
    /// If the drawing is too large for a PNG.
    pub fn to_png(&self) -> io::Result<Vec<u8>> {
        self.scene.paint().to_png()
    }
}

impl Shape {
    /// Returns the shape, moved to the right and down.
    fn moved(mut self, [right, down]: [f32; 2]) -> Self {
        let shift = |point: &mut [f32; 2]| *point = [point[0] + right, point[1] + down];
        match &mut self {
            Self::Line { points, .. } => points.iter_mut().for_each(shift),
            Self::Polygon { corners, .. } => corners.iter_mut().for_each(shift),
            Self::Block { at, .. } | Self::Text { at, .. } => shift(at),
            Self::Disc { center, .. } => shift(center),
        }
        self
    }
}

fn short(length: f64) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "points of a drawing")]
    let length = length as f32;
    length
}

fn narrow([x, y]: [f64; 2]) -> [f32; 2] {
    [short(x), short(y)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Chart, ChartPoint, Series};

    #[test]
    fn a_figure_is_placed_with_all_its_shapes() {
        let points = vec![ChartPoint::new(0.0, 1.0), ChartPoint::new(1.0, 2.0)];
        let series = Series { name: "one".into(), points, line: true, marks: true };
        let chart = Chart { title: "chart".into(), series: vec![series], ..Chart::default() };
        let figure = Figure { panels: vec![chart.into()], columns: 1, ..Figure::default() };
        let mut drawing = Drawing::new("", "", [900.0, 600.0]);
        let [width, height] = drawing.place(&figure, [20.0, 30.0]);
        assert!(width > 400.0 && height > 300.0);
        let (alone, placed) = (figure.lay_out(), &drawing.scene);
        assert_eq!(alone.shapes.len(), placed.shapes.len());
        assert_eq!(alone.shapes[0].clone().moved([20.0, 30.0]), placed.shapes[0]);
        assert!(drawing.to_svg().contains("chart") && drawing.to_png().is_ok());
    }
}
