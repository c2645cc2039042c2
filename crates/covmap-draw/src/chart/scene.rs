//! A drawing as a list of shapes; the SVG and the PNG are made of the same list.

use crate::picture::{Rgb, text::text_width};

/// Position of text at its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A shape; lengths in points of the drawing, from its top left.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    /// A line, drawn and left out in turn for the lengths of `dashes` if there are any.
    Line { points: Vec<[f32; 2]>, color: Rgb, width: f32, dashes: &'static [f32] },
    /// A filled rectangle.
    Block { at: [f32; 2], size: [f32; 2], color: Rgb },
    /// A polygon with a rim.
    Polygon { corners: Vec<[f32; 2]>, fill: Rgb, rim: Rgb, width: f32 },
    /// A disc with a rim.
    Disc { center: [f32; 2], radius: f32, fill: Rgb, rim: Rgb, width: f32 },
    /// A line of text with its baseline at a point; `turned` reads upwards.
    Text { text: String, size: f32, at: [f32; 2], anchor: Anchor, turned: bool, color: Rgb },
}

/// A drawing on white.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scene {
    pub(super) width: f32,
    pub(super) height: f32,
    /// Name of the drawing where it cannot be seen.
    pub(super) name: String,
    pub(super) shapes: Vec<Shape>,
}

impl Scene {
    /// Draws a thin straight line.
    pub(super) fn rule(&mut self, from: [f32; 2], to: [f32; 2], color: Rgb) {
        self.line(vec![from, to], color, 1.0, &[]);
    }

    /// Draws a thin outline of a rectangle.
    pub(super) fn frame(&mut self, [left, top]: [f32; 2], [width, height]: [f32; 2], color: Rgb) {
        let (right, bottom) = (left + width, top + height);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        self.line(corners.to_vec(), color, 1.0, &[]);
    }

    pub(super) fn line(
        &mut self,
        points: Vec<[f32; 2]>,
        color: Rgb,
        width: f32,
        dashes: &'static [f32],
    ) {
        self.shapes.push(Shape::Line { points, color, width, dashes });
    }

    pub(super) fn block(&mut self, at: [f32; 2], size: [f32; 2], color: Rgb) {
        self.shapes.push(Shape::Block { at, size, color });
    }

    /// Writes a line of text.
    pub(super) fn text(&mut self, text: &str, size: f32, at: [f32; 2], anchor: Anchor, color: Rgb) {
        let text = text.to_string();
        self.shapes.push(Shape::Text { text, size, at, anchor, turned: false, color });
    }

    /// Writes a line of text upwards, with its middle at a point.
    pub(super) fn turned_text(&mut self, text: &str, size: f32, at: [f32; 2], color: Rgb) {
        let (text, anchor) = (text.to_string(), Anchor::Middle);
        self.shapes.push(Shape::Text { text, size, at, anchor, turned: true, color });
    }
}

/// Splits a text into at most `most` lines of at most a width. Text that does not fit is cut off
/// with an ellipsis.
pub(super) fn wrap(text: &str, size: f32, width: f32, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let count = lines.len();
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            Some(line) if count >= most => {
                line.push('…');
                break;
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines.iter().map(|line| shorten(line, size, width)).collect()
}

/// Shortens a text to a width, with an ellipsis.
pub(super) fn shorten(text: &str, size: f32, width: f32) -> String {
    if text_width(text, size) <= width {
        return text.to_string();
    }
    let mut room = width - text_width("…", size);
    let fitting = text.chars().take_while(|c| {
        room -= text_width(c.encode_utf8(&mut [0; 4]), size);
        room >= 0.0
    });
    let mut short: String = fitting.filter(|c| *c != '…').collect();
    short.push('…');
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_wrapped_and_then_cut_off() {
        assert_eq!(wrap("", 12.0, 100.0, 2), Vec::<String>::new());
        assert_eq!(wrap("one", 12.0, 100.0, 2), ["one"]);
        let lines = wrap("one two three four five six seven eight", 12.0, 80.0, 2);
        assert_eq!(lines.len(), 2);
        assert!(lines[1].ends_with('…'), "{lines:?}");
        assert!(lines.iter().all(|line| text_width(line, 12.0) <= 80.0), "{lines:?}");
        assert!(shorten(&"m".repeat(9999), 12.0, 80.0).len() < 20);
    }
}
