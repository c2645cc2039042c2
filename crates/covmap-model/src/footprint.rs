//! The cells that a beam covers: the one traversal of cones and lines in this project.

mod rows;

use covmap::{Cell, Grid, short};
use covmap_sonar::SonarRing;
use nalgebra::{Isometry2, Point2, Vector2};
use rows::Rows;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Bearings closer than this to the border of a sector lie on it [rad].
const BORDER: f64 = 1e-9;

/// The number of cells of a row that are tested side by side.
const WIDE: usize = 8;

/// Rule for the cells that belong to a beam.
///
/// Choice: Eq. (9) has no angle term, so a beam covers all cells within an angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FootprintRule {
    /// For a ring with a centre: a cell belongs to the beam whose axis is nearest to its
    /// bearing **from the robot's centre**, and within `half_angle` of it. Sectors are
    /// half-open, so that 24 of 7.5° tile the plane. (Sectors from sensors that stand .25 m
    /// apart would leave strips of cells between them uncovered.)
    Sectors {
        /// Half of a sector's angle \[rad\].
        half_angle: f64,
    },
    /// For any arrangement: the cells within `half_angle` of the beam's axis, seen from the sensor,
    /// half-open, and the cells that the axis itself traverses. Where the beam is narrower than a
    /// cell, only the latter belong to it.
    Cones {
        /// Half of the cone's angle \[rad\]; 0 for a line.
        half_angle: f64,
    },
}

/// Error of a footprint that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FootprintError {
    /// The half-angle is impossible.
    #[error(
        "model.footprint: half_angle {} rad must lie in [0, 1.5], and above 0 for sectors",
        short(.0)
    )]
    HalfAngle(f64),
    /// Two sensors look the same way, so that sectors cannot tell them apart.
    #[error(
        "model.footprint: sensors {0} and {1} look in the same direction; use Cones for this ring"
    )]
    SameDirection(usize, usize),
}

/// A cell that a beam covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootprintCell {
    /// The cell.
    pub cell: Cell,
    /// d^l, the distance from the sensor to the cell's centre \[m\].
    pub cell_distance: f64,
    /// Position of the cell's centre across the beam: 0 at the right border, 1 at the left, and
    /// linear along the chord between them; ½ where the beam has no width.
    pub across: f64,
}

/// A beam's sector in the frame of the robot.
#[derive(Debug, Clone)]
struct Sector {
    /// Position of the sensor, from which ranges are measured.
    sensor: Point2<f64>,
    /// Direction of the sensor.
    axis: Vector2<f64>,
    /// Point from which bearings are measured.
    apex: Point2<f64>,
    /// The borders: a bearing `b` is inside if `first ≤ b < last`, counter-clockwise.
    first: Vector2<f64>,
    last: Vector2<f64>,
    /// Whether cells that the axis traverses belong to the beam as well.
    with_axis: bool,
}

/// The footprints of all beams of a ring.
#[derive(Debug, Clone)]
pub struct Footprint {
    sectors: Vec<Sector>,
}

fn direction(angle: f64) -> Vector2<f64> {
    let (sin, cos) = libm::sincos(angle);
    Vector2::new(cos, sin)
}

/// Returns the length of a vector: `norm`, whose square root no compiler can do side by side.
#[inline(always)]
fn length(v: Vector2<f64>) -> f64 {
    v.norm_squared().sqrt()
}

