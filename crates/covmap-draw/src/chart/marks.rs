//! Colours, marks and dashes that tell series apart, and the legend that names them.

use super::Series;
use super::scene::{Anchor, Scene, Shape, shorten};
use crate::picture::{Rgb, text::text_width};

/// The palette of Okabe and Ito, which the colour-blind can tell apart too; without its yellow,
/// which is too pale for lines on white.
const COLORS: [Rgb; 7] = [
    Rgb(0, 114, 178),
    Rgb(213, 94, 0),
    Rgb(0, 158, 115),
    Rgb(204, 121, 167),
    Rgb(230, 159, 0),
    Rgb(86, 180, 233),
    Rgb(70, 70, 70),
];
/// Dashes of lines without marks.
const DASHES: [&[f32]; 4] = [&[], &[7.0, 4.0], &[2.0, 3.0], &[9.0, 3.5, 2.0, 3.5]];
const LINE: f32 = 2.0;
const RADIUS: f32 = 3.6;

/// The size of text in a legend.
pub(super) const LEGEND_SIZE: f32 = 13.0;
const SAMPLE: f32 = 30.0;
const GAP: f32 = 7.0;
const BETWEEN: f32 = 22.0;
const ROW: f32 = 21.0;

/// The look of a series, by its place among the series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Look {
    index: usize,
    pub(super) line: bool,
    pub(super) marks: bool,
}

impl Look {
    pub(super) fn new(index: usize, series: &Series) -> Self {
        Self { index, line: series.line, marks: series.marks }
    }

    pub(super) fn color(self) -> Rgb {
        COLORS[self.index % COLORS.len()]
    }

    pub(super) fn draw_line(self, scene: &mut Scene, points: Vec<[f32; 2]>) {
        let dashes = if self.marks { DASHES[0] } else { DASHES[self.index % DASHES.len()] };
        scene.line(points, self.color(), LINE, dashes);
    }

    /// Draws the mark of the series. The numbers of colours and of marks have no common divisor, so
    /// a colour that is used again has another mark.
    pub(super) fn draw_mark(self, scene: &mut Scene, [x, y]: [f32; 2], hollow: bool) {
        let color = self.color();
        let (fill, rim, width) =
            if hollow { (Rgb::WHITE, color, 1.8) } else { (color, Rgb::WHITE, 0.7) };
        let around = |corners: &[[f32; 2]]| Shape::Polygon {
            corners: corners.iter().map(|[a, b]| [x + a * RADIUS, y + b * RADIUS]).collect(),
            fill,
            rim,
            width,
        };
        let shape = match self.index % 8 {
            0 => Shape::Disc { center: [x, y], radius: RADIUS, fill, rim, width },
            1 => around(&[[-0.95, -0.95], [0.95, -0.95], [0.95, 0.95], [-0.95, 0.95]]),
            2 => around(&[[0.0, -1.25], [1.15, 0.85], [-1.15, 0.85]]),
            3 => around(&[[0.0, -1.35], [1.35, 0.0], [0.0, 1.35], [-1.35, 0.0]]),
            4 => around(&[[0.0, 1.25], [1.15, -0.85], [-1.15, -0.85]]),
            5 => around(&[[0.0, -1.3], [1.24, -0.4], [0.76, 1.05], [-0.76, 1.05], [-1.24, -0.4]]),
            6 => around(&[[-0.6, -1.3], [0.6, -1.3], [0.6, 1.3], [-0.6, 1.3]]),
            _ => around(&[[-1.3, -0.6], [1.3, -0.6], [1.3, 0.6], [-1.3, 0.6]]),
        };
        scene.shapes.push(shape);
    }

    /// Draws an error bar; an end that is cut off by the frame has no cap.
    pub(super) fn draw_bar(self, scene: &mut Scene, x: f32, ends: [(f32, bool); 2]) {
        let color = self.color();
        let width = 1.2;
        scene.line(vec![[x, ends[0].0], [x, ends[1].0]], color, width, &[]);
        for (y, capped) in ends {
            if capped {
                scene.line(vec![[x - 3.5, y], [x + 3.5, y]], color, width, &[]);
            }
        }
    }
}

/// The names of series, with their looks.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Legend {
    /// Name, look, and place from the top left of each.
    entries: Vec<(String, Look, [f32; 2])>,
    pub(super) height: f32,
}

impl Legend {
    /// Finds a place for the series that have a name, in rows of a width.
    pub(super) fn new<'a>(series: impl Iterator<Item = (usize, &'a Series)>, width: f32) -> Self {
        let mut legend = Self::default();
        let (mut x, mut y) = (0.0, 0.0);
        for (index, series) in series.filter(|(_, series)| !series.name.trim().is_empty()) {
            let name = shorten(&series.name, LEGEND_SIZE, width - SAMPLE - GAP);
            let needed = SAMPLE + GAP + text_width(&name, LEGEND_SIZE);
            if x > 0.0 && x + needed > width {
                (x, y) = (0.0, y + ROW);
            }
            legend.entries.push((name, Look::new(index, series), [x, y]));
            legend.height = y + ROW;
            x += needed + BETWEEN;
        }
        legend
    }

    pub(super) fn draw(&self, scene: &mut Scene, [left, top]: [f32; 2]) {
        for (name, look, [x, y]) in &self.entries {
            let (x, middle) = (left + x, top + y + ROW / 2.0);
            if look.line {
                look.draw_line(scene, vec![[x, middle], [x + SAMPLE, middle]]);
            }
            if look.marks {
                look.draw_mark(scene, [x + SAMPLE / 2.0, middle], false);
            }
            let at = [x + SAMPLE + GAP, middle + 0.36 * LEGEND_SIZE];
            scene.text(name, LEGEND_SIZE, at, Anchor::Start, Rgb::INK);
        }
    }
}
