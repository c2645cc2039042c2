//! The growth of a decision's time and memory with the map, the bins and the range.
//!
//! A process of its own measures each point, to count memory from zero.

use crate::Measuring;
use crate::clock::{Clock, median};
use crate::decisions::{decide, for_ever, places};
use crate::situation::Situation;
use crate::tiles;
use anyhow::{Context, Result};
use covmap_cli::Force;
use covmap_cli::terminal::say;
use covmap_draw::FigureFolder;
use covmap_draw::{Chart, ChartAxis, ChartPoint, Figure, Panel, Series};
use covmap_explore::Limits;
use covmap_lab::Config;
use covmap_model::Update;
use std::fmt::{self, Display, Formatter};
use std::path::Path;
use std::process::{Command, Stdio};
use std::str::FromStr;
use std::time::Instant;

/// Points that would probably take longer than this are left out \[s\].
const PATIENCE: f64 = 200.0;
/// The number of decisions after the first one.
const NEXT: usize = 5;

/// The settings of one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Cells along a side of the map.
    side: u32,
    bins: usize,
    /// The usable range \[m\].
    range: f64,
}

impl Point {
    /// Returns an estimate of the work in some unit: cells of the map, bins, and for each
    /// view-point the cells in range and the outcomes.
    fn work(self) -> f64 {
        let bins = self.bins as f64;
        f64::from(self.side).powi(2) * bins * self.range.powi(3)
    }
}

impl Display for Point {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.side, self.bins, self.range)
    }
}

impl FromStr for Point {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(':').collect();
        let &[side, bins, range] = parts.as_slice() else {
            return Err("expected SIDE:BINS:RANGE".into());
        };
        let point = || Some((side.parse().ok()?, bins.parse().ok()?, range.parse().ok()?));
        let (side, bins, range) = point().ok_or("SIDE:BINS:RANGE are numbers")?;
        Ok(Self { side, bins, range })
    }
}

/// The measurements of one point.
#[derive(Debug, Clone, Copy)]
struct Measured {
    point: Point,
    candidates: usize,
    /// The first decision, with nothing cached, and the median of the next ones \[s\].
    cold: f64,
    next: f64,
    /// The map alone, and map and planner together \[bytes\]; NaN if the system does not tell.
    map: f64,
    all: f64,
}

/// Measures all points and writes `growth.csv`, `growth.svg` and `growth.png`.
pub(crate) fn run(
    bench: &Measuring<'_>,
    quick: bool,
    (folder, force): (&Path, Force),
) -> Result<()> {
    let output = FigureFolder::create(folder, force.replace())?;
    let base = Point { side: 200, bins: 11, range: 3.0 };
    let (sides, bins, ranges): (&[u32], &[usize], &[f64]) = if quick {
        (&[100, 150], &[5, 11], &[2.0, 3.0])
    } else {
        let sides = &[100, 200, 300, 500, 700, 1000, 1400, 2000];
        (sides, &[5, 8, 11, 16, 24, 35, 50], &[2.0, 3.0, 4.0, 6.0, 8.0, 10.0])
    };
    let base = if quick { Point { side: 100, ..base } } else { base };
    let sides = measure(bench, sides.iter().map(|side| Point { side: *side, ..base }))?;
    let bins = measure(bench, bins.iter().map(|bins| Point { bins: *bins, ..base }))?;
    let ranges = measure(bench, ranges.iter().map(|range| Point { range: *range, ..base }))?;
    write_table(&output, &[&sides[..], &bins, &ranges].concat())?;
    let panels = [
        row(&sides, &ChartAxis::logarithmic("cells of the map"), |p| f64::from(p.side).powi(2)),
        row(&bins, &ChartAxis::new("bins"), |p| p.bins as f64),
        row(&ranges, &ChartAxis::new("usable range [m]"), |p| p.range),
    ];
    let figure = Figure {
        title: "How a decision by IG grows".into(),
        subtitle: format!(
            "one core; where nothing else is said {0} × {0} cells of 0.1 m, {1} bins, {2} m",
            base.side, base.bins, base.range
        ),
        panels: panels.into_iter().flatten().collect(),
        columns: 2,
    };
    Ok(output.figure("growth", &figure)?)
}

/// Measures points of growing size, each in a process of its own. The series ends before a point
/// that would take too long.
fn measure(bench: &Measuring<'_>, points: impl Iterator<Item = Point>) -> Result<Vec<Measured>> {
    let mut done: Vec<Measured> = Vec::new();
    let mut took = 0.0;
    for point in points {
        if done.last().is_some_and(|last| took * point.work() / last.point.work() > PATIENCE) {
            say::line(format!("{point} (side:bins:range) would take too long and is left out"));
            break;
        }
        bench.progress.say(&format!("{point} (side:bins:range) …"));
        let mut process = Command::new(std::env::current_exe()?);
        let begun = Instant::now();
        process.args(["bench", "--point", &point.to_string()]).stdin(Stdio::null());
        let output = process.stderr(Stdio::inherit()).output()?;
        took = begun.elapsed().as_secs_f64();
        let text = String::from_utf8_lossy(&output.stdout);
        let measured = parse(point, text.trim());
        done.push(measured.with_context(|| format!("the process that measures {point} failed"))?);
    }
    Ok(done)
}

