//! A decision: E\[I\] of all candidates, their bounds, and the candidates that were evaluated.

use super::moment::Moment;
use super::style::{GREEN, GREY, GREY_INK, ORANGE, SMALL, TEXT, VERMILION, count, key, pale};
use crate::error::Result;
use covmap::Cell;
use covmap_draw::{
    Chart, ChartAxis, ChartPoint, ColorMap, Drawing, Figure, Rgb, Series, TextAnchor,
    coverage_color,
};

const WIDTH: f64 = 1060.0;
const MAP: f64 = 480.0;
const LEFT: f64 = 18.0;
/// The place of the lowest gain on the scale of colours.
const LOWEST: f64 = 0.15;

/// A candidate with the numbers that the figure shows.
struct Shown {
    cell: Cell,
    gain: f64,
    bound: f64,
    /// Whether the decision knew the gain, and not the bound only.
    is_exact: bool,
}

pub(super) fn draw(moment: &Moment) -> Result<Drawing> {
    let mut cache = moment.fresh_cache()?;
    cache.refresh_bounds(&moment.view_points());
    let shown = |candidate: &covmap_plan::CandidateRecord| {
        let index = moment.index(candidate.cell);
        Shown {
            cell: candidate.cell,
            gain: candidate.gain,
            bound: cache.gain(index),
            is_exact: moment.gains.is_exact(index),
        }
    };
    let shown: Vec<Shown> = moment.candidates.iter().map(shown).collect();
    let cells = moment.grid();
    let scale = MAP / count(cells.width());
    let height = scale * count(cells.height());
    let evaluated = shown.iter().filter(|shown| shown.is_exact).count();
    let color_of = |is_exact| if is_exact { ORANGE } else { pale(GREY) };
    let mut drawing = Drawing::new(
        "A decision by IG: where a bound is low enough no gain is needed",
        &format!("{}; {} candidates", moment.words(), shown.len()),
        [WIDTH, 70.0 + 24.0 + height + 64.0 + 545.0],
    );
    let top = drawing.top() + 24.0;
    let right = WIDTH - LEFT - MAP;
    let gains = || shown.iter().map(|shown| shown.gain);
    let (low, high) =
        (gains().fold(f64::INFINITY, f64::min), gains().fold(f64::NEG_INFINITY, f64::max));
    let color = |gain: f64| {
        let share = (gain - low) / (high - low).max(1e-12);
        ColorMap::Inferno.color(LOWEST + (1.0 - LOWEST) * share)
    };
    for (left, title) in [
        (LEFT, "E[I] of every candidate, computed for this figure"),
        (right, "what the decision knew"),
    ] {
        drawing.text(title, 14.5, [left, top - 8.0], TextAnchor::Start, Rgb::INK);
        draw_map(&mut drawing, moment, [left, top], scale);
    }
    for shown in &shown {
        let place = |left| cell_at(moment, shown.cell, [left, top], scale);
        drawing.block(place(LEFT), [scale, scale], color(shown.gain));
        drawing.block(place(right), [scale, scale], color_of(shown.is_exact));
    }
    for left in [LEFT, right] {
        draw_robot(&mut drawing, moment, [left, top], scale);
        drawing.frame([left, top], [MAP, height], GREY, 1.0);
    }
    let below = top + height + 22.0;
    draw_scale(&mut drawing, [LEFT, below], (low, high), color);
    let mut x = right;
    for (is_exact, meaning, number) in
        [(true, "gain evaluated", evaluated), (false, "bound only", shown.len() - evaluated)]
    {
        let text = format!("{meaning}: {number}");
        x = key(&mut drawing, [x, below], color_of(is_exact), &text);
    }
    let at = [right, below + 22.0];
    let text = "disc: robot; ring: chosen; line: the way there; grey: the most likely coverage";
    drawing.text(text, SMALL, at, TextAnchor::Start, GREY_INK);
    drawing.place(&figure(shown, moment), [100.0, below + 34.0]);
    Ok(drawing)
}

/// Returns the place of a cell in the drawing.
fn cell_at(moment: &Moment, cell: Cell, [left, top]: [f64; 2], scale: f64) -> [f64; 2] {
    let from_top = count(moment.grid().height()) - 1.0 - f64::from(cell.y);
    [left + f64::from(cell.x) * scale, top + from_top * scale]
}

