//! The record of a robot: laser scans for a survey, and examples for a fit.

use crate::Config;
use crate::error::{Fault, Result, about};
use crate::files::beside;
use crate::log_map::{Stride, grid_around};
use crate::memory;
use covmap::{CoverageMap, Raster};
use covmap_fit::{BodyRecord, Example};
use covmap_io::read_ron;
use covmap_log::{Account, BagOptions, LogOptions, LogReader, Sensor};
use covmap_model::integrate_body;
use covmap_sonar::{Scan, SonarRing};
use covmap_survey::{Survey, SurveyParameters};
use covmap_world::{Surface, World};
use nalgebra::{Point2, Vector2};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Least coverage with which a cell hides the cells behind it.
const OPAQUE: f64 = 0.5;

/// The log of a robot, and a survey of the building.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recorded {
    /// The log, with sonar and laser.
    pub log: PathBuf,
    /// The file of the robot's true poses; empty for those of the log.
    pub poses: PathBuf,
    /// The survey.
    pub truth: PathBuf,
    /// Distance since the last used frame from which on a frame is used \[m\].
    pub every: f64,
    /// Turn since the last used frame from which on a frame is used \[rad\].
    pub every_angle: f64,
}

/// All scans of one sensor of a log.
#[derive(Debug)]
pub struct Frames {
    /// The scans, each with the ring that made it.
    pub scans: Vec<(Arc<SonarRing>, Scan)>,
    /// The line of each scan.
    pub lines: Vec<usize>,
    /// The account of the log.
    pub account: Account,
}

/// Largest number of readings that are held at the same time, in some 300 MB.
const MOST_READINGS: usize = 16_000_000;
/// The size of a scan without its readings, in readings.
const SCAN_SIZE: usize = 8;

/// The size of the held part of a log, in readings.
#[derive(Debug, Default)]
struct Held(usize);

impl Held {
    /// Adds a scan; `false` if that is more than may be held.
    fn add(&mut self, scan: &Scan) -> bool {
        self.0 += scan.ranges.len() + SCAN_SIZE;
        self.0 <= MOST_READINGS
    }
}

/// Reads all scans of a log; `ring` stands in for facts about the sonars that the log does not state.
///
/// # Errors
/// If the log cannot be read, or has more readings than may be held.
pub fn frames(log: &Path, poses: Option<&Path>, sensor: Sensor, ring: SonarRing) -> Result<Frames> {
    let options = LogOptions {
        sensor,
        ring,
        poses: poses.map(Path::to_path_buf),
        bag: BagOptions::default(),
    };
    let mut reader = LogReader::open(log, &options)?;
    let (mut scans, mut lines, mut held) = (Vec::new(), Vec::new(), Held::default());
    for frame in &mut reader {
        let frame = frame?;
        if !held.add(&frame.scan) {
            return Err(about(log)(Fault::ManyReadings { line: frame.line, most: MOST_READINGS }));
        }
        scans.push((frame.ring, frame.scan));
        lines.push(frame.line);
    }
    Ok(Frames { scans, lines, account: reader.account().clone() })
}

impl Recorded {
    /// Checks the example before any work is done.
    pub fn check(&self, path: &Path) -> Result<()> {
        if !(self.every >= 0.0 && self.every_angle >= 0.0) {
            return Err(about(path)(Fault::Number {
                field: "every and every_angle",
                must: "at least 0",
            }));
        }
        read_ron::<Survey>(beside(path, &self.truth))?;
        let log = beside(path, &self.log);
        Ok(covmap_io::find(&log)?)
    }

