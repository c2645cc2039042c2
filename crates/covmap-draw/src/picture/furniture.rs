//! The items under a map: scale bar, colour bar, and legend.

use super::canvas::Canvas;
use super::color::Rgb;
use super::text::{CAP_HEIGHT, text_width};
use super::{ColorBar, Key, Picture};

/// The white around everything \[pixels\].
pub(super) const MARGIN: f32 = 32.0;
const SIZE: f32 = 16.0;
const SWATCH: f32 = 18.0;
const ROW: f32 = 30.0;
/// Gap between a row of one kind and the next \[pixels\].
const BREAK: f32 = 18.0;

enum Item<'a> {
    ScaleBar { length: f32, metres: f64 },
    ColorBar { bar: &'a ColorBar, width: f32 },
    Key { key: Key, text: &'a str },
}

/// The items under the map. Each has its top left corner, from the map's lower left corner \[pixels\].
pub(super) struct Furniture<'a> {
    items: Vec<(Item<'a>, [f32; 2])>,
    height: f32,
}

/// Returns the largest of the round lengths 1, 2, 5, 10, 20, … up to `most`.
pub(crate) fn round_down(most: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(most)));
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * decade <= most * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * decade
}

/// Formats a number with the digits that its steps need.
pub(crate) fn short(value: f64, step: f64) -> String {
    let decimals = (-libm::floor(libm::log10(step) + 1e-9)).clamp(0.0, 9.0);
    #[allow(clippy::cast_possible_truncation, reason = "0 to 9")]
    let text = format!("{:.*}", decimals as usize, value);
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| matches!(b, b'0' | b'.')) => digits.to_string(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

fn length_name(metres: f64) -> String {
    if metres < 0.01 {
        format!("{} mm", short(metres * 1e3, metres * 1e3))
    } else if metres < 1.0 {
        format!("{} cm", short(metres * 1e2, metres * 1e2))
    } else {
        format!("{} m", short(metres, metres))
    }
}

impl<'a> Furniture<'a> {
    /// Finds a place for all items in a given width.
    pub(super) fn lay_out(picture: &'a Picture, width: f32) -> Self {
        let mut items = Vec::new();
        let mut y = 0.0;
        let mut x = 0.0;
        if picture.scale_bar {
            let most = f64::from(width.min(1000.0)) / 5.0 / picture.scale();
            let metres = round_down(most);
            #[allow(clippy::cast_possible_truncation, reason = "pixels")]
            let length = (metres * picture.scale()) as f32;
            items.push((Item::ScaleBar { length, metres }, [0.0, BREAK]));
            y = BREAK + ROW;
            x = length + text_width(&length_name(metres), SIZE) + 10.0 + 48.0;
        }
        if let Some(bar) = &picture.color_bar {
            let title = text_width(&bar.title, SIZE) + 14.0;
            let bar_width = (width - x - title - 28.0).min(420.0);
            // Beside the scale bar, at the right edge, if there is room; else below it.
            let (at, bar_width) = if bar_width >= 200.0 {
                ([width - bar_width - title, BREAK], bar_width)
            } else {
                ([14.0, y + BREAK], (width - title - 28.0).clamp(120.0, 420.0))
            };
            items.push((Item::ColorBar { bar, width: bar_width }, at));
            y = at[1] + ROW + SIZE + 6.0;
        }
        if !picture.keys.is_empty() {
            y += if y > 0.0 { 8.0 } else { BREAK };
            let mut x = 0.0;
            for (key, text) in &picture.keys {
                let needed = SWATCH + 9.0 + text_width(text, SIZE);
                if x > 0.0 && x + needed > width {
                    (x, y) = (0.0, y + ROW);
                }
                items.push((Item::Key { key: *key, text }, [x, y]));
                x += needed + 30.0;
            }
            y += ROW - 8.0;
        }
        Self { items, height: y }
    }

    /// Returns the height of all items \[pixels\].
    pub(super) fn height(&self) -> f32 {
        self.height
    }

    /// Draws all items from a line of the picture down.
    pub(super) fn draw(&self, canvas: &mut Canvas, top: f32) {
        for (item, [x, y]) in &self.items {
            let at = [(MARGIN + x).round(), (top + y).round()];
            match item {
                Item::ScaleBar { length, metres } => scale_bar(canvas, at, *length, *metres),
                Item::ColorBar { bar, width } => color_bar(canvas, at, bar, *width),
                Item::Key { key, text } => draw_key(canvas, at, *key, text),
            }
        }
    }
}

/// Returns the baseline of text in the middle of a row of swatches.
fn baseline(top: f32) -> f32 {
    top + (SWATCH + SIZE * CAP_HEIGHT) / 2.0
}

fn scale_bar(canvas: &mut Canvas, [x, y]: [f32; 2], length: f32, metres: f64) {
    let (height, y_bar) = (7.0, y + (SWATCH - 7.0) / 2.0);
    canvas.rectangle(x, y_bar, length, height, Rgb::INK);
    canvas.rectangle(x + length / 2.0, y_bar + 1.5, length / 2.0 - 1.5, height - 3.0, Rgb::WHITE);
    let text = length_name(metres);
    canvas.text(&text, SIZE, [x + length + 10.0, baseline(y)], Rgb::INK, false);
}

fn color_bar(canvas: &mut Canvas, [x, y]: [f32; 2], bar: &ColorBar, width: f32) {
    let count = bar.colors.len();
    let width = width.round();
    #[allow(clippy::cast_possible_truncation, reason = "a few hundred pixels")]
    for column in 0..width as usize {
        let index = column * (count - 1) / (width as usize - 1).max(1);
        canvas.rectangle(x + column as f32, y, 1.0, SWATCH, bar.colors[index]);
    }
    canvas.frame(x - 0.5, y - 0.5, width + 1.0, SWATCH + 1.0, Rgb::FRAME);
    canvas.text(&bar.title, SIZE, [x + width + 14.0, baseline(y)], Rgb::INK, false);
    let (low, high) = bar.range;
    for (share, text) in ticks(low, high) {
        #[allow(clippy::cast_possible_truncation, reason = "pixels")]
        let at = x + share as f32 * width;
        canvas.rectangle((at - 0.5).round(), y + SWATCH, 1.0, 5.0, Rgb::FRAME);
        let left = at - text_width(&text, SIZE - 2.0) / 2.0;
        canvas.text(&text, SIZE - 2.0, [left, y + SWATCH + 19.0], Rgb::INK, false);
    }
}

/// Returns the ends of a range and the round values between them, with the share of the way of
/// each. A round value too near to an end is left out.
fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    if !(span.is_finite() && span > 0.0 && low.abs() < 1e12 * span) {
        return vec![(0.0, format!("{low:.3}"))];
    }
    let step = round_down(span / 4.0 * 1.001);
    let end = |value: f64| {
        let is_round = (value / step - (value / step).round()).abs() < 1e-9;
        short(value, if is_round { step } else { step / 10.0 })
    };
    let first = libm::ceil(low / step - 1e-9);
    let inner = (0..20)
        .map(|i| (first + f64::from(i)) * step)
        .map(|value| ((value - low) / span, short(value, step)))
        .filter(|(share, _)| (0.1..=0.9).contains(share));
    std::iter::once((0.0, end(low))).chain(inner).chain([(1.0, end(high))]).collect()
}

