//! The picture of a decision.

use covmap::{Cell, CoverageMap, Grid, Raster};
use covmap_draw::{ColorMap, Key, Marker, Picture, Rgb};
use covmap_lab::{Moment, results::certain_coverage};
use nalgebra::Point2;

/// The opacity of the gains over the map.
const OPACITY: f64 = 0.9;
/// The place of the lowest gain on the scale of colours; black is for walls.
const LOWEST: f64 = 0.2;
/// The margin around the known cells \[cells\].
const MARGIN: i32 = 3;
const BEST: Rgb = Rgb(30, 160, 190);

/// Draws E\[I\] over the candidates, the five best, and the way to the chosen one.
pub(crate) fn draw(moment: &Moment, (world, step): (&str, usize), reason: &str) -> Picture {
    let Moment { mission, map, trajectory, scans, from, decision, candidates } = moment;
    let grid = mission.grid;
    let mut gains = Raster::filled(grid, None);
    for candidate in candidates {
        if let Some(gain) = gains.get_mut(candidate.cell) {
            *gain = Some(candidate.gain);
        }
    }
    let (low, high) = range(candidates.iter().map(|c| c.gain));
    let scale = |share: f64| ColorMap::Inferno.color(LOWEST + (1.0 - LOWEST) * share);
    let color = |gain: f64| scale((gain - low) / (high - low));

    let mut picture = Picture::new(around_known(map));
    let strategy = &mission.config.planner.strategy;
    picture
        .title(&format!("{world}, {strategy}: decision {step}, after {scans} scans"))
        .subtitle(reason)
        .cells(&certain_coverage(map, mission), |color| *color)
        .overlay(&gains, OPACITY, |gain| gain.map(color))
        .polyline(trajectory, Rgb::BLUE, 1.5);
    let here = trajectory.last().copied().unwrap_or(grid.center(*from));
    let way: Vec<Point2<f64>> =
        std::iter::once(here).chain(decision.path.iter().map(|cell| grid.center(*cell))).collect();
    picture.polyline(&way, Rgb::WHITE, 6.0).polyline(&way, Rgb::GREEN, 3.0);
    for best in decision.best.iter().skip(1).rev() {
        picture.marker(grid.center(best.cell), Marker::Ring, BEST, 16.0);
    }
    let target = grid.center(decision.target);
    let arrow = Marker::Arrow { heading: mission.start.rotation.angle() };
    picture.marker(here, arrow, Rgb::RED, 24.0).marker(target, Marker::Ring, Rgb::GREEN, 30.0);
    for (i, best) in decision.best.iter().enumerate() {
        picture.label(&format!("{}: {:.1} m", i + 1, best.cost), grid.center(best.cell));
    }
    picture
        .scale_bar()
        .color_bar("E[I] [nats]", low, high, scale)
        .key(Key::Marker(arrow, Rgb::RED), "robot")
        .key(Key::Marker(Marker::Ring, Rgb::GREEN), "chosen")
        .key(Key::Line(Rgb::GREEN), "way there")
        .key(Key::Marker(Marker::Ring, BEST), "five best: rank and travel cost")
        .key(Key::Line(Rgb::BLUE), "driven so far")
        .legend(&[(Rgb::UNKNOWN, "unknown (uncertain cells fade to it)")]);
    picture
}

/// Returns the part of the map's grid with known cells, with a margin.
fn around_known(map: &CoverageMap) -> Grid {
    let grid = *map.grid();
    let mut known = grid.cells().filter(|cell| map.is_known(*cell));
    let Some(first) = known.next() else { return grid };
    let (mut low, mut high) = (first, first);
    for Cell { x, y } in known {
        low = Cell::new(low.x.min(x), low.y.min(y));
        high = Cell::new(high.x.max(x), high.y.max(y));
    }
    let inside = |v: i32, cells: usize| v.clamp(0, i32::try_from(cells).unwrap_or(i32::MAX) - 1);
    let clamp = |c: Cell| Cell::new(inside(c.x, grid.width()), inside(c.y, grid.height()));
    let (low, high) = (clamp(low.offset(-MARGIN, -MARGIN)), clamp(high.offset(MARGIN, MARGIN)));
    let side = |from: i32, to: i32| usize::try_from(to - from + 1).unwrap_or(1);
    let (width, height) = (side(low.x, high.x), side(low.y, high.y));
    Grid::new(grid.lower_corner(low), grid.resolution(), width, height).unwrap_or(grid)
}

/// Returns the least and the largest value, which never are the same.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match high - low {
        span if !span.is_finite() => (0.0, 1.0),
        span if span < 1e-9 => (low, low + 1.0),
        _ => (low, high),
    }
}
