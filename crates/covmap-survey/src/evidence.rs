//! The evidence of the laser about every cell.

use super::near::Near;
use super::view::{axis, is_pose};
use super::{Survey, SurveyParameters};
use covmap::{Grid, Raster};
use covmap_sonar::{Range, Scan, SonarRing};
use covmap_world::WorldError;
use covmap_world::geometry::cells_along;
use nalgebra::{Point2, Vector2};

/// Counts of the beams that met one cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EchoEvidence {
    /// Beams that went through the cell.
    pub passed: u32,
    /// Echoes from the cell that a primitive of the survey explains.
    pub explained: u32,
    /// Echoes from the cell that no primitive explains: from moving things, from things too small,
    /// or from gaps in the survey.
    pub unexplained: u32,
    /// The number of scans with such echoes.
    pub unexplained_scans: u32,
    /// Echoes from the front behind which the whole cell is solid.
    pub behind: u32,
}

impl Survey {
    /// Counts the beams of all scans in every cell.
    ///
    /// An echo behind `max_range` counts as a beam that went through up to there; no echo, as one
    /// that went through up to `free_without_echo`. Scans whose pose is not finite are passed over.
    ///
    /// # Errors
    /// If a primitive has an impossible number.
    pub fn evidence<'a>(
        &self,
        grid: &Grid,
        scans: impl IntoIterator<Item = (&'a SonarRing, &'a Scan)>,
        parameters: &SurveyParameters,
    ) -> Result<Raster<EchoEvidence>, WorldError> {
        let near = Near::new(self)?;
        let mut witness = Witness {
            near,
            parameters,
            evidence: Raster::filled(*grid, EchoEvidence::default()),
            unexplained: Vec::new(),
        };
        for (ring, scan) in scans.into_iter().filter(|(_, scan)| is_pose(&scan.pose)) {
            for (beam, range) in ring.beams().iter().zip(&scan.ranges) {
                let (eye, direction) = axis(&scan.pose, &beam.pose);
                match *range {
                    Range::Echo(range) if range > 0.0 && range <= parameters.max_range => {
                        witness.echo(eye, direction, range);
                    }
                    Range::Echo(range) if range > 0.0 => {
                        witness.pass(eye, direction, parameters.max_range);
                    }
                    Range::NoEcho => {
                        let free = parameters.free_without_echo.min(beam.max_range);
                        witness.pass(eye, direction, free);
                    }
                    _ => {}
                }
            }
            witness.end_scan();
        }
        Ok(witness.evidence)
    }

    /// Returns the cells that the laser saw and that the survey explains.
    ///
    /// In these cells a beam went through or ended, or they are solid right behind a front that a
    /// beam met. Excluded are the cells in which more than `max_unexplained` of the beams ended
    /// without an explanation, and the cells with unexplained echoes in `min_views` scans: some
    /// object is there, if only glass.
    ///
    /// # Errors
    /// As [`Survey::evidence`].
    pub fn seen<'a>(
        &self,
        grid: &Grid,
        scans: impl IntoIterator<Item = (&'a SonarRing, &'a Scan)>,
        parameters: &SurveyParameters,
    ) -> Result<Raster<bool>, WorldError> {
        let evidence = self.evidence(grid, scans, parameters)?;
        Ok(evidence.map(|e| e.is_seen(parameters)))
    }
}

impl EchoEvidence {
    /// Returns whether the laser saw the cell, and the survey explains the echoes there.
    pub fn is_seen(&self, parameters: &SurveyParameters) -> bool {
        let [passed, explained, unexplained, behind] =
            [self.passed, self.explained, self.unexplained, self.behind].map(f64::from);
        let known = passed + explained + behind;
        known > 0.0
            && unexplained <= parameters.max_unexplained * (known + unexplained)
            && (self.unexplained_scans as usize) < parameters.min_views.max(1)
    }
}

struct Witness<'a> {
    near: Near,
    parameters: &'a SurveyParameters,
    evidence: Raster<EchoEvidence>,
    /// The cells with unexplained echoes of this scan.
    unexplained: Vec<usize>,
}

impl Witness<'_> {
    /// Counts a beam that went through up to a range.
    fn pass(&mut self, eye: Point2<f64>, direction: Vector2<f64>, range: f64) {
        let grid = *self.evidence.grid();
        let Some((from, to)) = inside(&grid, eye, direction, range) else { return };
        cells_along(&grid, eye + direction * from, direction, to - from, |i| {
            let passed = &mut self.evidence[i].passed;
            *passed = passed.saturating_add(1);
        });
    }

    /// Counts a beam that ended at a range.
    fn echo(&mut self, eye: Point2<f64>, direction: Vector2<f64>, range: f64) {
        let at = eye + direction * range;
        self.pass(eye, direction, range);
        let reach = self.parameters.explained;
        let explained = self.near.explains(at, reach);
        let grid = *self.evidence.grid();
        if let Some(i) = grid.cell_at(at).and_then(|cell| grid.index(cell)) {
            let here = &mut self.evidence[i];
            here.passed = here.passed.saturating_sub(1);
            let count = if explained { &mut here.explained } else { &mut here.unexplained };
            *count = count.saturating_add(1);
            if !explained {
                self.unexplained.push(i);
            }
        }
        if let Some((line, length, thickness)) = self.near.front(at, reach) {
            let foot = at + line.back() * line.height(at);
            let Some((from, to)) = inside(&grid, foot, line.back(), thickness) else { return };
            cells_along(&grid, foot + line.back() * from, line.back(), to - from, |i| {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let corners = corners.map(|(x, y)| grid.lower_corner(grid.cell(i).offset(x, y)));
                let solid = |p: &Point2<f64>| {
                    -line.height(*p) <= thickness && (0.0..=length).contains(&line.place(*p))
                };
                if corners.iter().all(solid) {
                    let behind = &mut self.evidence[i].behind;
                    *behind = behind.saturating_add(1);
                }
            });
        }
    }

    fn end_scan(&mut self) {
        self.unexplained.sort_unstable();
        self.unexplained.dedup();
        for i in self.unexplained.drain(..) {
            let scans = &mut self.evidence[i].unexplained_scans;
            *scans = scans.saturating_add(1);
        }
    }
}

/// Returns the part of a ray that lies in a grid, as an interval of distances.
fn inside(
    grid: &Grid,
    origin: Point2<f64>,
    direction: Vector2<f64>,
    length: f64,
) -> Option<(f64, f64)> {
    let low = grid.lower_left();
    let high = low + Vector2::new(grid.width() as f64, grid.height() as f64) * grid.resolution();
    let (mut from, mut to) = (0.0_f64, length);
    for axis in 0..2 {
        let (a, b) = (low[axis] - origin[axis], high[axis] - origin[axis]);
        if direction[axis] == 0.0 {
            if a > 0.0 || b <= 0.0 {
                return None;
            }
        } else {
            let (a, b) = (a / direction[axis], b / direction[axis]);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
    }
    // The hair keeps rounding from leading out of the grid.
    let hair = if from > 0.0 { 1e-9 } else { 0.0 };
    (from + hair < to).then_some((from + hair, to))
}
