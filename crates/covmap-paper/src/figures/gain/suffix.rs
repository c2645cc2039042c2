//! The sums S_q(i): for every outcome of a beam, its cells in front, and their sums.

use super::beam::{Part, part};
use super::moment::{Moment, Seen};
use super::style::{BLUE, GREY, GREY_INK, LIGHT, PALE, SMALL, TEXT, VERMILION, count, keys, pale};
use covmap_draw::{Drawing, Rgb, TextAnchor};
use covmap_gain::NEGLIGIBLE;

const WIDTH: f64 = 1040.0;
const LEFT: f64 = 92.0;
const MATRIX: f64 = 640.0;
const ROW: f64 = 10.0;
/// The width of the bars beside the rows, and the height of the sums under the columns.
const BAR: f64 = 100.0;
const SUMS: f64 = 120.0;
/// The share of the largest sum that is left in the marked column.
const MARKED: f64 = 0.6;

/// An outcome, as the sums see it.
struct RangeRow {
    probability: f64,
    /// L(k).
    any: f64,
    /// The number of cells in front, which are the first ones.
    front: usize,
    parts: Vec<Part>,
}

pub(super) fn draw(moment: &Moment, seen: Seen) -> Drawing {
    let (beam, likelihood) = (moment.beam(seen), moment.likelihood(seen));
    let cells = beam.cells.len();
    let row = |k: usize| {
        let parts: Vec<Part> = (0..cells).map(|i| part(moment, seen, k, i)).collect();
        RangeRow {
            probability: likelihood.probability(k),
            any: moment.any_cause(seen, k),
            front: parts.iter().take_while(|part| **part == Part::InFront).count(),
            parts,
        }
    };
    let rows: Vec<RangeRow> = (0..moment.stencil.outcomes()).map(row).collect();
    let height = count(rows.len()) * ROW;
    let mut drawing = Drawing::new(
        "S_q(i): one sum over the outcomes serves each cell in front",
        &format!("the beam of the first figure; {}", moment.words()),
        [WIDTH, 70.0 + 26.0 + height + 40.0 + SUMS + 84.0],
    );
    let top = drawing.top() + 26.0;
    let width = MATRIX / count(cells);
    for (k, row) in rows.iter().enumerate() {
        let y = top + count(k) * ROW;
        let mut first = 0;
        while first < cells {
            let part = row.parts[first];
            let same = row.parts[first..].iter().take_while(|other| **other == part).count();
            let likely = row.probability > NEGLIGIBLE;
            let fill = if likely { part.color() } else { pale(part.color()) };
            let at = [LEFT + count(first) * width, y];
            drawing.block(at, [count(same) * width, ROW - 1.0], fill);
            first += same;
        }
        if (k % 5 == 0 && k + 2 < rows.len()) || k + 1 == rows.len() {
            let range = moment.stencil.ranges.get(k);
            let label = range.map_or("no echo".into(), |d| format!("{d:.1} m"));
            let at = [LEFT - 8.0, y + 0.9 * ROW];
            drawing.text(&label, SMALL, at, TextAnchor::End, Rgb::INK);
        }
    }
    drawing.turned_text("outcome d_k", TEXT, [LEFT - 66.0, top + 0.5 * height], Rgb::INK);
    draw_bars(&mut drawing, &rows, top);
    draw_sums(&mut drawing, &rows, (cells, width), top + height + 40.0);
    mark(&mut drawing, &rows, (cells, width), (top, height));
    let at = [LEFT + 0.5 * MATRIX, top - 10.0];
    let text = format!("the beam’s {cells} cells, the nearest first →");
    drawing.text(&text, TEXT, at, TextAnchor::Middle, Rgb::INK);
    let meanings = [
        (Part::InFront.color(), "in front: in S_q(i)"),
        (Part::AtEnd.color(), "at the end: evaluated"),
        (Part::Behind.color(), "behind: a polynomial of c_m"),
        (LIGHT, "not covered"),
        (pale(Part::InFront.color()), "pale: unlikely"),
    ];
    keys(&mut drawing, [LEFT, top + height + 40.0 + SUMS + 58.0], &meanings);
    drawing
}