fn draw_key(canvas: &mut Canvas, [x, y]: [f32; 2], key: Key, text: &str) {
    let middle = [x + SWATCH / 2.0, y + SWATCH / 2.0];
    match key {
        Key::Fill(color) => {
            canvas.rectangle(x, y, SWATCH, SWATCH, color);
            canvas.frame(x + 0.5, y + 0.5, SWATCH - 1.0, SWATCH - 1.0, Rgb::FRAME);
        }
        Key::Line(color) => {
            let line = [[x + 1.5, middle[1]], [x + SWATCH - 1.5, middle[1]]];
            canvas.polyline(&line, color, 3.0, 1.0);
        }
        Key::Marker(marker, color) => canvas.marker(middle, marker, color, SWATCH - 4.0),
    }
    canvas.text(text, SIZE, [x + SWATCH + 9.0, baseline(y)], Rgb::INK, false);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round() {
        for (most, expected) in
            [(1.0, "1 m"), (4.9, "2 m"), (73.0, "50 m"), (0.3, "20 cm"), (0.004, "2 mm")]
        {
            assert_eq!(length_name(round_down(most)), expected);
        }
    }

    #[test]
    fn ticks_are_the_ends_and_round_values_between_them() {
        let names = |low, high| -> Vec<String> {
            ticks(low, high).into_iter().map(|(_, name)| name).collect()
        };
        assert_eq!(names(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(names(0.0, 2.4), ["0.0", "0.5", "1.0", "1.5", "2.0", "2.40"]);
        assert_eq!(names(0.31, 0.74), ["0.31", "0.4", "0.5", "0.6", "0.74"]);
        assert_eq!(names(-30.0, 30.0), ["−30", "−20", "−10", "0", "10", "20", "30"]);
        assert_eq!(names(3.0, 3.0).len(), 1);
        assert_eq!(names(0.0, f64::INFINITY).len(), 1);
        assert!(ticks(0.31, 0.74).iter().all(|(share, _)| (0.0..=1.0).contains(share)));
    }
}
