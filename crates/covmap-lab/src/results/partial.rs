//! Truth, coverage and occupancy side by side, where a run met walls that cut through cells.

use super::pictures::occupancy_of;
use crate::error::Result;
use crate::{Summary, Truth};
use covmap::{Cell, Class, CoverageMap, Raster};
use covmap_draw::{ChartAxis, ColorMap, Figure, HeatMap};
use covmap_explore::{Mission, Run};

/// Side of the window \[m\].
const SIDE: f64 = 4.0;

/// The window of the picture: `side` cells to the right and upwards from its lower left cell.
struct Window {
    corner: Cell,
    side: i32,
}

impl Window {
    fn cells(&self) -> impl Iterator<Item = Cell> {
        let (corner, side) = (self.corner, self.side);
        (0..side).flat_map(move |y| (0..side).map(move |x| corner.offset(x, y)))
    }

    /// The window with the most to show of partly covered cells that the map knows: many cells, and of many
    /// coverages, as along an oblique wall.
    fn of(truth: &Truth, run: &Run) -> Self {
        let grid = run.map.grid();
        let cells = (SIDE / grid.resolution()).round().clamp(4.0, 400.0);
        #[allow(clippy::cast_possible_truncation, reason = "at most 400")]
        let side = cells as i32;
        let shows = |window: &Self| {
            let mut tenths = [0.0f64; 10];
            for cell in window.cells() {
                let Some(coverage) = truth.coverage.get(cell).copied() else { continue };
                let counts = run.map.is_known(cell) && !run.map.is_pinned(cell);
                if counts && Class::of(coverage) == Class::Partial {
                    #[allow(clippy::cast_possible_truncation, reason = "0–9")]
                    let tenth = (coverage * 10.0) as usize;
                    tenths[tenth.min(9)] += 1.0;
                }
            }
            tenths.iter().map(|count| count.sqrt()).sum::<f64>()
        };
        let last = |n: usize| (i32::try_from(n).unwrap_or(i32::MAX) - side).max(0);
        let step = usize::try_from((side / 4).max(1)).unwrap_or(1);
        let mut best: Option<(f64, Self)> = None;
        for y in (0..=last(grid.height())).step_by(step) {
            for x in (0..=last(grid.width())).step_by(step) {
                let window = Self { corner: Cell::new(x, y), side };
                let value = shows(&window);
                if best.as_ref().is_none_or(|(most, _)| value > *most) {
                    best = Some((value, window));
                }
            }
        }
        best.map_or(Self { corner: Cell::new(0, 0), side }, |(_, window)| window)
    }
}

/// Truth, most likely coverage, and occupancy by log-odds of the same scans, in one window.
pub(super) fn figure(
    mission: &Mission,
    (run, map): (&Run, &CoverageMap),
    truth: &Truth,
    summary: &Summary,
) -> Result<Figure> {
    let window = Window::of(truth, run);
    let occupied: Raster<Option<f64>> = occupancy_of(mission, run)?.probabilities();
    let known = |cell: Cell| run.map.grid().index(cell).is_some() && run.map.is_known(cell);
    let coverage = |cell: Cell| if known(cell) { map.mode(cell) } else { f64::NAN };
    let panels = [
        ("the truth", panel(&window, run, |c| truth.coverage.get(c).copied().unwrap_or(f64::NAN))),
        ("most likely coverage", panel(&window, run, coverage)),
        (
            "occupancy",
            panel(&window, run, |c| occupied.get(c).copied().flatten().unwrap_or(f64::NAN)),
        ),
    ];
    let panels = panels.map(|(title, panel)| HeatMap { title: title.into(), ..panel }.into());
    Ok(Figure {
        title: format!("{}: cells that are covered in part", summary.world),
        subtitle: format!(
            "{}, update {}, seed {}, r = {} m: {} scans; white is unknown",
            summary.strategy, summary.update, summary.seed, summary.resolution, summary.scans
        ),
        panels: panels.into(),
        columns: 3,
    })
}

fn panel(window: &Window, run: &Run, value: impl Fn(Cell) -> f64) -> HeatMap {
    let grid = run.map.grid();
    let corner = |i: i32| grid.lower_corner(window.corner.offset(i, i));
    HeatMap {
        title: String::new(),
        subtitle: String::new(),
        x: ChartAxis::new("x [m]"),
        y: ChartAxis::new("y [m]"),
        value: ChartAxis { from: Some(0.0), to: Some(1.0), ..ChartAxis::new("covered") },
        x_edges: (0..=window.side).map(|i| corner(i).x).collect(),
        y_edges: (0..=window.side).map(|i| corner(i).y).collect(),
        values: window.cells().map(value).collect(),
        color_map: ColorMap::Viridis,
    }
}
