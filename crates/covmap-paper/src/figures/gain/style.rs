//! Colours and small helpers of the drawings.

use covmap_draw::{Drawing, Rgb, TextAnchor};

/// From the palette of Okabe and Ito, which colour-blind readers can tell apart.
pub(super) const BLUE: Rgb = Rgb(0, 114, 178);
pub(super) const VERMILION: Rgb = Rgb(213, 94, 0);
pub(super) const GREEN: Rgb = Rgb(0, 158, 115);
pub(super) const PURPLE: Rgb = Rgb(204, 121, 167);
pub(super) const ORANGE: Rgb = Rgb(230, 159, 0);
pub(super) const SKY: Rgb = Rgb(86, 180, 233);

pub(super) const GREY: Rgb = Rgb(120, 130, 142);
pub(super) const GREY_INK: Rgb = Rgb(92, 102, 114);
pub(super) const LIGHT: Rgb = Rgb(228, 232, 237);
pub(super) const PALE: Rgb = Rgb(244, 246, 248);

/// The size of most text, and of small text.
pub(super) const TEXT: f64 = 13.0;
pub(super) const SMALL: f64 = 11.5;

/// Converts a count.
pub(super) fn count(n: usize) -> f64 {
    n as f64
}

/// Returns a paler colour.
pub(super) fn pale(color: Rgb) -> Rgb {
    color.mix(Rgb::WHITE, 0.62)
}

/// Draws an arrow from one point to another.
pub(super) fn arrow(drawing: &mut Drawing, from: [f64; 2], to: [f64; 2], color: Rgb) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = libm::hypot(dx, dy).max(1e-9);
    let (ux, uy) = (dx / length, dy / length);
    let back =
        |along: f64, aside: f64| [to[0] - along * ux - aside * uy, to[1] - along * uy + aside * ux];
    drawing.line(&[from, back(6.0, 0.0)], color, 1.4);
    drawing.polygon(&[to, back(8.0, 3.6), back(8.0, -3.6)], color, color, 0.5);
}

/// Draws a square of a colour with its meaning; returns the place of the next one.
pub(super) fn key(drawing: &mut Drawing, at: [f64; 2], color: Rgb, meaning: &str) -> f64 {
    drawing.block([at[0], at[1] - 10.0], [12.0, 12.0], color);
    drawing.frame([at[0], at[1] - 10.0], [12.0, 12.0], GREY, 0.7);
    drawing.text(meaning, TEXT, [at[0] + 18.0, at[1]], TextAnchor::Start, Rgb::INK);
    at[0] + 18.0 + Drawing::text_width(meaning, TEXT) + 24.0
}

/// Returns a number with few digits.
pub(super) fn small(value: f64) -> String {
    let exponent = libm::log10(value.abs().max(1e-300)).floor();
    let mantissa = value / libm::pow(10.0, exponent);
    // A number below the smallest one counts as 0.
    if value == 0.0 { "0".into() } else { format!("{mantissa:.1}e{exponent}") }
}

/// Writes the meaning of each colour, side by side.
pub(super) fn keys(drawing: &mut Drawing, [left, y]: [f64; 2], meanings: &[(Rgb, &str)]) {
    meanings.iter().fold(left, |x, (color, meaning)| key(drawing, [x, y], *color, meaning));
}