/// Draws p_k and L(k) beside the rows.
fn draw_bars(drawing: &mut Drawing, rows: &[RangeRow], top: f64) {
    let value: fn(&RangeRow) -> f64 = |row| row.probability;
    let columns = [("p_k", value, BLUE), ("L(k)", |row| row.any, GREY)];
    let mut left = LEFT + MATRIX + 26.0;
    for (name, value, color) in columns {
        let most = rows.iter().map(value).fold(1e-9, f64::max);
        drawing.block([left, top], [BAR, count(rows.len()) * ROW], PALE);
        let text = format!("{name}, up to {most:.2}");
        drawing.text(&text, TEXT, [left, top - 10.0], TextAnchor::Start, Rgb::INK);
        for (k, row) in rows.iter().enumerate() {
            let length = BAR * value(row) / most;
            if length > 0.0 {
                let at = [left, top + count(k) * ROW];
                drawing.block(at, [length.max(0.5), ROW - 1.0], color);
            }
        }
        left += BAR + 26.0;
    }
}

/// Returns S_q of a cell: Σ p_k · L(k)^q over the outcomes with the cell in front.
fn power_sum(rows: &[RangeRow], i: usize, q: i32) -> f64 {
    rows.iter()
        .filter(|row| i < row.front)
        .map(|row| row.probability * libm::pow(row.any, f64::from(q)))
        .sum()
}

/// Draws the first sums under the columns, each as a share of its largest.
fn draw_sums(drawing: &mut Drawing, rows: &[RangeRow], (cells, width): (usize, f64), top: f64) {
    drawing.block([LEFT, top], [MATRIX, SUMS], PALE);
    let mut y = top + 22.0;
    for (q, color) in [(1, BLUE), (2, VERMILION)] {
        let most = power_sum(rows, 0, q).max(1e-12);
        let corner = |i: usize, cell: usize| {
            let share = power_sum(rows, cell, q) / most;
            [LEFT + count(i) * width, top + SUMS * (1.0 - 0.94 * share)]
        };
        let steps = (0..cells).flat_map(|i| [corner(i, i), corner(i + 1, i)]);
        let steps: Vec<[f64; 2]> = steps.collect();
        if q == 1 {
            drawing.line(&steps, color, 2.2);
        } else {
            drawing.dashed(&steps, color, 2.2);
        }
        let left = LEFT + MATRIX + 26.0;
        let sample = [[left, y - 4.0], [left + 28.0, y - 4.0]];
        if q == 1 {
            drawing.line(&sample, color, 2.2);
        } else {
            drawing.dashed(&sample, color, 2.2);
        }
        let text = format!("S_{q}(i), up to {most:.4}");
        drawing.text(&text, TEXT, [left + 36.0, y], TextAnchor::Start, Rgb::INK);
        y += 22.0;
    }
    let left = LEFT + MATRIX + 26.0;
    for line in ["from right to left, a row", "is added where it first", "turns blue: each once"] {
        drawing.text(line, SMALL, [left, y + 6.0], TextAnchor::Start, GREY_INK);
        y += 16.0;
    }
    drawing.line(&[[LEFT, top + SUMS], [LEFT + MATRIX, top + SUMS]], GREY, 1.0);
    drawing.text("0", SMALL, [LEFT - 8.0, top + SUMS], TextAnchor::End, GREY_INK);
    drawing.turned_text("S_q(i)", TEXT, [LEFT - 66.0, top + 0.5 * SUMS], Rgb::INK);
}

/// Marks the column of one cell, and its sum.
fn mark(
    drawing: &mut Drawing,
    rows: &[RangeRow],
    (cells, width): (usize, f64),
    (top, height): (f64, f64),
) {
    let most = power_sum(rows, 0, 1);
    let i = (0..cells).find(|i| power_sum(rows, *i, 1) <= MARKED * most).unwrap_or(0);
    let x = LEFT + count(i) * width;
    let bottom = top + height + 40.0 + SUMS;
    drawing.frame([x, top - 1.0], [width.max(4.0), bottom - top + 1.0], Rgb::INK, 1.4);
    let summed = rows.iter().filter(|row| i < row.front && row.probability > NEGLIGIBLE).count();
    let text = format!("cell i = {i}: S_q(i) sums {summed} likely outcomes");
    drawing.text(&text, TEXT, [x, bottom + 20.0], TextAnchor::Start, Rgb::INK);
}