impl Footprint {
    /// Creates the footprints of a ring's beams.
    ///
    /// # Errors
    /// If the half-angle is impossible, or sectors cannot tell two sensors apart.
    pub fn new(ring: &SonarRing, rule: &FootprintRule) -> Result<Self, FootprintError> {
        let angles: Vec<f64> = ring.beams().iter().map(|b| b.pose.rotation.angle()).collect();
        let widths = match *rule {
            FootprintRule::Cones { half_angle } if (0.0..=1.5).contains(&half_angle) => {
                vec![(half_angle, half_angle); angles.len()]
            }
            FootprintRule::Sectors { half_angle } if half_angle > 0.0 && half_angle <= 1.5 => {
                sector_widths(&angles, half_angle)?
            }
            FootprintRule::Cones { half_angle } | FootprintRule::Sectors { half_angle } => {
                return Err(FootprintError::HalfAngle(half_angle));
            }
        };
        let from_sensor = matches!(rule, FootprintRule::Cones { .. });
        let sector = |(beam, (right, left)): (usize, (f64, f64))| {
            let sensor = Point2::from(ring.beams()[beam].pose.translation.vector);
            Sector {
                sensor,
                axis: direction(angles[beam]),
                apex: if from_sensor { sensor } else { Point2::origin() },
                first: direction(angles[beam] - right),
                last: direction(angles[beam] + left),
                with_axis: from_sensor,
            }
        };
        Ok(Self { sectors: widths.into_iter().enumerate().map(sector).collect() })
    }

    /// Returns the position and the direction of each sensor in the frame of the robot.
    pub fn sensors(&self) -> impl Iterator<Item = (Point2<f64>, Vector2<f64>)> {
        self.sectors.iter().map(|sector| (sector.sensor, sector.axis))
    }

    /// Returns the number of beams.
    pub fn beams(&self) -> usize {
        self.sectors.len()
    }

    /// Estimates the number of cells of side `resolution` \[m\] that a beam covers up to a distance
    /// from its sensor \[m\]. The estimate is rather too high than too low.
    ///
    /// # Panics
    /// If there is no such beam.
    pub fn cells_about(&self, beam: usize, reach: f64, resolution: f64) -> f64 {
        let Sector { sensor, apex, first, last, .. } = &self.sectors[beam];
        let (width, offset) =
            (libm::atan2(first.perp(last), first.dot(last)).abs(), (sensor - apex).norm());
        let area = 0.5 * width * ((reach + offset) * (reach + offset) - offset * offset);
        // A line passes at most one and a half cells for each cell of its length.
        area / (resolution * resolution) + 1.5 * reach / resolution + 4.0
    }

    /// Returns the distance from the robot's centre within which the beams cover cells, up to a
    /// distance from their sensors \[m\].
    pub fn farthest(&self, reach: f64) -> f64 {
        let from_center = |sector: &Sector| sector.sensor.coords.norm();
        self.sectors.iter().map(from_center).fold(0.0, f64::max) + reach
    }

    /// Visits the cells of a grid that a beam covers up to a distance from its sensor, row
    /// by row.
    ///
    /// `pose` is `world_from_robot`, with any heading; `reach` is the largest cell distance
    /// \[m\]. Nothing is covered behind the sensor. A pose that is not finite covers nothing.
    ///
    /// # Panics
    /// If there is no such beam.
    #[inline(always)]
    pub fn for_each_cell(
        &self,
        grid: &Grid,
        pose: &Isometry2<f64>,
        beam: usize,
        reach: f64,
        mut visit: impl FnMut(FootprintCell),
    ) {
        let sector = self.sectors[beam].moved(pose);
        let (low, high) = sector.bounds(reach);
        if !(low.iter().chain(high.iter()).all(|v| v.is_finite()) && reach >= 0.0) {
            return;
        }
        let (first, last) = inside(grid, low, high);
        let rows = Rows::new(&sector, grid, low.x, high.x);
        for y in first.y..=last.y {
            let Some((left, right)) = rows.columns(grid, y) else { continue };
            let (left, right) = (left.max(first.x), right.min(last.x));
            for x in (left..=right).step_by(WIDE) {
                let (distances, across) = sector.covered(grid, Cell::new(x, y), reach);
                for (cell_x, (cell_distance, across)) in
                    (x..=right).zip(distances.into_iter().zip(across))
                {
                    if cell_distance >= 0.0 {
                        visit(FootprintCell { cell: Cell::new(cell_x, y), cell_distance, across });
                    }
                }
            }
        }
    }

