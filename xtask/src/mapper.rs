//! The map of a log: once through it for its extent, and once for its evidence.

use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::trail::Trail;
use anyhow::{Result, anyhow, bail};
use covmap::{CoverageMap, Grid, GridError};
use covmap_io::log::{LogFrame, LogOptions, LogReader, Skipped};
use covmap_model::{OccupancyGrid, OccupancyParameters, SensorModel, integrate, integrate_body};
use covmap_sonar::SonarRing;
use nalgebra::{Isometry2, Point2, Vector2};
use std::path::{Path, PathBuf};

/// A path is followed in steps of at least this \[m\]: less is the trembling of a robot that
/// stands.
const SHORTEST_STEP: f64 = 0.01;
/// Between poses farther apart than this \[m\] nobody knows the way.
const LONGEST_STEP: f64 = 1.0;
/// Cells around what can be seen.
const MARGIN: usize = 2;

/// Which frames are used: those that moved or turned enough.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stride {
    /// Metres.
    pub(crate) every: f64,
    /// Radians.
    pub(crate) turn: f64,
}

impl Stride {
    /// Whether a frame at `pose` is used after the last one used.
    pub(crate) fn takes(&self, last: Option<&Isometry2<f64>>, pose: &Isometry2<f64>) -> bool {
        last.is_none_or(|last| {
            let moved = (pose.translation.vector - last.translation.vector).norm();
            moved >= self.every || last.rotation.angle_to(&pose.rotation).abs() >= self.turn
        })
    }
}

/// A log that is read again and again.
#[derive(Debug)]
pub(crate) struct Log {
    pub(crate) path: PathBuf,
    pub(crate) options: LogOptions,
}

/// What is known of a log after reading it once.
#[derive(Debug)]
pub(crate) struct Survey {
    pub(crate) ring: SonarRing,
    pub(crate) skipped: Skipped,
    low: Point2<f64>,
    high: Point2<f64>,
}

impl Log {
    /// Reads the log once; `None` if that was stopped.
    pub(crate) fn survey(
        &self,
        progress: &mut Progress,
        interrupt: &Interrupt,
    ) -> Result<Option<Survey>> {
        let mut reader = LogReader::open(&self.path, &self.options)?;
        let first = reader.next().ok_or_else(|| anyhow!("{}: is empty", self.path.display()))??;
        let here = Point2::from(first.scan.pose.translation.vector);
        let (mut low, mut high, mut frames) = (here, here, 1u64);
        for frame in &mut reader {
            let here = Point2::from(frame?.scan.pose.translation.vector);
            (low, high) = (low.inf(&here), high.sup(&here));
            frames += 1;
            progress.tell(|| format!("reading the log: {frames} frames"));
            if interrupt.is_pressed() {
                return Ok(None);
            }
        }
        let skipped = reader.skipped().clone();
        Ok(Some(Survey { ring: (*first.ring).clone(), skipped, low, high }))
    }

    /// Reads the log once more, into the map, to its end or until that is stopped.
    pub(crate) fn map(
        &self,
        survey: &Survey,
        mut mapper: Mapper,
        progress: &mut Progress,
        interrupt: &Interrupt,
    ) -> Result<Mapper> {
        for frame in LogReader::open(&self.path, &self.options)? {
            let frame = frame?;
            if *frame.ring != survey.ring {
                bail!("{}: was changed while it was read", self.path.display());
            }
            mapper.add(&frame);
            let (used, metres) = (mapper.scans, mapper.path_length);
            progress.tell(|| {
                format!(
                    "mapping: {used} scans · {metres:.1} m · {:.0} s into the log",
                    frame.scan.time
                )
            });
            if interrupt.is_pressed() {
                mapper.stopped = true;
                break;
            }
        }
        Ok(mapper)
    }
}

