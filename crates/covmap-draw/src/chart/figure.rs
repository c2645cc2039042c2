//! The panels of a figure, in rows and columns whose frames are in line.

use super::marks::{Legend, Look};
use super::panel::{Heading, Margins, Prepared};
use super::scene::Scene;
use super::{Figure, Panel, Series};

const MARGIN: f32 = 18.0;
/// Gaps between panels.
const GUTTER: [f32; 2] = [22.0, 20.0];
const MOST_COLUMNS: usize = 12;

/// Returns the width of a panel, the height of its frame, and the sizes of title and subtitle.
fn sizes(panels: usize, columns: usize) -> (f32, f32, (f32, f32)) {
    let small = (14.5, 12.0);
    match columns {
        1 if panels <= 1 => (780.0, 400.0, (18.0, 13.0)),
        1 => (780.0, 260.0, (16.0, 13.0)),
        2 => (500.0, 280.0, small),
        3 => (335.0, 200.0, small),
        4 => (265.0, 170.0, small),
        _ => (245.0, 160.0, (13.5, 11.5)),
    }
}

impl Figure {
    /// Finds a place for all panels and the legend.
    pub(super) fn lay_out(&self) -> Scene {
        let columns = self.columns.clamp(1, MOST_COLUMNS).min(self.panels.len().max(1));
        let (panel_width, frame_height, text) = sizes(self.panels.len(), columns);
        let inner = columns as f32 * (panel_width + GUTTER[0]) - GUTTER[0];
        let heading = Heading::new((&self.title, 20.0), (&self.subtitle, 13.0), inner);
        // Columns differ a little in width, so that their frames do not.
        let text_width = if columns > 1 { 0.9 * panel_width } else { panel_width };
        let shared = self.shared_series();
        let own_legend = shared.is_none();
        let panels: Vec<Prepared<'_>> = self
            .panels
            .iter()
            .map(|panel| panel.prepare(text, text_width, frame_height, own_legend))
            .collect();

        let mut scene = Scene {
            width: inner + 2.0 * MARGIN,
            height: 0.0,
            name: self.name(),
            shapes: Vec::new(),
        };
        heading.draw(&mut scene, [MARGIN, MARGIN]);
        let above = heading.height();
        let mut y = MARGIN + if above > 0.0 { (above + 14.0).ceil() } else { 0.0 };
        let wide = (0..columns).map(|column| widest(panels.iter().skip(column).step_by(columns)));
        let wide: Vec<Margins> = wide.collect();
        let taken: f32 = wide.iter().map(|margins| margins.left + margins.right).sum();
        let frame_width = (panel_width - taken / columns as f32).max(40.0).floor();
        let size = [frame_width, frame_height];
        for row in panels.chunks(columns) {
            let high = widest(row.iter());
            let mut x = MARGIN;
            for (panel, Margins { left, right, .. }) in row.iter().zip(wide.iter().copied()) {
                panel.draw(&mut scene, [x, y], Margins { left, right, ..high }, size);
                x += left + frame_width + right + GUTTER[0];
            }
            y += high.top + frame_height + high.bottom + GUTTER[1];
        }
        let legend = Legend::new(shared.unwrap_or_default().into_iter(), inner);
        legend.draw(&mut scene, [MARGIN, y - GUTTER[1] + 8.0]);
        let below = if legend.height > 0.0 { legend.height + 8.0 } else { 0.0 };
        scene.height = (y - GUTTER[1] + below + MARGIN).ceil().max(2.0 * MARGIN);
        scene
    }

    /// Returns the name of the drawing.
    fn name(&self) -> String {
        match self.panels.first() {
            Some(Panel::Chart(chart)) if self.title.is_empty() => chart.title.clone(),
            Some(Panel::HeatMap(map)) if self.title.is_empty() => map.title.clone(),
            _ => self.title.clone(),
        }
    }

    /// Returns the series of all charts, if one legend can explain them: if series that look the
    /// same have the same name, and the other way about.
    fn shared_series(&self) -> Option<Vec<(usize, &Series)>> {
        let mut all: Vec<(usize, &Series)> = Vec::new();
        let charts = self.panels.iter().filter_map(|panel| match panel {
            Panel::Chart(chart) => Some(chart),
            Panel::HeatMap(_) => None,
        });
        for (index, series) in charts.flat_map(|chart| chart.series.iter().enumerate()) {
            let look = Look::new(index, series);
            let known =
                all.iter().find(|(other, known)| *other == index || known.name == series.name);
            match known {
                None => all.push((index, series)),
                Some((other, known))
                    if Look::new(*other, known) == look && known.name == series.name => {}
                Some(_) => return None,
            }
        }
        all.sort_by_key(|(index, _)| *index);
        Some(all)
    }
}

/// Returns the margins in which each of some panels has room.
fn widest<'a>(panels: impl Iterator<Item = &'a Prepared<'a>>) -> Margins {
    panels.map(Prepared::margins).fold(Margins::default(), |a, b| Margins {
        left: a.left.max(b.left),
        right: a.right.max(b.right),
        top: a.top.max(b.top),
        bottom: a.bottom.max(b.bottom),
    })
}