    /// Returns the sonar's scans, and the surveyed coverage of the cells that count.
    ///
    /// A cell counts if the laser saw it, and it is in sight of the robot within the usable range or a first
    /// solid cell behind, and not under the robot's body, which is evidence at the places of the scans.
    pub fn example(&self, path: &Path, config: &Config) -> Result<Example> {
        let (log, truth) = (beside(path, &self.log), beside(path, &self.truth));
        let poses = (!self.poses.as_os_str().is_empty()).then(|| beside(path, &self.poses));
        let (ring, model) = config.build()?;
        let sonar = frames(&log, poses.as_deref(), Sensor::Sonar, ring.clone())?;
        let ring = (*sonar.scans[0].0).clone();
        let scans = self.used(sonar.scans);

        let around = Vector2::repeat(model.max_reach() + 1.0);
        let first = Point2::from(scans[0].pose.translation.vector);
        let places = scans.iter().map(|scan| Point2::from(scan.pose.translation.vector));
        let (low, high) =
            places.clone().fold((first, first), |(low, high), at| (low.inf(&at), high.sup(&at)));
        let grid = grid_around(low - around, high + around, config.resolution, 0);
        let grid = grid.map_err(about(&log))?;
        memory::check_map(&grid, config).map_err(about(&log))?;

        let survey: Survey = read_ron(&truth)?;
        let coverage = survey.coverage(&grid).map_err(about(&truth))?;
        let laser = frames(&log, poses.as_deref(), Sensor::Laser, ring.clone())?;
        let beams = laser.scans.iter().map(|(ring, scan)| (&**ring, scan));
        let seen = survey.seen(&grid, beams, &SurveyParameters::indoor()).map_err(about(&truth))?;
        let counts = counted(config, &coverage, &seen, places)?;
        let cells = grid.cells().filter(|cell| counts.get(*cell) == Some(&true));
        let with_truth = |cell| (cell, coverage.get(cell).copied().unwrap_or(0.0));
        let name = log.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let body = BodyRecord::standing(config.robot.radius, &scans);
        let truth = cells.map(with_truth).collect();
        Ok(Example { name, ring, scans, body, grid, truth })
    }

    /// The scans that are used: scans of a robot that stands still are no new evidence.
    fn used(&self, frames: Vec<(Arc<SonarRing>, Scan)>) -> Vec<Scan> {
        let stride = Stride { every: self.every, turn: self.every_angle };
        let mut used: Vec<Scan> = Vec::new();
        for (_, scan) in frames {
            if stride.takes(used.last().map(|last| &last.pose), &scan.pose) {
                used.push(scan);
            }
        }
        used
    }
}

/// Marks the cells that count.
fn counted(
    config: &Config,
    coverage: &Raster<f64>,
    seen: &Raster<bool>,
    places: impl Iterator<Item = Point2<f64>> + Clone,
) -> Result<Raster<bool>> {
    let grid = *coverage.grid();
    let solid = Raster::from_fn(grid, |cell| coverage.get(cell).is_some_and(|c| *c >= OPAQUE));
    let world = World::from_raster("survey", &solid, Surface::Rough)?;
    let mut body = CoverageMap::new(grid, config.model.bins)?;
    for at in places.clone() {
        integrate_body(&mut body, at, at, config.robot.radius);
    }
    let sight = world.cells_seen_from(&grid, coverage, places, config.model.usable_range);
    Ok(Raster::from_fn(grid, |cell| {
        let is = |raster: &Raster<bool>| raster.get(cell) == Some(&true);
        is(seen) && !body.is_pinned(cell) && (is(&sight.in_sight) || is(&sight.first_solid))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_sonar::Range;
    use nalgebra::Isometry2;

    #[test]
    fn not_more_of_a_log_is_held_than_fits() {
        let scan = |beams| Scan {
            pose: Isometry2::identity(),
            time: 0.0,
            ranges: vec![Range::Missing; beams],
        };
        let (laser, mut held) = (scan(361), Held::default());
        // Two and a half hours at 4.7 Hz.
        assert_eq!((0..100_000).take_while(|_| held.add(&laser)).count(), 43_360);
        let (empty, mut held) = (scan(0), Held::default());
        assert_eq!((0..9_000_000).take_while(|_| held.add(&empty)).count(), 2_000_000);
    }
}