/// The grid of a rectangle, with corners at multiples of the resolution.
pub(crate) fn grid_around(
    low: Point2<f64>,
    high: Point2<f64>,
    resolution: f64,
    margin: usize,
) -> Result<Grid, GridError> {
    let corner = low.map(|v| (v / resolution).floor() * resolution);
    Grid::covering(corner, high - corner, resolution, margin)
}

impl Survey {
    /// The grid of all cells that a model can learn of from where the robot was, with corners
    /// at multiples of the resolution.
    pub(crate) fn grid(&self, model: &SensorModel, radius: f64, path: &Path) -> Result<Grid> {
        let r = model.resolution();
        let outermost =
            |most: f64, beam: &covmap_sonar::Beam| most.max(beam.pose.translation.vector.norm());
        let reach = model.max_reach() + self.ring.beams().iter().fold(0.0, outermost);
        let around = Vector2::repeat(reach.max(radius));
        grid_around(self.low - around, self.high + around, r, MARGIN).map_err(|error| {
            let [a, b] = [self.low, self.high];
            anyhow!(
                "{}: the robot was between ({:.1}, {:.1}) and ({:.1}, {:.1}): {error}",
                path.display(),
                a.x,
                a.y,
                b.x,
                b.y
            )
        })
    }
}

/// A map that grows frame by frame.
#[derive(Debug)]
pub(crate) struct Mapper {
    model: SensorModel,
    stride: Stride,
    /// The robot's radius \[m\], if its body is evidence.
    body: Option<f64>,
    pub(crate) map: CoverageMap,
    pub(crate) occupancy: OccupancyGrid,
    pub(crate) trail: Trail,
    pub(crate) path_length: f64,
    pub(crate) scans: usize,
    /// Good frames that were not used.
    pub(crate) standing: usize,
    /// Places where the poses jump.
    pub(crate) jumps: usize,
    /// The log was not read to its end.
    pub(crate) stopped: bool,
    pub(crate) first: Option<Isometry2<f64>>,
    pub(crate) last: Option<Isometry2<f64>>,
    last_used: Option<Isometry2<f64>>,
    last_step: Option<Point2<f64>>,
}

impl Mapper {
    pub(crate) fn new(
        grid: Grid,
        model: SensorModel,
        stride: Stride,
        body: Option<f64>,
    ) -> Result<Self> {
        Ok(Self {
            map: CoverageMap::new(grid, model.parameters().bins)?,
            occupancy: OccupancyGrid::new(grid, OccupancyParameters::default()),
            model,
            stride,
            body,
            trail: Trail::default(),
            path_length: 0.0,
            scans: 0,
            standing: 0,
            jumps: 0,
            stopped: false,
            first: None,
            last: None,
            last_used: None,
            last_step: None,
        })
    }

    fn add(&mut self, frame: &LogFrame) {
        let pose = frame.scan.pose;
        self.first.get_or_insert(pose);
        self.last = Some(pose);
        self.step(Point2::from(pose.translation.vector));
        if !self.stride.takes(self.last_used.as_ref(), &pose) {
            self.standing += 1;
            return;
        }
        self.last_used = Some(pose);
        self.scans += 1;
        integrate(&self.model, &mut self.map, &frame.scan);
        self.occupancy.integrate(&self.model, &frame.scan);
    }

    /// Follows the path, which the body has swept.
    fn step(&mut self, to: Point2<f64>) {
        let from = self.last_step.unwrap_or(to);
        let length = (to - from).norm();
        if self.last_step.is_some() && length < SHORTEST_STEP {
            return;
        }
        let jump = length > LONGEST_STEP;
        self.last_step = Some(to);
        self.trail.push(to, jump);
        if jump {
            self.jumps += 1;
        } else {
            self.path_length += length;
        }
        if let Some(radius) = self.body {
            let from = if jump { to } else { from };
            for change in integrate_body(&mut self.map, from, to, radius) {
                self.occupancy.pin_free(change.cell);
            }
        }
    }
}
