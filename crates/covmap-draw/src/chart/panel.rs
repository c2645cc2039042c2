//! One panel of a figure: the room around its frame, and its drawing.

use super::area::{Area, clip, is_inside, reach, reach_below, room_across, room_upwards, widest};
use super::heat::{bar_reach, draw_bar};
use super::marks::{Legend, Look};
use super::scale::{Scale, Tick};
use super::scene::{Anchor, Scene, shorten, wrap};
use super::{Chart, ChartAxis, HeatMap, Panel};
use crate::picture::Rgb;

const LABEL_SIZE: f32 = 13.0;
/// Room for the name of an axis beside the labels of its ticks.
const LABEL_ROW: f32 = 24.0;

/// Lines of text above a panel or a figure.
#[derive(Debug, Clone, Default)]
pub(super) struct Heading {
    lines: Vec<(String, f32, Rgb)>,
}

impl Heading {
    pub(super) fn new(title: (&str, f32), subtitle: (&str, f32), width: f32) -> Self {
        let titles = wrap(title.0, title.1, width, 2).into_iter();
        let subtitles = wrap(subtitle.0, subtitle.1, width, 3).into_iter();
        let titles = titles.map(|line| (line, title.1, Rgb::INK));
        Self {
            lines: titles.chain(subtitles.map(|line| (line, subtitle.1, Rgb::GREY_INK))).collect(),
        }
    }

    pub(super) fn height(&self) -> f32 {
        self.lines.iter().map(|(_, size, _)| size * 1.4).sum()
    }

    pub(super) fn draw(&self, scene: &mut Scene, [x, mut y]: [f32; 2]) {
        for (line, size, color) in &self.lines {
            scene.text(line, *size, [x, y + size], Anchor::Start, *color);
            y += size * 1.4;
        }
    }
}

/// Room around the frame of a panel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Margins {
    pub(super) left: f32,
    pub(super) right: f32,
    pub(super) top: f32,
    pub(super) bottom: f32,
}

/// A panel whose axes are known.
#[derive(Debug, Clone)]
pub(super) struct Prepared<'a> {
    panel: &'a Panel,
    heading: Heading,
    legend: Legend,
    x: Scale,
    y: Scale,
    y_ticks: Vec<Tick>,
    /// Length by which a label of the x axis may reach beyond the end of the axis.
    overhang: f32,
    /// Distance from the x axis to the lower end of its labels.
    below: f32,
    /// The scale of the colours, if there are any.
    value: Option<(Scale, Vec<Tick>)>,
}

impl Panel {
    fn texts(&self) -> (&str, &str) {
        match self {
            Self::Chart(chart) => (&chart.title, &chart.subtitle),
            Self::HeatMap(map) => (&map.title, &map.subtitle),
        }
    }

    /// Returns the axes to the right and upwards.
    fn axes(&self) -> (&ChartAxis, &ChartAxis) {
        match self {
            Self::Chart(chart) => (&chart.x, &chart.y),
            Self::HeatMap(map) => (&map.x, &map.y),
        }
    }

    /// Returns the ticks of the axis to the right, of a length: names, or round numbers.
    fn x_ticks(&self, x: &Scale, length: f32) -> Vec<Tick> {
        let (axis, _) = self.axes();
        if axis.names.is_empty() {
            return x.ticks(length, room_across);
        }
        let tick = |(index, name): (usize, &String)| {
            let share = x.share(index as f64 + 1.0).filter(|share| is_inside([*share, 0.0]))?;
            Some(Tick { share, label: name.clone() })
        };
        axis.names.iter().enumerate().filter_map(tick).collect()
    }

    /// Chooses the axes and the labels beside a frame of a height, in a panel of a width.
    pub(super) fn prepare(
        &self,
        (title_size, subtitle_size): (f32, f32),
        width: f32,
        height: f32,
        own_legend: bool,
    ) -> Prepared<'_> {
        let (title, subtitle) = self.texts();
        let (x, y, value) = match self {
            Self::Chart(chart) => {
                let (x, y) = chart.scales();
                (x, y, None)
            }
            Self::HeatMap(map) => {
                let x = Scale::new(&map.x, map.x_edges.iter().copied(), false);
                let y = Scale::new(&map.y, map.y_edges.iter().copied(), false);
                let value = Scale::new(&map.value, map.values.iter().copied(), false);
                (x, y, Some((value, value.ticks(height, room_upwards))))
            }
        };
        let legend = match self {
            Self::Chart(chart) if own_legend => Legend::new(chart.series.iter().enumerate(), width),
            _ => Legend::default(),
        };
        let heading = Heading::new((title, title_size), (subtitle, subtitle_size), width);
        let y_ticks = y.ticks(height, room_upwards);
        // Half of a label; a part of it may reach into the white between panels.
        let x_ticks = self.x_ticks(&x, width);
        let overhang = widest(&x_ticks) / 2.0 - 6.0;
        let below = reach_below(&x_ticks);
        Prepared { panel: self, heading, legend, x, y, y_ticks, overhang, below, value }
    }
}

impl Chart {
    /// Returns the axes. The axis to the right holds all points; the axis upwards holds the visible ones.
    fn scales(&self) -> (Scale, Scale) {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let x = Scale::new(&self.x, points().map(|point| point.x), true);
        let seen = points().filter(|point| x.share(point.x).is_some_and(|s| is_inside([s, 0.0])));
        let values = seen.filter(|point| point.y.is_finite());
        let y = Scale::new(&self.y, values.flat_map(|p| [p.y, p.low, p.high]), true);
        (x, y)
    }

