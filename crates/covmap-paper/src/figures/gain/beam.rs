//! One beam: its cells, its rings, an outcome with its end, and the horizon.

use super::moment::{Moment, Seen};
use super::style::{
    BLUE, GREY, GREY_INK, LIGHT, ORANGE, PALE, PURPLE, SKY, SMALL, TEXT, VERMILION, count, keys,
    pale,
};
use covmap_draw::{Drawing, Rgb, TextAnchor};
use covmap_gain::StencilCell;

const WIDTH: f64 = 1040.0;
const LEFT: f64 = 64.0;
/// The height of the bars of probabilities.
const BARS: f64 = 110.0;
/// Half of a beam's width, divided by its distance from the robot's centre.
const HALF_WIDTH: f64 = 0.13;

/// The place of a cell relative to the end of an outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    InFront,
    AtEnd,
    Behind,
    NotCovered,
}

impl Part {
    pub(super) fn color(self) -> Rgb {
        match self {
            Self::InFront => SKY,
            Self::AtEnd => ORANGE,
            Self::Behind => PURPLE,
            Self::NotCovered => LIGHT,
        }
    }
}

/// Returns the part of an outcome in which the i-th cell of a beam lies.
pub(super) fn part(moment: &Moment, seen: Seen, k: usize, i: usize) -> Part {
    let (beam, outcome) = (moment.beam(seen), moment.stencil.outcome(k));
    let Some(parameters) = moment.model.parameters().update.cause() else { return Part::InFront };
    let role = parameters.role(moment.config.resolution, beam.cells[i].met(), outcome);
    match role.weight {
        _ if i >= beam.reach(k) => Part::NotCovered,
        weight if weight <= 0.0 => Part::InFront,
        weight if weight < 1.0 => Part::Behind,
        _ => Part::AtEnd,
    }
}

/// The frame of the drawing: points along a beam and to its left, from its sensor \[m\].
struct Frame {
    scale: f64,
    sensor: [f64; 2],
    axis: (f64, f64),
    mount: f64,
}

impl Frame {
    fn along(&self, [along, left]: [f64; 2]) -> [f64; 2] {
        [self.sensor[0] + self.scale * along, self.sensor[1] - self.scale * left]
    }

    /// Returns the place of a point of the map, given from the centre of the view-point's cell.
    fn of_map(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.axis;
        self.along([x * cos + y * sin - self.mount, y * cos - x * sin])
    }

    /// Returns an arc around the sensor, as wide as the beam's cells and `more` \[m\] to either
    /// side.
    fn arc(&self, radius: f64, more: f64) -> Vec<[f64; 2]> {
        let half = ((HALF_WIDTH * (radius + self.mount) + more) / radius.max(1e-3)).min(0.6);
        let angle = |i: i32| half * (f64::from(i) / 8.0 - 1.0);
        (0..=16)
            .map(|i| self.along([radius * libm::cos(angle(i)), radius * libm::sin(angle(i))]))
            .collect()
    }
}