    /// Returns the first and the last cell of a rectangle of the grid that holds all footprints.
    /// The rectangle is empty, the last cell before the first, if the pose is not finite.
    pub(crate) fn extent(&self, grid: &Grid, pose: &Isometry2<f64>, reach: f64) -> (Cell, Cell) {
        let radius = self.farthest(reach);
        let (center, margin) = (Point2::from(pose.translation.vector), Vector2::repeat(radius));
        if !radius.is_finite() || !center.iter().all(|v| v.is_finite()) {
            return (Cell::new(0, 0), Cell::new(-1, -1));
        }
        inside(grid, center - margin, center + margin)
    }
}

/// Returns the first and the last cell of a grid in a box. The last is before the first if there
/// are none.
fn inside(grid: &Grid, low: Point2<f64>, high: Point2<f64>) -> (Cell, Cell) {
    let (low, high) = (grid.unbounded_cell_at(low), grid.unbounded_cell_at(high));
    let side = |n: usize| i32::try_from(n).unwrap_or(i32::MAX) - 1;
    let last = Cell::new(high.x.min(side(grid.width())), high.y.min(side(grid.height())));
    let first = Cell::new(low.x.max(0), low.y.max(0));
    // The callers compute with these cells, which must not overflow for a box that is far out.
    let is_empty = last.x < first.x || last.y < first.y;
    if is_empty { (Cell::new(0, 0), Cell::new(-1, -1)) } else { (first, last) }
}

/// Returns the angles to the right and to the left of each axis: half of the way to the next axis,
/// but no more than `half_angle`.
fn sector_widths(angles: &[f64], half_angle: f64) -> Result<Vec<(f64, f64)>, FootprintError> {
    let turn = |angle: f64| angle - TAU * (angle / TAU).floor();
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by(|a, b| turn(angles[*a]).total_cmp(&turn(angles[*b])));
    let mut widths = vec![(half_angle, half_angle); angles.len()];
    for (i, beam) in order.iter().enumerate() {
        let next = order[(i + 1) % order.len()];
        if next == *beam {
            break;
        }
        let gap = turn(angles[next] - angles[*beam]);
        if !(1e-6..=TAU - 1e-6).contains(&gap) {
            return Err(FootprintError::SameDirection(*beam, next));
        }
        widths[*beam].1 = half_angle.min(0.5 * gap);
        widths[next].0 = half_angle.min(0.5 * gap);
    }
    Ok(widths)
}

impl Sector {
    fn moved(&self, pose: &Isometry2<f64>) -> Self {
        Self {
            sensor: pose * self.sensor,
            axis: pose * self.axis,
            apex: pose * self.apex,
            first: pose * self.first,
            last: pose * self.last,
            with_axis: self.with_axis,
        }
    }

    /// Returns a box that holds all points of the sector within `reach` of the sensor.
    fn bounds(&self, reach: f64) -> (Point2<f64>, Point2<f64>) {
        let radius = reach + (self.sensor - self.apex).norm();
        let mut low = self.apex.inf(&self.sensor);
        let mut high = self.apex.sup(&self.sensor);
        let mut include = |direction: Vector2<f64>| {
            let point = self.apex + direction * radius;
            (low, high) = (low.inf(&point), high.sup(&point));
        };
        [self.first, self.last, self.axis].into_iter().for_each(&mut include);
        for quarter in [Vector2::x(), Vector2::y(), -Vector2::x(), -Vector2::y()] {
            if self.first.perp(&quarter) >= 0.0
                && quarter.perp(&self.last) >= 0.0
                && quarter.dot(&self.axis) > 0.0
            {
                include(quarter);
            }
        }
        (low, high)
    }