    fn draw(&self, scene: &mut Scene, area: &Area) {
        let mut empty = true;
        for (index, series) in self.series.iter().enumerate() {
            let look = Look::new(index, series);
            let shares: Vec<Option<[f64; 2]>> =
                series.points.iter().map(|point| area.shares(point.x, point.y)).collect();
            for (point, at) in series.points.iter().zip(&shares) {
                if let Some(at) = at.filter(|at| is_inside([at[0], 0.5])) {
                    draw_error_bar(scene, area, look, at, [point.low, point.high]);
                }
            }
            if series.line {
                for run in shares.split(Option::is_none) {
                    let run: Vec<[f64; 2]> = run.iter().flatten().copied().collect();
                    for piece in clip(&run) {
                        let points = piece.into_iter().map(|at| area.place(at)).collect();
                        look.draw_line(scene, points);
                    }
                }
            }
            if series.marks {
                for (point, at) in series.points.iter().zip(&shares) {
                    if let Some(at) = at.filter(|at| is_inside(*at)) {
                        look.draw_mark(scene, area.place(at), point.hollow);
                    }
                }
            }
            empty &= shares.iter().all(Option::is_none);
        }
        if empty {
            let at = area.place([0.5, 0.5]);
            scene.text("no data", LABEL_SIZE, at, Anchor::Middle, Rgb::GREY_INK);
        }
    }
}

/// Draws the error bar of a point, as far as it lies in the frame.
fn draw_error_bar(scene: &mut Scene, area: &Area, look: Look, at: [f64; 2], ends: [f64; 2]) {
    let beyond = [f64::NEG_INFINITY, f64::INFINITY];
    let shares = [0, 1].map(|end| match area.y.share(ends[end]) {
        Some(share) => share,
        None if ends[end].is_nan() => at[1],
        // Beyond all numbers, or nothing on a logarithmic axis: as far as the frame.
        None => beyond[end],
    });
    let [low, high] = shares.map(|share| share.clamp(0.0, 1.0));
    let seen = shares[0].min(shares[1]) <= 1.0 && shares[0].max(shares[1]) >= 0.0;
    if seen && (high - low).abs() > 1e-9 {
        let capped = shares.map(|share| is_inside([0.5, share]));
        let y = |share: f64| area.place([at[0], share])[1];
        let x = area.place(at)[0];
        look.draw_bar(scene, x, [(y(low), capped[0]), (y(high), capped[1])]);
    }
}

impl Prepared<'_> {
    pub(super) fn margins(&self) -> Margins {
        let (x, y) = self.panel.axes();
        let row = |axis: &ChartAxis| if axis.label.trim().is_empty() { 4.0 } else { LABEL_ROW };
        let right = match (&self.value, self.panel) {
            (Some((_, ticks)), Panel::HeatMap(map)) => bar_reach(ticks) + row(&map.value),
            _ => 12.0,
        };
        let above = self.heading.height();
        let below = self.below + row(x) + self.legend.height;
        Margins {
            left: (reach(&self.y_ticks) + row(y)).max(self.overhang).ceil(),
            right: right.max(self.overhang).ceil(),
            top: if above > 0.0 { (above + 8.0).ceil() } else { 8.0 },
            bottom: (below + if self.legend.height > 0.0 { 6.0 } else { 0.0 }).ceil(),
        }
    }

    /// Draws the panel with its top left corner at a point. `margins` are at least those of the panel.
    pub(super) fn draw(
        &self,
        scene: &mut Scene,
        [left, top]: [f32; 2],
        margins: Margins,
        size: [f32; 2],
    ) {
        self.heading.draw(scene, [left, top + margins.top - 8.0 - self.heading.height()]);
        let at = [left + margins.left, top + margins.top];
        let area = Area { at, size, x: self.x, y: self.y };
        let x_ticks = self.panel.x_ticks(&self.x, size[0]);
        let frame_ticks = (&x_ticks[..], &self.y_ticks[..]);
        match (self.panel, &self.value) {
            (Panel::HeatMap(map), Some((value, ticks))) => {
                map.draw_cells(scene, &area, value);
                area.draw_frame(scene, frame_ticks, false);
                draw_bar(scene, &area, map.color_map, ticks);
                self.draw_value_name(scene, &area, map, ticks);
            }
            (Panel::Chart(chart), _) => {
                area.draw_frame(scene, frame_ticks, true);
                chart.draw(scene, &area);
            }
            (Panel::HeatMap(_), None) => {}
        }
        let (x, y) = self.panel.axes();
        let below = at[1] + size[1] + self.below;
        let name = shorten(&x.label, LABEL_SIZE, size[0] + 24.0);
        let middle = at[0] + size[0] / 2.0;
        scene.text(&name, LABEL_SIZE, [middle, below + 17.0], Anchor::Middle, Rgb::INK);
        let name = shorten(&y.label, LABEL_SIZE, size[1] + 12.0);
        let beside = at[0] - reach(&self.y_ticks) - 10.0;
        scene.turned_text(&name, LABEL_SIZE, [beside, at[1] + size[1] / 2.0], Rgb::INK);
        let under = if x.label.trim().is_empty() { 4.0 } else { LABEL_ROW };
        self.legend.draw(scene, [left, below + under + 6.0]);
    }

    fn draw_value_name(&self, scene: &mut Scene, area: &Area, map: &HeatMap, ticks: &[Tick]) {
        let name = shorten(&map.value.label, LABEL_SIZE, area.size[1] + 12.0);
        let x = area.at[0] + area.size[0] + bar_reach(ticks) + 18.0;
        scene.turned_text(&name, LABEL_SIZE, [x, area.at[1] + area.size[1] / 2.0], Rgb::INK);
    }
}