pub(super) fn draw(moment: &Moment, seen: Seen) -> Drawing {
    let r = moment.config.resolution;
    let (beam, likelihood) = (moment.beam(seen), moment.likelihood(seen));
    let echoes = moment.stencil.ranges.len();
    let likeliest = (0..echoes)
        .max_by(|a, b| likelihood.probability(*a).total_cmp(&likelihood.probability(*b)))
        .unwrap_or(0);
    let horizon = moment.horizon(seen);
    let reach = beam.cells.last().map_or(1.0, |cell| cell.cell_distance);
    let pose = moment.ring.beams()[seen.beam].pose;
    let mount = pose.translation.vector.norm();
    let scale = (WIDTH - LEFT - 40.0) / (reach + mount + r);
    let subtitle = format!(
        "beam {} of the view-point in column {}, row {}; {}",
        seen.beam,
        seen.view_point.x,
        seen.view_point.y,
        moment.words()
    );
    let half_height = scale * (0.155 * reach + r);
    let mut drawing = Drawing::new(
        "One beam, one outcome: which of its cells are in front of the end, at it, and behind it",
        &subtitle,
        [WIDTH, 70.0 + 26.0 + 2.0 * half_height + 34.0 + BARS + 84.0],
    );
    let top = drawing.top();
    let frame = Frame {
        scale,
        sensor: [LEFT + scale * mount, top + half_height + 26.0],
        axis: libm::sincos(pose.rotation.angle()),
        mount,
    };
    for (i, cell) in beam.cells.iter().enumerate() {
        let part = part(moment, seen, likeliest, i);
        let fill = if i < horizon { part.color() } else { pale(part.color()) };
        drawing.polygon(&corners(&frame, cell, r), fill, Rgb::WHITE, 0.8);
    }
    for k in 0..=echoes {
        let arc = frame.arc((count(k) + 0.5) * r, 0.5 * r);
        drawing.line(&arc, GREY_INK, 0.6);
    }
    // The robot's centre, and the sensor.
    let center = frame.along([-mount, 0.0]);
    drawing.disc(center, 5.0, Rgb::INK, Rgb::WHITE);
    drawing.disc(frame.sensor, 3.5, Rgb::WHITE, Rgb::INK);
    drawing.dashed(&[center, frame.sensor], Rgb::INK, 1.0);
    let note = |drawing: &mut Drawing, text: &str, at: [f64; 2], color: Rgb| {
        drawing.text(text, TEXT, at, TextAnchor::Middle, color);
    };
    note(&mut drawing, "view-point", [center[0] + 6.0, center[1] + 24.0], Rgb::INK);
    note(&mut drawing, "sensor", [frame.sensor[0], frame.sensor[1] - 14.0], Rgb::INK);

    let low = frame.sensor[1] + half_height;
    let end = moment.stencil.ranges[likeliest];
    let arc = frame.arc(end, 0.16);
    drawing.dashed(&arc, Rgb::INK, 1.8);
    let tip = [arc[16][0], arc[16][1] - 8.0];
    note(&mut drawing, &format!("the end: d = {end:.1} m"), tip, Rgb::INK);
    if let Some(last) = horizon.checked_sub(1).map(|last| beam.cells[last].cell_distance)
        && horizon < beam.cells.len()
    {
        let arc = frame.arc(last + 0.5 * r, 0.12);
        drawing.line(&arc, VERMILION, 2.6);
        let at = [arc[0][0] - 6.0, arc[0][1] + 16.0];
        let text = format!("horizon: {horizon} of {} cells decide", beam.cells.len());
        drawing.text(&text, TEXT, at, TextAnchor::Middle, VERMILION);
    }
    draw_bars(&mut drawing, moment, seen, (&frame, low + 34.0), likeliest);
    let meanings = [
        (Part::InFront.color(), "in front: says “free”"),
        (Part::AtEnd.color(), "at the end"),
        (Part::Behind.color(), "behind: says “covered”"),
        (LIGHT, "not covered by this outcome"),
        (pale(LIGHT), "beyond the horizon"),
    ];
    keys(&mut drawing, [LEFT, low + 34.0 + BARS + 66.0], &meanings);
    drawing
}

/// Returns the corners of a cell.
fn corners(frame: &Frame, cell: &StencilCell, r: f64) -> Vec<[f64; 2]> {
    let (x, y) = (f64::from(cell.dx), f64::from(cell.dy));
    [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
        .map(|(right, up)| frame.of_map([(x + right) * r, (y + up) * r]))
        .to_vec()
}

/// Draws p(d | c) of every outcome, under the ring in which it ends.
fn draw_bars(
    drawing: &mut Drawing,
    moment: &Moment,
    seen: Seen,
    (frame, top): (&Frame, f64),
    likeliest: usize,
) {
    let (likelihood, r) = (moment.likelihood(seen), moment.config.resolution);
    let echoes = moment.stencil.ranges.len();
    let most = (0..echoes).map(|k| likelihood.probability(k)).fold(0.0, f64::max);
    let base = top + BARS;
    let left = frame.along([-0.5 * r, 0.0])[0];
    let right = frame.along([(count(echoes) + 0.5) * r, 0.0])[0];
    drawing.block([left, top], [right - left, BARS], PALE);
    for share in [0.5, 1.0] {
        let y = base - share * 0.9 * BARS;
        drawing.line(&[[left, y], [right, y]], LIGHT, 1.0);
        let label = format!("{:.2}", share * most);
        drawing.text(&label, SMALL, [left - 6.0, y + 4.0], TextAnchor::End, GREY_INK);
    }
    for k in 0..echoes {
        let height = 0.9 * BARS * likelihood.probability(k) / most.max(1e-9);
        let x = frame.along([(count(k) - 0.5) * r, 0.0])[0];
        let width = frame.scale * r;
        let color = if k == likeliest { ORANGE } else { BLUE };
        if height > 0.0 {
            drawing.block([x + 1.5, base - height.max(1.0)], [width - 3.0, height.max(1.0)], color);
        }
        if k % 5 == 0 {
            let at = [x + 0.5 * width, base + 16.0];
            let label = format!("{:.1}", moment.stencil.ranges[k]);
            drawing.text(&label, SMALL, at, TextAnchor::Middle, Rgb::INK);
        }
    }
    drawing.line(&[[left, base], [right, base]], GREY, 1.0);
    let middle = 0.5 * (left + right);
    drawing.text("range d_k [m]", TEXT, [middle, base + 34.0], TextAnchor::Middle, Rgb::INK);
    drawing.turned_text("P(k)", TEXT, [left - 44.0, top + 0.5 * BARS], Rgb::INK);
    let no_echo = format!(
        "P(no echo) = {:.3}, all together {:.6}",
        likelihood.no_echo,
        (0..=echoes).map(|k| likelihood.probability(k)).sum::<f64>()
    );
    drawing.text(&no_echo, TEXT, [right, top - 8.0], TextAnchor::End, Rgb::INK);
}