    /// Returns the distances from the sensor of a cell and the next ones of its row, −1 for a cell
    /// that the beam does not cover, and their positions across the beam.
    #[inline(always)]
    fn covered(&self, grid: &Grid, cell: Cell, reach: f64) -> ([f64; WIDE], [f64; WIDE]) {
        let y = grid.center(cell).y;
        let (mut centers, mut distances, mut across) = ([0.0; WIDE], [0.0; WIDE], [0.5; WIDE]);
        for (dx, x) in (0..).zip(&mut centers) {
            *x = grid.center(Cell::new(cell.x + dx, cell.y)).x;
        }
        for ((x, d), across) in centers.iter().zip(&mut distances).zip(&mut across) {
            let from_sensor = Vector2::new(*x, y) - self.sensor.coords;
            let from_apex = Vector2::new(*x, y) - self.apex.coords;
            let distance = length(from_sensor);
            let border = BORDER * (from_apex.x.abs() + from_apex.y.abs());
            let (right, left) = (self.first.perp(&from_apex), from_apex.perp(&self.last));
            let covered = (from_sensor.dot(&self.axis) > 0.0)
                & (distance <= reach)
                & (right >= -border)
                & (left > border);
            *d = if covered { distance } else { -1.0 };
            let width = right + left;
            *across = if width > border { (right / width).clamp(0.0, 1.0) } else { 0.5 };
        }
        if self.with_axis {
            for (dx, d) in (0..).zip(&mut distances) {
                *d = d.max(self.distance_along_axis(grid, cell.offset(dx, 0), reach));
            }
        }
        (distances, across)
    }

    /// Returns the distance from the sensor of a cell that the axis traverses; −1 for another cell.
    fn distance_along_axis(&self, grid: &Grid, cell: Cell, reach: f64) -> f64 {
        let from_sensor = grid.center(cell) - self.sensor;
        let distance = length(from_sensor);
        let in_reach = from_sensor.dot(&self.axis) > 0.0 && distance <= reach;
        let covered =
            in_reach && self.axis_crosses(grid.lower_corner(cell), grid.resolution(), reach);
        if covered { distance } else { -1.0 }
    }

