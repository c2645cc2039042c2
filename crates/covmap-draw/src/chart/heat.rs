//! The cells of a heat map and the bar of its colours.

use super::area::{Area, reach};
use super::scale::{Scale, Tick};
use super::scene::Scene;
use super::{ColorMap, HeatMap};
use crate::picture::Rgb;

/// Gap between the frame and the bar; `BAR` is the width of the bar.
const BAR_GAP: f32 = 16.0;
const BAR: f32 = 15.0;

/// Extent of a cell in its row, and its colour; `None` if the cell is not drawn.
type Cell = Option<([f32; 2], Rgb)>;

/// Returns whether two neighbours in a row are drawn as one.
fn are_joined(cell: &Cell, next: &Cell) -> bool {
    match (cell, next) {
        (Some(([_, end], color)), Some(([from, _], next))) => {
            color == next && end.total_cmp(from).is_eq()
        }
        _ => false,
    }
}

/// Rounds to the nearest pixel of the PNG, so that cells meet without a seam.
fn snap(value: f32) -> f32 {
    (value * 2.0).round() / 2.0
}

/// Returns the distance from the frame to the far end of the labels of the bar.
pub(super) fn bar_reach(ticks: &[Tick]) -> f32 {
    BAR_GAP + BAR + reach(ticks)
}

impl HeatMap {
    /// Draws the cells; neighbours of one colour in a row are one rectangle.
    pub(super) fn draw_cells(&self, scene: &mut Scene, area: &Area, values: &Scale) {
        let spans = |edges: &[f64], axis: &Scale, upwards: bool| -> Vec<Option<[f32; 2]>> {
            let place = |edge: f64| {
                let share = axis.edge(edge)?;
                Some(snap(area.place([share, share])[usize::from(upwards)]))
            };
            let pair = |pair: &[f64]| {
                let (a, b) = (place(pair[0])?, place(pair[1])?);
                (a.total_cmp(&b).is_ne()).then(|| [a.min(b), a.max(b)])
            };
            edges.windows(2).map(pair).collect()
        };
        let columns = spans(&self.x_edges, &area.x, false);
        let rows = spans(&self.y_edges, &area.y, true);
        if columns.is_empty() {
            return;
        }
        for (row, values_of_row) in rows.iter().zip(self.values.chunks(columns.len())) {
            let Some([top, bottom]) = *row else { continue };
            let cell = |(column, value): (&Option<[f32; 2]>, &f64)| -> Cell {
                column.zip(values.share(*value).map(|share| self.color_map.color(share)))
            };
            let cells: Vec<Cell> = columns.iter().zip(values_of_row).map(cell).collect();
            for run in cells.chunk_by(are_joined) {
                if let [Some(([left, _], color)), ..] = run
                    && let [.., Some(([_, right], _))] = run
                {
                    scene.block([*left, top], [right - left, bottom - top], *color);
                }
            }
        }
    }
}

/// Draws the bar of colours beside the frame.
pub(super) fn draw_bar(scene: &mut Scene, area: &Area, colors: ColorMap, ticks: &[Tick]) {
    let [left, top] = [area.at[0] + area.size[0] + BAR_GAP, area.at[1]];
    let height = area.size[1];
    for step in 0..128u8 {
        let share = f32::from(step) / 128.0;
        let (from, to) = (snap(top + share * height), snap(top + (share + 1.0 / 128.0) * height));
        let color = colors.color(1.0 - (f64::from(step) + 0.5) / 128.0);
        scene.block([left, from], [BAR, to - from], color);
    }
    scene.frame([left, top], [BAR, height], Rgb::FRAME);
    area.draw_side_ticks(scene, left + BAR, 1.0, ticks);
}