fn parse(point: Point, text: &str) -> Option<Measured> {
    let numbers: Vec<f64> = text.split(',').filter_map(|n| n.parse().ok()).collect();
    let &[candidates, cold, next, map, all] = numbers.as_slice() else { return None };
    #[allow(clippy::cast_possible_truncation, reason = "a count")]
    Some(Measured { point, candidates: candidates as usize, cold, next, map, all })
}

/// Measures one point and prints the result: the task of a process of [`measure`].
pub(crate) fn point(config: &Config, point: Point) -> Result<()> {
    let config = adapted(&for_ever(config), point);
    let world = tiles::offices(point.side, config.sonar.surface)?;
    let limits = Limits { while_driving: None, max_scans: None };
    let mission = covmap_lab::mission(&world, &config, None, limits)?;
    let before = resident();
    let mut situation = Situation::new(&world, &mission, &config, Clock::Core)?;
    for place in places(&world, config.robot.radius) {
        situation.visit(place);
    }
    situation.visit(mission.start.translation.vector.into());
    let (cold, decision) = situation.choose();
    let decision = decision.context("nothing to decide")?;
    let candidates = decision.candidates;
    let next = median(&decide(&mut situation, decision, NEXT)?.seconds);
    let all = resident() - before;
    let map = mission.grid.len() as f64 * (4.0 * config.model.bins as f64 + 6.0);
    say::line(format!("{candidates},{cold},{next},{map},{all}"));
    Ok(())
}

/// Returns a configuration with other bins and another range; σ is as wide as the model then
/// requires.
fn adapted(config: &Config, point: Point) -> Config {
    let mut config = config.clone();
    let model = &mut config.model;
    (model.bins, model.usable_range) = (point.bins, point.range);
    let half_bin = 0.5 / (point.bins - 1) as f64;
    match &mut model.update {
        Update::Product(product) => {
            product.sigma_out.base = product.sigma_out.base.max(half_bin);
            let farthest = product.sigma_out.at(point.range + product.behind, point.range);
            product.sigma_in = product.sigma_in.max(1.01 * farthest);
            product.no_echo.range = product.no_echo.range.min(point.range);
        }
        Update::Cause(cause) => {
            for sigma in [&mut cause.sigma_in.base, &mut cause.sigma_behind, &mut cause.free.sigma]
            {
                *sigma = sigma.max(half_bin);
            }
            cause.no_echo.range = cause.no_echo.range.min(point.range);
        }
    }
    config
}

/// Returns the memory that this process holds \[bytes\]; NaN if the system does not tell.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kibibytes =
        line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok());
    kibibytes.map_or(f64::NAN, |k| 1024.0 * k)
}

fn write_table(output: &FigureFolder, points: &[Measured]) -> Result<()> {
    let columns = [
        "side",
        "bins",
        "range_m",
        "candidates",
        "cold_s",
        "next_s",
        "map_bytes",
        "map_and_planner_bytes",
    ];
    let row = |m: &Measured| {
        let Point { side, bins, range } = m.point;
        let Measured { candidates, cold, next, map, all, .. } = m;
        let times = [cold, next].map(|seconds| format!("{seconds:.6}"));
        let numbers =
            [side.to_string(), bins.to_string(), range.to_string(), candidates.to_string()];
        numbers.into_iter().chain(times).chain([map.to_string(), all.to_string()]).collect()
    };
    Ok(output.table("growth", &columns, &points.iter().map(row).collect::<Vec<_>>())?)
}

/// Returns the charts of time and memory along one axis.
fn row(points: &[Measured], x: &ChartAxis, at: impl Fn(Point) -> f64) -> [Panel; 2] {
    let series = |name: &str, y: &dyn Fn(&Measured) -> f64| Series {
        name: name.into(),
        points: points.iter().map(|m| ChartPoint::new(at(m.point), y(m))).collect(),
        line: true,
        marks: true,
    };
    let chart = |title: &str, y: ChartAxis, series: Vec<Series>| Chart {
        title: title.into(),
        subtitle: String::new(),
        x: x.clone(),
        y,
        series,
    };
    let time = vec![
        series("with nothing cached", &|m| 1e3 * m.cold),
        series("after one more scan", &|m| 1e3 * m.next),
    ];
    let memory = vec![
        series("map and planner", &|m| m.all / 1e6),
        series("the map alone", &|m| m.map / 1e6),
    ];
    [
        chart("Time", ChartAxis::logarithmic("a decision [ms]"), time).into(),
        chart("Memory", ChartAxis::logarithmic("memory [MB]"), memory).into(),
    ]
}
