//! The memory layout of a cache: bordered rasters, padded rows, and planes.

use super::moment::Moment;
use super::style::{
    BLUE, GREEN, GREY, GREY_INK, LIGHT, ORANGE, PALE, SMALL, TEXT, VERMILION, arrow, count, pale,
};
use crate::error::{PaperError, Result};
use covmap_draw::{Drawing, Rgb, TextAnchor};
use covmap_gain::{MemoryLayout, PlaneLayout};

const WIDTH: f64 = 1060.0;
const LEFT: f64 = 18.0;
/// The width of the two upper parts, and of the lower one.
const HALF: f64 = 470.0;
const WHOLE: f64 = 840.0;
const ROW: f64 = 13.0;
/// The group of view-points in the figure, by its number in its row.
const GROUP: usize = 1;

/// The numbers of one cache.
struct Numbers {
    layout: MemoryLayout,
    planes: PlaneLayout,
    width: usize,
    height: usize,
    bins: usize,
    /// A cell of the stencil, by columns and rows from a view-point.
    cell: (i32, i32),
    /// The view-points' row.
    y: usize,
}

pub(super) fn draw(moment: &Moment) -> Result<Drawing> {
    let cache = moment.fresh_cache()?;
    let layout = cache.layout();
    let planes = layout.planes.ok_or(PaperError::Missing("planes of the update by the product"))?;
    let grid = moment.grid();
    let cells = &moment.stencil.beams[2].cells;
    let cell =
        cells.get(cells.len() * 3 / 5).ok_or(PaperError::Missing("a cell of the stencil"))?;
    let numbers = Numbers {
        layout,
        planes,
        width: grid.width(),
        height: grid.height(),
        bins: moment.map.bins(),
        cell: (cell.dx, cell.dy),
        y: grid.height() / 3,
    };
    let scale = HALF / count(layout.raster_width);
    let high = scale * count(numbers.height + 2 * layout.border);
    let subtitle = format!(
        "a grid of {} × {} cells, {} bins, Eq. (9), to scale; distances count numbers, not bytes",
        numbers.width, numbers.height, numbers.bins
    );
    let size = [WIDTH, 70.0 + 30.0 + high + 60.0 + 24.0 + 11.0 * ROW + 62.0];
    let mut drawing = Drawing::new("What is read side by side lies side by side", &subtitle, size);
    let top = drawing.top() + 30.0;
    draw_raster(&mut drawing, &numbers, [LEFT, top], scale);
    draw_rows(&mut drawing, &numbers, [WIDTH - LEFT - HALF, top]);
    draw_planes(&mut drawing, &numbers, [LEFT + 150.0, top + high + 84.0]);
    Ok(drawing)
}

fn say(drawing: &mut Drawing, text: &str, at: [f64; 2], color: Rgb) {
    drawing.text(text, TEXT, at, TextAnchor::Start, color);
}

fn whisper(drawing: &mut Drawing, text: &str, at: [f64; 2]) {
    drawing.text(text, SMALL, at, TextAnchor::Start, GREY_INK);
}

/// Draws a raster with a border, a group, and a cell of the stencil as the group's members see it.
fn draw_raster(drawing: &mut Drawing, numbers: &Numbers, [left, top]: [f64; 2], scale: f64) {
    let Numbers { layout, width, height, cell: (dx, dy), y, .. } = *numbers;
    let lanes = layout.lanes;
    let title = "A bordered raster: one offset leads from every view-point to a cell";
    drawing.text(title, 14.5, [left, top - 10.0], TextAnchor::Start, Rgb::INK);
    let border = count(layout.border) * scale;
    let size = [count(width) * scale, count(height) * scale];
    drawing.block([left, top], [size[0] + 2.0 * border, size[1] + 2.0 * border], LIGHT);
    drawing.block([left + border, top + border], size, Rgb::WHITE);
    for x in (0..=width).step_by(lanes) {
        let x = left + border + count(x) * scale;
        drawing.line(&[[x, top + border], [x, top + border + size[1]]], LIGHT, 1.0);
    }
    drawing.frame([left + border, top + border], size, GREY, 1.0);
    let of_column = |x: f64| left + border + x * scale;
    let of_row = |y: f64| top + border + (count(height) - 1.0 - y) * scale;
    let (x, y) = (count(GROUP * lanes), count(y));
    let long = [count(lanes) * scale, scale.max(4.0)];
    let group = [of_column(x), of_row(y)];
    let seen = [of_column(x + f64::from(dx)), of_row(y + f64::from(dy))];
    drawing.block(group, long, BLUE);
    drawing.block(seen, long, ORANGE);
    let middle = |at: [f64; 2]| [at[0] + 0.5 * scale, at[1] + 0.5 * long[1]];
    arrow(drawing, middle(group), middle(seen), VERMILION);
    let last = |at: [f64; 2]| [at[0] + long[0] - 0.5 * scale, at[1] + 0.5 * long[1]];
    arrow(drawing, last(group), last(seen), VERMILION);
    let under = [group[0] - 4.0, group[1] + 20.0];
    say(drawing, &format!("a group of {lanes} view-points"), under, BLUE);
    let offset = i64::from(dy) * i64::try_from(layout.raster_width).unwrap_or(0) + i64::from(dx);
    let at = [seen[0] + long[0] + 8.0, seen[1] + 8.0];
    say(drawing, &format!("the same cell: {offset:+}"), at, VERMILION);
    let below = top + size[1] + 2.0 * border;
    let text = format!(
        "border {} cells on every side; {} from one row to the next",
        layout.border, layout.raster_width
    );
    whisper(drawing, &text, [left + 6.0, below - 10.0]);
    whisper(
        drawing,
        "ρ, most likely and expected coverage, limits; ceilings of Eq. (9)",
        [left + 6.0, top + 18.0],
    );
}

