//! The map of a log, which is read once for its extent and once for its evidence.

use crate::error::{Fault, LabError, Result, about};
use crate::watch::Watch;
use covmap::{CoverageMap, Grid, GridError};
use covmap_draw::Trail;
use covmap_log::{
    Account, Follower, Leg, LogError, LogFrame, LogOptions, LogReader, RosBagWriter, Sensor,
};
use covmap_model::{Looks, OccupancyGrid, OccupancyParameters, SensorModel, integrate_body};
use covmap_sonar::SonarRing;
use nalgebra::{Isometry2, Point2, Vector2};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Width of the margin around the cells that can be seen, in cells.
const MARGIN: usize = 2;
/// Largest number of rings of a log: of its lasers, and of longest ranges that change on the way.
const MOST_RINGS: usize = 16;

/// Stride between used frames.
///
/// A frame is used if the robot moved or turned enough since the last used one.
#[derive(Debug, Clone, Copy)]
pub struct Stride {
    /// Least distance \[m\].
    pub every: f64,
    /// Least turn \[rad\].
    pub turn: f64,
}

impl Stride {
    /// Whether a frame at `pose` is used after the last one used.
    pub fn takes(&self, last: Option<&Isometry2<f64>>, pose: &Isometry2<f64>) -> bool {
        last.is_none_or(|last| {
            let moved = (pose.translation.vector - last.translation.vector).norm();
            moved >= self.every || last.rotation.angle_to(&pose.rotation).abs() >= self.turn
        })
    }
}

/// A log that is read again and again.
#[derive(Debug)]
pub struct Log {
    /// File or folder of the log.
    pub path: PathBuf,
    /// Options of the reader.
    pub options: LogOptions,
}

/// Overview of a log, after reading it once.
#[derive(Debug)]
pub struct LogOverview {
    /// A ring for each sensor, and for each of its longest ranges.
    pub rings: Vec<Arc<SonarRing>>,
    /// The account of the log.
    pub account: Account,
    bounds: Bounds,
}

/// The rectangle in which the robot was.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: Point2<f64>,
    high: Point2<f64>,
}

impl Bounds {
    fn add(&mut self, at: Point2<f64>) {
        *self = Self { low: self.low.inf(&at), high: self.high.sup(&at) };
    }

    /// Adds the places where the robot drove.
    fn add_ends(&mut self, legs: &[Leg]) {
        legs.iter().filter(|leg| !leg.jump).for_each(|leg| self.add(leg.to));
    }
}

impl Log {
    /// Reads the log once; `None` if the watch stopped this.
    ///
    /// # Errors
    /// If the log cannot be read, is empty, or has too many different sensors.
    pub fn overview(&self, watch: &dyn Watch) -> Result<Option<LogOverview>> {
        let mut reader = self.open()?;
        let (mut follower, mut frames) = (Follower::default(), 0u64);
        let (mut rings, mut bounds): (Vec<Arc<SonarRing>>, Option<Bounds>) = (Vec::new(), None);
        for frame in &mut reader {
            let frame = frame.map_err(hint)?;
            if ring_number(&rings, &frame.ring).is_none() {
                if rings.len() == MOST_RINGS {
                    let fault = Fault::ManySensors { line: frame.line, most: MOST_RINGS };
                    return Err(about(&self.path)(fault));
                }
                rings.push(Arc::clone(&frame.ring));
            }
            let at = Point2::from(frame.scan.pose.translation.vector);
            let bounds = bounds.get_or_insert(Bounds { low: at, high: at });
            bounds.add(at);
            bounds.add_ends(&follower.follow(&frame));
            frames += 1;
            watch.tell(&format_args!("reading the log: {frames} frames"));
            if watch.is_stopped() {
                return Ok(None);
            }
        }
        let mut bounds = bounds.ok_or_else(|| about(&self.path)(Fault::NoScans))?;
        bounds.add_ends(&follower.rest(&reader.rest()));
        Ok(Some(LogOverview { rings, account: reader.account().clone(), bounds }))
    }