    /// Returns whether the axis, from the sensor to `reach`, passes through the square of side `r`
    /// at `corner`.
    fn axis_crosses(&self, corner: Point2<f64>, r: f64, reach: f64) -> bool {
        let (mut enter, mut leave) = (0.0f64, reach);
        for i in 0..2 {
            let (start, slope) = (self.sensor[i], self.axis[i]);
            let (a, b) = ((corner[i] - start) / slope, (corner[i] + r - start) / slope);
            if slope.abs() < 1e-12 {
                if start < corner[i] || start >= corner[i] + r {
                    return false;
                }
            } else {
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
        }
        enter < leave
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use covmap_sonar::RingSpecification;
    use proptest::prelude::*;

    const B21R: FootprintRule =
        FootprintRule::Sectors { half_angle: 7.5 * std::f64::consts::PI / 180.0 };

    fn grid(cells: usize) -> Grid {
        let half = cells as f64 * 0.05;
        Grid::new(Point2::new(-half, -half), 0.1, cells, cells).unwrap()
    }

    fn covered(
        footprint: &Footprint,
        grid: &Grid,
        pose: &Isometry2<f64>,
        beam: usize,
        reach: f64,
    ) -> Vec<FootprintCell> {
        let mut cells = Vec::new();
        footprint.for_each_cell(grid, pose, beam, reach, |cell| cells.push(cell));
        cells
    }

    #[track_caller]
    fn check(rule: FootprintRule, pose: Isometry2<f64>, reach: f64, expected: &str) {
        let sensor = RingSpecification::Sensors(vec![covmap_sonar::SensorSpecification {
            x: 0.0,
            y: 0.0,
            angle: 0.0,
            half_angle: 0.1,
            min_range: 0.0,
            max_range: 9.0,
        }]);
        let ring = SonarRing::from_specification(&sensor).unwrap();
        let grid = grid(12);
        let cells = covered(&Footprint::new(&ring, &rule).unwrap(), &grid, &pose, 0, reach);
        let picture = |y: i32| -> String {
            let mark = |x| if cells.iter().any(|c| c.cell == Cell::new(x, y)) { '#' } else { '.' };
            (0..12).map(mark).collect()
        };
        let drawn: Vec<String> = (0..12).rev().map(picture).collect();
        let expected: Vec<&str> = expected.split_whitespace().collect();
        assert_eq!(drawn, expected, "\n{}", drawn.join("\n"));
    }

    #[test]
    fn a_lasers_line_covers_what_it_traverses() {
        check(
            FootprintRule::Cones { half_angle: 0.0 },
            Isometry2::new(Vector2::new(-0.55, -0.55), 0.5),
            1.0,
            "............
             ............
             ............
             ............
             ............
             ............
             ........#...
             ......###...
             .....##.....
             ...###......
             .###........
             .#..........",
        );
    }

    #[test]
    fn a_cone_covers_the_cells_within_its_angle() {
        check(
            FootprintRule::Cones { half_angle: 0.2618 },
            Isometry2::new(Vector2::new(-0.55, 0.05), 0.0),
            1.0,
            "............
             ............
             ............
             ........##..
             ....######..
             .##########.
             ....######..
             ........##..
             ............
             ............
             ............
             ............",
        );
    }

    #[test]
    fn two_sensors_that_look_the_same_way_have_no_sectors() {
        let sensor = SonarRing::b21r().beams()[3];
        let ring = SonarRing::new(vec![sensor, sensor]).unwrap();
        assert!(matches!(Footprint::new(&ring, &B21R), Err(FootprintError::SameDirection(..))));
        let wide = FootprintRule::Cones { half_angle: f64::NAN };
        assert!(matches!(Footprint::new(&ring, &wide), Err(FootprintError::HalfAngle(_))));
    }

    proptest! {
        #[test]
        fn every_cell_around_the_robot_is_in_exactly_one_footprint(
            x in -0.05..0.05f64, y in -0.05..0.05f64, quarter in 0..4i32, turn in prop::option::of(0.0..6.3f64)
        ) {
            let footprint = Footprint::new(&SonarRing::b21r(), &B21R).unwrap();
            let heading = turn.unwrap_or(f64::from(quarter) * std::f64::consts::FRAC_PI_2);
            let (x, y) = if turn.is_none() { (0.05, 0.05) } else { (x, y) };
            let grid = grid(70);
            let mut times = vec![0; grid.len()];
            let pose = Isometry2::new(Vector2::new(x, y), heading);
            for beam in 0..24 {
                for c in covered(&footprint, &grid, &pose, beam, 3.0) {
                    times[grid.index(c.cell).unwrap()] += 1;
                }
            }
            for cell in grid.cells() {
                let distance = (grid.center(cell) - Point2::new(x, y)).norm();
                if (0.35..3.0).contains(&distance) {
                    prop_assert_eq!(times[grid.index(cell).unwrap()], 1, "{:?}", cell);
                }
            }
        }

        #[test]
        fn the_traversal_misses_no_cell(
            x in -2.0..2.0f64, y in -2.0..2.0f64, heading in -7.0..7.0f64,
            reach in 0.0..5.0f64, half_angle in prop::sample::select(vec![0.0, 0.01, 0.13, 0.26, 1.4]),
            sectors in any::<bool>(), beam in 0..24usize
        ) {
            let rule = if sectors { B21R } else { FootprintRule::Cones { half_angle } };
            let footprint = Footprint::new(&SonarRing::b21r(), &rule).unwrap();
            let (grid, pose) = (grid(50), Isometry2::new(Vector2::new(x, y), heading));
            let sector = footprint.sectors[beam].moved(&pose);
            let all: Vec<FootprintCell> = grid.cells().filter_map(|cell| {
                let (distances, across) = sector.covered(&grid, cell, reach);
                let (cell_distance, across) = (distances[0], across[0]);
                (cell_distance >= 0.0).then_some(FootprintCell { cell, cell_distance, across })
            }).collect();
            prop_assert_eq!(covered(&footprint, &grid, &pose, beam, reach), all);
        }
    }
}
