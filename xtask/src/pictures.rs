//! The pictures of a run.

use crate::explore::in_words;
use anyhow::Result;
use covmap::{CoverageMap, Raster};
use covmap_explore::{Mission, Run, Summary, Truth};
use covmap_io::{ColorMap, Key, Marker, Picture, Rgb, coverage_color};
use covmap_model::{OccupancyGrid, OccupancyParameters};
use covmap_plan::CellStatus;
use nalgebra::Point2;

const PATH_WIDTH: f64 = 2.5;
const START_SIZE: f64 = 16.0;
const END_SIZE: f64 = 24.0;

/// All that the pictures of a run show.
pub(crate) struct Pictures<'a> {
    pub(crate) mission: &'a Mission,
    pub(crate) run: &'a Run,
    pub(crate) truth: &'a Truth,
    pub(crate) summary: &'a Summary,
}

impl Pictures<'_> {
    /// A picture with a title, a line about the run, and a scale bar.
    fn begin(&self, what: &str) -> Picture {
        let Summary { world, strategy, seed, resolution, scans, path_length_m, ending, .. } =
            self.summary;
        let mut picture = Picture::new(self.mission.grid);
        picture
            .title(&format!("{world}: {what}"))
            .subtitle(&format!(
                "{strategy}, seed {seed}, r = {resolution} m: {scans} scans, {path_length_m:.1} m driven; {}",
                in_words(*ending)
            ))
            .scale_bar();
        picture
    }

    /// The most likely coverage, and the path.
    pub(crate) fn coverage(&self) -> Picture {
        let mut picture = self.begin("most likely coverage");
        draw_coverage(&mut picture, &self.run.map, self.mission.config.planner.entropy_threshold);
        let path = &self.run.trajectory;
        let start = Point2::from(self.mission.start.translation.vector);
        let end = path.last().copied().unwrap_or(start);
        draw_path(&mut picture, path, start, (end, self.mission.start.rotation.angle()));
        picture
    }

    /// How uncertain each cell is.
    pub(crate) fn entropy(&self) -> Picture {
        let mut picture = self.begin("entropy of the coverage");
        draw_entropy(&mut picture, &self.run.map);
        picture
    }

    /// What there truly is.
    pub(crate) fn truth(&self) -> Picture {
        let mut picture = Picture::new(self.mission.grid);
        let Summary { world, resolution, .. } = self.summary;
        picture
            .title(&format!("{world}: the truth"))
            .subtitle(&format!("exact coverage of every cell, r = {resolution} m"))
            .scale_bar()
            .cells(&self.truth.coverage, |coverage| coverage_color(Some(*coverage)))
            .color_bar("coverage", 0.0, 1.0, |c| coverage_color(Some(c)));
        picture
    }

    /// The log-odds occupancy grid of the same scans.
    pub(crate) fn occupancy(&self) -> Result<Picture> {
        let (_, model) = self.mission.config.build()?;
        let map = &self.run.map;
        let mut occupancy = OccupancyGrid::new(self.mission.grid, OccupancyParameters::default());
        let pinned = map.grid().cells().filter(|cell| map.is_pinned(*cell));
        pinned.for_each(|cell| occupancy.pin_free(cell));
        self.run.scans.iter().for_each(|scan| occupancy.integrate(&model, scan));
        let mut picture = self.begin("log-odds occupancy grid of the same scans");
        draw_occupancy(&mut picture, &occupancy);
        Ok(picture)
    }

    /// Why there is nothing left to do, cell by cell.
    pub(crate) fn certificate(&self) -> Picture {
        let counts = self.summary.cells;
        let mut picture = self.begin("certificate");
        let status: &Raster<CellStatus> = &self.run.certificate;
        picture.cells(status, |status| status_color(*status));
        for (status, count, name) in [
            (CellStatus::Resolved, counts.resolved, "resolved"),
            (CellStatus::Exhausted, counts.exhausted, "exhausted"),
            (CellStatus::Open, counts.open, "open"),
            (CellStatus::Unreachable, counts.unreachable, "unreachable"),
            (CellStatus::Outside, counts.outside, "outside"),
        ] {
            picture.key(Key::Fill(status_color(status)), &format!("{name}: {count}"));
        }
        picture
    }
}

/// The most likely coverage of each cell. What is not `explored` well enough \[nats\] fades.
pub(crate) fn draw_coverage(picture: &mut Picture, map: &CoverageMap, explored: f64) {
    picture
        .cells(&faded(map, explored), |color| *color)
        .color_bar("coverage", 0.0, 1.0, |c| coverage_color(Some(c)))
        .legend(&[(Rgb::UNKNOWN, "unknown (uncertain cells fade to it)")]);
}

/// The entropy of each cell.
pub(crate) fn draw_entropy(picture: &mut Picture, map: &CoverageMap) {
    let most = most_entropy(map);
    picture.cells(&map.entropy_map(), |entropy| ColorMap::Viridis.color(entropy / most)).color_bar(
        "entropy H [nats]",
        0.0,
        most,
        |t| ColorMap::Viridis.color(t),
    );
}

/// The probability that each cell is occupied.
pub(crate) fn draw_occupancy(picture: &mut Picture, occupancy: &OccupancyGrid) {
    picture
        .cells(&occupancy.probabilities(), |p| coverage_color(*p))
        .color_bar("probability that it is occupied", 0.0, 1.0, |p| coverage_color(Some(p)))
        .legend(&[(Rgb::UNKNOWN, "unknown")]);
}

/// A trajectory with its start, and its end with the heading there.
pub(crate) fn draw_path(
    picture: &mut Picture,
    path: &[Point2<f64>],
    start: Point2<f64>,
    (end, heading): (Point2<f64>, f64),
) {
    let (disc, arrow) = (Marker::Disc, Marker::Arrow { heading });
    picture
        .polyline(path, Rgb::BLUE, PATH_WIDTH)
        .marker(start, disc, Rgb::GREEN, START_SIZE)
        .marker(end, arrow, Rgb::RED, END_SIZE)
        .key(Key::Line(Rgb::BLUE), "trajectory")
        .key(Key::Marker(disc, Rgb::GREEN), "start")
        .key(Key::Marker(arrow, Rgb::RED), "end");
}

/// The colour of the most likely coverage of each cell. What is not explored well enough
/// (H > ε) fades towards the colour of what nobody knows.
pub(crate) fn certain_coverage(map: &CoverageMap, mission: &Mission) -> Raster<Rgb> {
    faded(map, mission.config.planner.entropy_threshold)
}

fn faded(map: &CoverageMap, explored: f64) -> Raster<Rgb> {
    let most = most_entropy(map);
    Raster::from_fn(*map.grid(), |cell| {
        let coverage = map.is_known(cell).then(|| map.mode(cell));
        let doubt = (map.entropy(cell) - explored) / (most - explored).max(1e-9);
        coverage_color(coverage).mix(Rgb::UNKNOWN, doubt)
    })
}

/// The entropy of a cell of which nothing is known, ln n \[nats\].
#[allow(clippy::cast_precision_loss, reason = "at most 64 bins")]
fn most_entropy(map: &CoverageMap) -> f64 {
    (map.bins() as f64).ln()
}

/// Told apart by brightness, too.
fn status_color(status: CellStatus) -> Rgb {
    match status {
        CellStatus::Resolved => Rgb(196, 226, 198),
        CellStatus::Exhausted => Rgb::ORANGE,
        CellStatus::Open => Rgb::RED,
        CellStatus::Unreachable => Rgb(96, 106, 120),
        CellStatus::Outside => Rgb(228, 232, 237),
    }
}
