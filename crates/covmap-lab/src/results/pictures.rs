//! The pictures of a run.

use crate::error::Result;
use crate::{Summary, Truth};
use covmap::{Cell, CoverageMap, Raster};
use covmap_draw::{ColorMap, Key, Marker, Picture, Rgb, coverage_color};
use covmap_explore::{Ending, Mission, Run};
use covmap_model::{OccupancyGrid, OccupancyParameters};
use covmap_plan::CellStatus;
use nalgebra::Point2;

const PATH_WIDTH: f64 = 2.5;
const START_SIZE: f64 = 16.0;
const END_SIZE: f64 = 24.0;
const CUT_SIZE: f64 = 22.0;
const BUMP_SIZE: f64 = 7.0;
/// Least coverage of a wall.
const HALF: f64 = 0.5;

/// The map's belief about a cell against the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Verdict {
    Wall,
    Free,
    MissedWall,
    Phantom,
    Unknown,
    Hidden,
}

impl Verdict {
    const ALL: [Self; 6] =
        [Self::Wall, Self::Free, Self::MissedWall, Self::Phantom, Self::Unknown, Self::Hidden];

    fn name(self) -> &'static str {
        match self {
            Self::Wall => "wall, or partly",
            Self::Free => "free, or partly",
            Self::MissedWall => "missed wall",
            Self::Phantom => "phantom: covered only in the map",
            Self::Unknown => "could be seen, not known",
            Self::Hidden => "out of sight",
        }
    }

    /// The colours also differ in brightness.
    fn color(self) -> Rgb {
        match self {
            Self::Wall => Rgb(60, 66, 76),
            Self::Free => Rgb(250, 250, 250),
            Self::MissedWall => Rgb::RED,
            Self::Phantom => Rgb::ORANGE,
            Self::Unknown => Rgb(160, 170, 184),
            Self::Hidden => Rgb(222, 227, 233),
        }
    }
}

/// Pictures of a run.
#[derive(Debug)]
pub struct Pictures<'a> {
    /// The mission of the run.
    pub mission: &'a Mission,
    /// The run.
    pub run: &'a Run,
    /// The map as it is read.
    pub map: &'a CoverageMap,
    /// The way the map is read, in words; may be empty.
    pub how: &'a str,
    /// The truth about the world.
    pub truth: &'a Truth,
    /// The numbers of the run.
    pub summary: &'a Summary,
}

impl Pictures<'_> {
    /// Returns a description of the run in words.
    pub fn of(&self) -> String {
        let Summary { strategy, update, seed, resolution, scans, .. } = self.summary;
        let (driven, ending) = (self.summary.path_length_m, self.summary.ending);
        format!(
            "{strategy}, update {update}, seed {seed}, r = {resolution} m: {scans} scans, {driven:.1} m driven; {}",
            ending.in_words()
        )
    }

    /// A picture with a title, a line about the run, and a scale bar.
    fn begin(&self, what: &str) -> Picture {
        let mut picture = Picture::new(self.mission.grid);
        picture.title(&format!("{}: {what}", self.summary.world)).subtitle(&self.of()).scale_bar();
        picture
    }

    /// Draws the most likely coverage, and the path.
    pub fn coverage(&self) -> Picture {
        let mut picture = self.begin(&format!("most likely coverage{}", self.how));
        draw_coverage(&mut picture, self.map, self.mission.config.planner.entropy_threshold);
        let path = &self.run.trajectory;
        let start = Point2::from(self.mission.start.translation.vector);
        let end = path.last().copied().unwrap_or(start);
        draw_path(&mut picture, path, start, (end, self.mission.start.rotation.angle()));
        if self.summary.ending != Ending::Explored {
            mark_cut_short(&mut picture, end);
        }
        picture
    }

    /// Draws the entropy of each cell.
    pub fn entropy(&self) -> Picture {
        let mut picture = self.begin(&format!("entropy of the coverage{}", self.how));
        draw_entropy(&mut picture, self.map);
        picture
    }

    /// Draws the true coverage of each cell.
    pub fn truth(&self) -> Picture {
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

    /// Draws the map against the truth, and the places where the robot bumped.
    pub fn errors(&self, bumps: &[Point2<f64>]) -> Picture {
        let mut picture = self.begin(&format!("the map against the truth{}", self.how));
        let verdicts = Raster::from_fn(self.mission.grid, |cell| self.verdict(cell));
        picture.cells(&verdicts, |verdict| verdict.color());
        for verdict in Verdict::ALL {
            let count = verdicts.values().iter().filter(|v| **v == verdict).count();
            picture.key(Key::Fill(verdict.color()), &format!("{}: {count}", verdict.name()));
        }
        for at in bumps {
            picture.marker(*at, Marker::Disc, Rgb::BLUE, BUMP_SIZE);
        }
        let bumps = format!("bumps, where the robot's centre was: {}", bumps.len());
        picture.key(Key::Marker(Marker::Disc, Rgb::BLUE), &bumps);
        picture
    }

    fn verdict(&self, cell: Cell) -> Verdict {
        let is = |raster: &Raster<bool>| raster.get(cell) == Some(&true);
        let map = self.map;
        let covered = map.is_known(cell) && map.mode(cell) >= HALF;
        let coverage = self.truth.coverage.get(cell).copied().unwrap_or(1.0);
        let is_free = coverage <= self.mission.config.planner.traversable_coverage;
        let matters = is(&self.truth.observable);
        match covered {
            true if is_free && (matters || is(&self.truth.reachable)) => Verdict::Phantom,
            _ if !matters => Verdict::Hidden,
            false if is(&self.truth.first_solid) => Verdict::MissedWall,
            _ if !map.is_known(cell) => Verdict::Unknown,
            true => Verdict::Wall,
            false => Verdict::Free,
        }
    }

    /// Draws the log-odds occupancy grid of the same scans.
    pub fn occupancy(&self) -> Result<Picture> {
        let occupancy = occupancy_of(self.mission, self.run)?;
        let mut picture = self.begin("log-odds occupancy grid of the same scans");
        draw_occupancy(&mut picture, &occupancy);
        Ok(picture)
    }

    /// Draws the certificate: the status of each cell.
    pub fn certificate(&self) -> Picture {
        let counts = self.summary.cells;
        let mut picture = self.begin("certificate");
        let status: &Raster<CellStatus> = &self.run.certificate;
        picture.cells(status, |status| status_color(*status));
        for (status, count, name) in [
            (CellStatus::Resolved, counts.resolved, "resolved"),
            (CellStatus::Exhausted, counts.exhausted, "exhausted"),
            (CellStatus::Open, counts.open, "open"),
            (CellStatus::Unreachable, counts.unreachable, "unreachable"),
            (CellStatus::NotSeen, counts.not_seen, "not seen yet"),
            (CellStatus::Outside, counts.outside, "outside"),
        ] {
            if status == CellStatus::NotSeen && count == 0 {
                continue;
            }
            let most = self.run.most_promised(status).filter(|_| status == CellStatus::Exhausted);
            let most = most.map_or_else(String::new, |most| {
                format!(" (one more scan: at most {most:.2} nats)")
            });
            picture.key(Key::Fill(status_color(status)), &format!("{name}: {count}{most}"));
        }
        picture
    }
}