/// Draws one row of histograms, bin by bin.
fn draw_rows(drawing: &mut Drawing, numbers: &Numbers, [left, top]: [f64; 2]) {
    let Numbers { layout, width, bins, .. } = *numbers;
    let (lanes, padding) = (layout.lanes, layout.padding);
    let title = "A padded row: bin by bin, each bin of neighbours one vector";
    drawing.text(title, 14.5, [left, top - 10.0], TextAnchor::Start, Rgb::INK);
    let scale = (HALF - 46.0) / count(layout.padded_width);
    let first = left + 46.0;
    let x = padding + GROUP * lanes + 5;
    for bin in 0..bins {
        let y = top + 24.0 + count(bin) * 1.25 * ROW;
        let long = [count(layout.padded_width) * scale, ROW];
        drawing.block([first, y], long, LIGHT);
        let cells = [first + count(padding) * scale, y];
        drawing.block(cells, [count(width) * scale, ROW], Rgb::WHITE);
        drawing.block([first + count(x) * scale, y], [count(lanes) * scale, ROW], ORANGE);
        for block in 0..=width.div_ceil(lanes) {
            let x = cells[0] + count(block * lanes) * scale;
            drawing.line(&[[x, y], [x, y + ROW]], GREY, 0.8);
        }
        drawing.frame([first, y], long, GREY, 0.8);
        if bin % 5 == 0 {
            let at = [first - 6.0, y + 10.5];
            drawing.text(&format!("bin {bin}"), SMALL, at, TextAnchor::End, Rgb::INK);
        }
    }
    let below = top + 24.0 + count(bins) * 1.25 * ROW;
    let text = format!("{} from one bin to the next;", layout.padded_width);
    whisper(drawing, &text, [first, below + 16.0]);
    let text = format!("padding {padding} on either side, blocks of {lanes} between the marks");
    whisper(drawing, &text, [first, below + 32.0]);
    let text = format!("{lanes} neighbours, wherever they begin");
    say(drawing, &text, [first + count(x) * scale, top + 16.0], VERMILION);
    let notes = [
        "h and ĥ; by cause also polynomials and ceilings,",
        "a power or a number of a ceiling in place of a bin.",
        "Past the grid all is 0, and nothing is gained there.",
    ];
    for (i, note) in notes.iter().enumerate() {
        say(drawing, note, [first, below + 60.0 + 18.0 * count(i)], Rgb::INK);
    }
}

/// Draws the planes of gains of one distance ring.
fn draw_planes(drawing: &mut Drawing, numbers: &Numbers, [left, top]: [f64; 2]) {
    let Numbers { layout, planes, width, .. } = *numbers;
    let readings = planes.row / planes.stride;
    let title = format!(
        "Planes of a distance ring, Eq. (9): row by row, reading by reading, up to {readings} readings"
    );
    drawing.text(&title, 14.5, [LEFT, top - 14.0], TextAnchor::Start, Rgb::INK);
    let scale = WHOLE / count(planes.stride);
    let mut y = top;
    let mut draw_row = |drawing: &mut Drawing, label: &str, color: Option<Rgb>| {
        let long = [WHOLE, ROW];
        drawing.text(label, SMALL, [left - 8.0, y + 10.5], TextAnchor::End, Rgb::INK);
        if let Some(color) = color {
            drawing.block([left, y], long, LIGHT);
            let cells = [left + count(planes.border) * scale, y];
            drawing.block(cells, [count(width) * scale, ROW], color);
            for block in 0..=width.div_ceil(layout.lanes) {
                let x = cells[0] + count(block * layout.lanes) * scale;
                drawing.line(&[[x, y], [x, y + ROW]], GREY, 0.8);
            }
            let x = left + count(planes.border + GROUP * layout.lanes + 11) * scale;
            drawing.block([x, y], [count(layout.lanes) * scale, ROW], ORANGE);
            drawing.frame([left, y], long, GREY, 0.8);
        }
        y += ROW;
    };
    for row in 0..2 {
        let color = if row == 0 { PALE } else { pale(GREEN) };
        let name = |reading: usize| match row {
            0 => format!("row y, reading {reading}"),
            _ => format!("row y + 1, reading {reading}"),
        };
        draw_row(drawing, &name(0), Some(color));
        draw_row(drawing, &name(1), Some(color));
        draw_row(drawing, "…", None);
        draw_row(drawing, &name(readings - 1), Some(color));
        draw_row(drawing, "", None);
    }
    let text = format!(
        "border {} on either side, and as many rows; {} from one reading to the next, {} from one row to \
         the next; orange: the cells of one group",
        planes.border, planes.stride, planes.row
    );
    whisper(drawing, &text, [LEFT, top + 10.0 * ROW + 16.0]);
}
