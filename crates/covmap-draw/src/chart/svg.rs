//! A drawing as SVG.

use super::scene::{Anchor, Scene, Shape};
use crate::picture::Rgb;
use std::fmt::Write;

/// The font that the layout is measured with, then fonts as wide, then any font.
const FAMILY: &str = "'DejaVu Sans', Verdana, sans-serif";

impl Scene {
    /// Returns the drawing as an SVG document, in which text stays text.
    pub(super) fn to_svg(&self) -> String {
        let (width, height) = (number(self.width), number(self.height));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"{FAMILY}\">\n\
             <title>{}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
            escape(&self.name)
        );
        for shape in &self.shapes {
            shape.write(&mut svg).expect("a string takes everything");
        }
        svg.push_str("</svg>\n");
        svg
    }
}

impl Shape {
    fn write(&self, svg: &mut String) -> std::fmt::Result {
        match self {
            Self::Line { points, color, width, dashes } => {
                let (color, width) = (hex(*color), number(*width));
                write!(
                    svg,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" ",
                    list(points)
                )?;
                write!(svg, "stroke-width=\"{width}\" stroke-linejoin=\"round\"")?;
                if dashes.is_empty() {
                    writeln!(svg, " stroke-linecap=\"round\"/>")
                } else {
                    let dashes: Vec<String> = dashes.iter().map(|v| number(*v)).collect();
                    writeln!(svg, " stroke-dasharray=\"{}\"/>", dashes.join(" "))
                }
            }
            Self::Block { at: [x, y], size: [width, height], color } => writeln!(
                svg,
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" \
                 shape-rendering=\"crispEdges\"/>",
                number(*x),
                number(*y),
                number(*width),
                number(*height),
                hex(*color)
            ),
            Self::Polygon { corners, fill, rim, width } => writeln!(
                svg,
                "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>",
                list(corners),
                hex(*fill),
                hex(*rim),
                number(*width)
            ),
            Self::Disc { center: [x, y], radius, fill, rim, width } => writeln!(
                svg,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>",
                number(*x),
                number(*y),
                number(*radius),
                hex(*fill),
                hex(*rim),
                number(*width)
            ),
            Self::Text { text, size, at: [x, y], anchor, turned, color } => {
                let (x, y) = (number(*x), number(*y));
                write!(svg, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"", number(*size))?;
                match anchor {
                    Anchor::Start => {}
                    Anchor::Middle => write!(svg, " text-anchor=\"middle\"")?,
                    Anchor::End => write!(svg, " text-anchor=\"end\"")?,
                }
                if *turned {
                    write!(svg, " transform=\"rotate(-90 {x} {y})\"")?;
                }
                writeln!(svg, " fill=\"{}\">{}</text>", hex(*color), escape(text))
            }
        }
    }
}

fn hex(Rgb(r, g, b): Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Formats a length to a hundredth.
fn number(value: f32) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_string() } else { text.to_string() }
}

fn list(points: &[[f32; 2]]) -> String {
    let points: Vec<String> =
        points.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect();
    points.join(" ")
}

/// Returns text as XML allows it.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_whitespace() => escaped.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}
