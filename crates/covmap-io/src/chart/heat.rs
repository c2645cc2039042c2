//! The cells of a heat map and the bar of its colours.

use super::area::{Area, reach};
use super::scale::{Scale, Tick};
use super::scene::Scene;
use super::{ColorMap, HeatMap};
use crate::picture::Rgb;

/// From the frame to the bar, and the width of the bar.
const BAR_GAP: f32 = 16.0;
const BAR: f32 = 15.0;
const FRAME: Rgb = Rgb(120, 130, 142);

/// To the nearest pixel of the PNG, so that cells meet without a seam.
fn snap(value: f32) -> f32 {
    (value * 2.0).round() / 2.0
}

/// From the frame to the far end of the labels of the bar.
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
            let mut run: Option<([f32; 2], Rgb)> = None;
            let mut draw = |run: Option<([f32; 2], Rgb)>| {
                if let Some(([left, right], color)) = run {
                    scene.block([left, top], [right - left, bottom - top], color);
                }
            };
            for (column, value) in columns.iter().zip(values_of_row) {
                let share = values.share(*value);
                let cell = column.zip(share.map(|share| self.color_map.color(share)));
                run = match (run, cell) {
                    (run, None) => {
                        draw(run);
                        None
                    }
                    (Some(([left, end], color)), Some(([from, right], next)))
                        if next == color && end.total_cmp(&from).is_eq() =>
                    {
                        Some(([left, right], color))
                    }
                    (run, next) => {
                        draw(run);
                        next
                    }
                };
            }
            draw(run);
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
    let (right, bottom) = (left + BAR, top + height);
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
    scene.line(corners.to_vec(), FRAME, 1.0, &[]);
    area.draw_side_ticks(scene, right, 1.0, ticks);
}