/// Draws the most likely coverage.
fn draw_map(drawing: &mut Drawing, moment: &Moment, corner: [f64; 2], scale: f64) {
    let grid = moment.grid();
    let color =
        |cell: Cell| coverage_color(moment.map.is_known(cell).then(|| moment.map.mode(cell)));
    let all: Vec<(Cell, Rgb)> = grid.cells().map(|cell| (cell, color(cell))).collect();
    // Neighbours of the same colour are one block.
    for run in all.chunk_by(|a, b| a.1 == b.1 && a.0.y == b.0.y) {
        let at = cell_at(moment, run[0].0, corner, scale);
        drawing.block(at, [count(run.len()) * scale, scale], run[0].1);
    }
}

/// Draws the robot, the chosen view-point, and the way there.
fn draw_robot(drawing: &mut Drawing, moment: &Moment, corner: [f64; 2], scale: f64) {
    let middle = |cell: Cell| {
        let [x, y] = cell_at(moment, cell, corner, scale);
        [x + 0.5 * scale, y + 0.5 * scale]
    };
    let path = moment.decision.path.iter().copied();
    let way: Vec<[f64; 2]> = std::iter::once(moment.from).chain(path).map(middle).collect();
    drawing.line(&way, Rgb::WHITE, 5.0);
    drawing.line(&way, GREEN, 2.6);
    drawing.disc(middle(moment.from), 7.0, VERMILION, Rgb::WHITE);
    let target = middle(moment.decision.target);
    for (radius, color, width) in [(9.0, Rgb::WHITE, 6.0), (9.0, GREEN, 3.0)] {
        let turn = |i: i32| f64::from(i) * std::f64::consts::TAU / 32.0;
        let point = |i: i32| {
            [target[0] + radius * libm::cos(turn(i)), target[1] + radius * libm::sin(turn(i))]
        };
        drawing.line(&(0..=32).map(point).collect::<Vec<_>>(), color, width);
    }
}

/// Draws the scale of colours of gains.
fn draw_scale(
    drawing: &mut Drawing,
    [left, y]: [f64; 2],
    (low, high): (f64, f64),
    color: impl Fn(f64) -> Rgb,
) {
    let (steps, width) = (60, 200.0);
    for step in 0..steps {
        let share = f64::from(step) / f64::from(steps);
        let at = [left + 46.0 + width * share, y - 10.0];
        drawing.block(
            at,
            [width / f64::from(steps) + 0.5, 13.0],
            color(low + share * (high - low)),
        );
    }
    drawing.text(&format!("{low:.2}"), TEXT, [left, y], TextAnchor::Start, Rgb::INK);
    let text = format!("{high:.2} nats");
    drawing.text(&text, TEXT, [left + 54.0 + width, y], TextAnchor::Start, Rgb::INK);
}

/// Returns the figure of the bounds in descending order, with the gains under them.
fn figure(mut shown: Vec<Shown>, moment: &Moment) -> Figure {
    shown.sort_by(|a, b| b.bound.total_cmp(&a.bound).then(a.cell.cmp(&b.cell)));
    let points = |value: &dyn Fn(&Shown) -> f64, wanted: &dyn Fn(bool) -> bool, thin: bool| {
        let some = shown.iter().enumerate().filter(|(_, shown)| wanted(shown.is_exact));
        let step = if thin { shown.len() / 120 + 1 } else { 1 };
        some.step_by(step)
            .map(|(i, shown)| ChartPoint::new(count(i + 1), value(shown)))
            .collect::<Vec<_>>()
    };
    let gain = |shown: &Shown| shown.gain;
    let best = shown.iter().find(|shown| shown.cell == moment.decision.target);
    let best_gain = best.map_or(0.0, gain);
    let series =
        |name: &str, points, line| Series { name: name.into(), points, line, marks: !line };
    let level = [1.0, count(shown.len())].map(|x| ChartPoint::new(x, best_gain)).to_vec();
    let needless = shown.iter().filter(|shown| shown.bound < best_gain).count();
    let chart = Chart {
        title: "Bounds, largest first, and the gains under them".into(),
        subtitle: format!(
            "{needless} of {} bounds lie below the gain of the chosen view-point, {best_gain:.3} nats",
            shown.len()
        ),
        x: ChartAxis::new("candidates"),
        y: ChartAxis::new("E[I] [nats]"),
        series: vec![
            series("bound", points(&|shown| shown.bound, &|_| true, false), true),
            series("gain that it knew (some)", points(&gain, &|is_exact| is_exact, true), false),
            series("gain not needed (some)", points(&gain, &|is_exact| !is_exact, true), false),
            series("chosen", level, true),
        ],
    };
    Figure { panels: vec![chart.into()], columns: 1, ..Figure::default() }
}