    /// Writes the scans of the log's sonars, and the robot's way, as a bag of ROS 2; returns the number of
    /// scans, `None` if the watch stopped this.
    ///
    /// # Errors
    /// If the log cannot be read, the sensors change on the way, or the bag cannot be written.
    pub fn write_bag<W: Write>(&self, out: W, watch: &dyn Watch) -> Result<Option<usize>> {
        let fault = |error| about(&self.path)(Fault::Bag(error));
        let mut reader = self.open()?;
        let Some(first) = reader.next() else { return Ok(Some(0)) };
        let first = first.map_err(hint)?;
        let ring = Arc::clone(&first.ring);
        let mut bag = RosBagWriter::new(&ring, out).map_err(fault)?;
        let mut time = first.scan.time;
        for frame in std::iter::once(Ok(first)).chain(&mut reader) {
            let frame = frame.map_err(hint)?;
            if ring_number(std::slice::from_ref(&ring), &frame.ring).is_none() {
                let fault = Fault::ManySensors { line: frame.line, most: 1 };
                return Err(about(&self.path)(fault));
            }
            // The last one is the pose of the scan.
            for passed in frame.way.iter().take(frame.way.len().saturating_sub(1)) {
                time = (time + passed.seconds).min(frame.scan.time);
                bag.pass(time, &passed.pose).map_err(fault)?;
            }
            time = frame.scan.time;
            bag.write(&frame.scan).map_err(fault)?;
            watch.tell(&format_args!("writing the bag: {time:.0} s into the log"));
            if watch.is_stopped() {
                return Ok(None);
            }
        }
        for passed in reader.rest() {
            time += passed.seconds;
            bag.pass(time, &passed.pose).map_err(fault)?;
        }
        bag.finish().map(Some).map_err(fault)
    }

    fn open(&self) -> Result<LogReader> {
        LogReader::open(&self.path, &self.options).map_err(hint)
    }

    /// Reads the log once more, into the map, to its end or until the watch stops this.
    ///
    /// # Errors
    /// If the log cannot be read, or was changed meanwhile.
    pub fn map(&self, mut mapper: Mapper, watch: &dyn Watch) -> Result<Mapper> {
        let mut reader = self.open()?;
        for frame in &mut reader {
            let frame = frame?;
            if !mapper.add(&frame) {
                return Err(about(&self.path)(Fault::Changed));
            }
            let (used, metres) = (mapper.scans, mapper.path_length);
            watch.tell(&format_args!(
                "mapping: {used} scans · {metres:.1} m · {:.0} s into the log",
                frame.scan.time
            ));
            if watch.is_stopped() {
                mapper.stopped = true;
                return Ok(mapper);
            }
        }
        for leg in mapper.follower.rest(&reader.rest()) {
            mapper.step(&leg);
        }
        Ok(mapper)
    }
}

/// Names the option for the sensor that the log has.
fn hint(error: LogError) -> LabError {
    let other_sensor = error.other_sensor().map(|sensor| match sensor {
        Sensor::Laser => "laser",
        Sensor::Sonar => "sonar",
    });
    LabError::Log { error, other_sensor }
}

