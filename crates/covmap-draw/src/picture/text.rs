//! Text, as the outlines of its letters.

use std::sync::LazyLock;
use tiny_skia::{Path, PathBuilder};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// DejaVu Sans, reduced to Latin, Greek and some signs: no font of the system is needed.
static FONT: LazyLock<Face<'static>> = LazyLock::new(|| {
    let bytes = include_bytes!("../../assets/DejaVuSans-subset.ttf");
    Face::parse(bytes, 0).expect("the shipped font is valid")
});

/// The height of a capital letter as a share of the size of text.
pub(crate) const CAP_HEIGHT: f32 = 0.73;

/// Returns the length of a line of text \[pixels\].
pub(crate) fn text_width(text: &str, size: f32) -> f32 {
    let scale = size / f32::from(FONT.units_per_em());
    text.chars().map(|c| advance(glyph(c)) * scale).sum()
}

/// Returns the outlines of a line of text that begins at `x` on the line `baseline` \[pixels\];
/// `None` if nothing is visible.
pub(crate) fn text_path(text: &str, size: f32, x: f32, baseline: f32) -> Option<Path> {
    let scale = size / f32::from(FONT.units_per_em());
    let mut pen = Pen { path: PathBuilder::new(), x, y: baseline, scale };
    for c in text.chars() {
        let id = glyph(c);
        FONT.outline_glyph(id, &mut pen);
        pen.x += advance(id) * scale;
    }
    pen.path.finish()
}

/// Returns the glyph of a letter, or that of `?` if the font lacks the letter.
fn glyph(c: char) -> GlyphId {
    let c = if c.is_whitespace() { ' ' } else { c };
    FONT.glyph_index(c).or_else(|| FONT.glyph_index('?')).unwrap_or_default()
}

fn advance(id: GlyphId) -> f32 {
    f32::from(FONT.glyph_hor_advance(id).unwrap_or_default())
}

/// Pen that converts outlines with y up, in units of the font, to pixels with y down.
struct Pen {
    path: PathBuilder,
    x: f32,
    y: f32,
    scale: f32,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, self.y - y * self.scale)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.path.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2)) = (self.place(x1, y1), self.place(x2, y2));
        let (x, y) = self.place(x, y);
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_font_has_the_letters_of_science() {
        for c in ('!'..='~').chain("ÄÖÜäöüßéñ×°±²·–—…αεθμπσΣΩ→≤≥≠≈−√∞".chars())
        {
            assert!(FONT.glyph_index(c).is_some(), "{c}");
            assert!(text_path(&c.to_string(), 16.0, 0.0, 0.0).is_some(), "{c}");
        }
    }

    #[test]
    fn text_is_as_wide_as_its_letters_together() {
        let (one, two) = (text_width("map", 20.0), text_width("map map", 20.0));
        assert!((two - 2.0 * one - text_width(" ", 20.0)).abs() < 1e-3);
        let bounds = text_path("map", 20.0, 5.0, 30.0).unwrap().bounds();
        assert!(bounds.left() >= 5.0 && bounds.right() <= 5.0 + one);
        assert!(bounds.top() > 15.0 && bounds.bottom() > 30.0, "the p hangs below the line");
    }

    #[test]
    fn letters_that_the_font_lacks_are_question_marks() {
        assert_eq!(text_path("漢", 16.0, 0.0, 0.0), text_path("?", 16.0, 0.0, 0.0));
        assert_eq!(text_path(" \n", 16.0, 0.0, 0.0), None);
    }
}