/// Draws the most likely coverage of each cell. Cells with an entropy above `explored` \[nats\] fade.
pub fn draw_coverage(picture: &mut Picture, map: &CoverageMap, explored: f64) {
    picture
        .cells(&faded(map, explored), |color| *color)
        .color_bar("coverage", 0.0, 1.0, |c| coverage_color(Some(c)))
        .legend(&[(Rgb::UNKNOWN, "unknown (uncertain cells fade to it)")]);
}

/// The log-odds occupancy grid of a run's scans.
pub(super) fn occupancy_of(mission: &Mission, run: &Run) -> Result<OccupancyGrid> {
    let (_, model) = mission.config.build()?;
    let map = &run.map;
    let mut occupancy = OccupancyGrid::new(mission.grid, OccupancyParameters::default());
    let pinned = map.grid().cells().filter(|cell| map.is_pinned(*cell));
    pinned.for_each(|cell| occupancy.pin_free(cell));
    run.scans.iter().for_each(|scan| occupancy.integrate(&model, scan));
    Ok(occupancy)
}

/// Draws the entropy of each cell.
pub fn draw_entropy(picture: &mut Picture, map: &CoverageMap) {
    let most = most_entropy(map);
    picture.cells(&map.entropy_map(), |entropy| ColorMap::Viridis.color(entropy / most)).color_bar(
        "entropy H [nats]",
        0.0,
        most,
        |t| ColorMap::Viridis.color(t),
    );
}

/// Draws the probability that each cell is occupied.
pub fn draw_occupancy(picture: &mut Picture, occupancy: &OccupancyGrid) {
    picture
        .cells(&occupancy.probabilities(), |p| coverage_color(*p))
        .color_bar("probability that it is occupied", 0.0, 1.0, |p| coverage_color(Some(p)))
        .legend(&[(Rgb::UNKNOWN, "unknown")]);
}

/// Draws a trajectory with its start and its end, and the heading at the end.
pub fn draw_path(
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

/// Marks the end of a path that is cut short, as the run did not explore everything.
pub fn mark_cut_short(picture: &mut Picture, end: Point2<f64>) {
    picture
        .marker(end, Marker::Cross, Rgb::RED, CUT_SIZE)
        .key(Key::Marker(Marker::Cross, Rgb::RED), "cut short here");
}

/// Returns the colour of the most likely coverage of each cell. Cells that are not explored well enough
/// (H > ε) fade towards the colour of unknown cells.
pub fn certain_coverage(map: &CoverageMap, mission: &Mission) -> Raster<Rgb> {
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

/// The entropy of an unknown cell, ln n \[nats\].
fn most_entropy(map: &CoverageMap) -> f64 {
    libm::log(map.bins() as f64)
}

/// The colours also differ in brightness.
fn status_color(status: CellStatus) -> Rgb {
    match status {
        CellStatus::Resolved => Rgb(196, 226, 198),
        CellStatus::Exhausted => Rgb::ORANGE,
        CellStatus::Open => Rgb::RED,
        CellStatus::Unreachable => Rgb(96, 106, 120),
        CellStatus::NotSeen => Rgb(166, 180, 200),
        CellStatus::Outside => Rgb(228, 232, 237),
    }
}