fn ring_number(rings: &[Arc<SonarRing>], ring: &Arc<SonarRing>) -> Option<usize> {
    rings.iter().position(|known| Arc::ptr_eq(known, ring) || known == ring)
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

impl LogOverview {
    /// Returns the grid of all cells that a model can learn of from the robot's places, with corners at
    /// multiples of the resolution.
    pub fn grid(&self, (resolution, reach): (f64, f64), radius: f64, path: &Path) -> Result<Grid> {
        let outermost =
            |most: f64, beam: &covmap_sonar::Beam| most.max(beam.pose.translation.vector.norm());
        let beams = self.rings.iter().flat_map(|ring| ring.beams());
        let reach = reach + beams.fold(0.0, outermost);
        let around = Vector2::repeat(reach.max(radius));
        let Bounds { low, high } = self.bounds;
        grid_around(low - around, high + around, resolution, MARGIN).map_err(|error| {
            let [low, high] = [low, high].map(|corner| (corner.x, corner.y));
            about(path)(Fault::Extent { low, high, error })
        })
    }
}

/// A sensor of a log, with its model.
#[derive(Debug)]
struct MappedSensor {
    ring: Arc<SonarRing>,
    model: SensorModel,
    looks: Looks,
    last_used: Option<Isometry2<f64>>,
}

/// A map that grows frame by frame.
#[derive(Debug)]
pub struct Mapper {
    sensors: Vec<MappedSensor>,
    follower: Follower,
    stride: Stride,
    /// The robot's radius \[m\], if its body is evidence.
    body: Option<f64>,
    /// The coverage map.
    pub map: CoverageMap,
    /// The log-odds occupancy grid of the same scans.
    pub occupancy: OccupancyGrid,
    /// The path for a picture.
    pub trail: Trail,
    /// The length of the path \[m\].
    pub path_length: f64,
    /// The number of scans in the map.
    pub scans: usize,
    /// The number of good frames that were not used.
    pub standing: usize,
    /// The number of places where the poses jump.
    pub jumps: usize,
    /// Whether the watch stopped the reading before the end of the log.
    pub stopped: bool,
    /// The pose of the first frame.
    pub first: Option<Isometry2<f64>>,
    /// The pose of the last frame.
    pub last: Option<Isometry2<f64>>,
}

impl Mapper {
    /// Returns a map without a scan. `body` is the radius of the robot \[m\], if its body is evidence.
    ///
    /// # Errors
    /// If the number of bins is impossible.
    pub fn new(
        (grid, bins): (Grid, usize),
        models: Vec<(Arc<SonarRing>, SensorModel)>,
        stride: Stride,
        body: Option<f64>,
    ) -> Result<Self> {
        let sensor = |(ring, model)| MappedSensor {
            ring,
            looks: Looks::new(&model),
            model,
            last_used: None,
        };
        Ok(Self {
            map: CoverageMap::new(grid, bins)?,
            occupancy: OccupancyGrid::new(grid, OccupancyParameters::default()),
            sensors: models.into_iter().map(sensor).collect(),
            follower: Follower::default(),
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
        })
    }

    /// Takes over a frame; `false` if its sensor is not known.
    fn add(&mut self, frame: &LogFrame) -> bool {
        let pose = frame.scan.pose;
        self.first.get_or_insert(pose);
        self.last = Some(pose);
        for leg in self.follower.follow(frame) {
            self.step(&leg);
        }
        let is_it = |sensor: &&mut MappedSensor| {
            Arc::ptr_eq(&sensor.ring, &frame.ring) || sensor.ring == frame.ring
        };
        let Some(sensor) = self.sensors.iter_mut().find(is_it) else { return false };
        if !self.stride.takes(sensor.last_used.as_ref(), &pose) {
            self.standing += 1;
            return true;
        }
        sensor.last_used = Some(pose);
        self.scans += 1;
        sensor.looks.integrate(&sensor.model, &mut self.map, &frame.scan);
        self.occupancy.integrate(&sensor.model, &frame.scan);
        true
    }

    /// Takes over a leg of the path, which the body has swept.
    fn step(&mut self, leg: &Leg) {
        self.trail.push(leg.to, leg.jump);
        if leg.jump {
            self.jumps += 1;
        } else {
            self.path_length += (leg.to - leg.from).norm();
        }
        if let Some(radius) = self.body {
            let from = if leg.swept && !leg.jump { leg.from } else { leg.to };
            for change in integrate_body(&mut self.map, from, leg.to, radius) {
                self.occupancy.pin_free(change.cell);
            }
        }
    }
}
