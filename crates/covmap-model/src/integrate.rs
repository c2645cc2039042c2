//! Eq. (1)–(8), as printed: the multiplication of a measurement into the map. [`fast`] is the code
//! that runs.

mod by_cause;
mod cause_terms;
mod evidence;
mod fast;

pub use fast::{integrate, integrate_new};

use by_cause::explain;

use crate::{FootprintCell, Met, Outcome, SensorModel, Update};
use covmap::{Cell, Change, CoverageMap, Grid, MAX_BINS};
use covmap_sonar::Scan;
use nalgebra::{Point2, Vector2};

impl SensorModel {
    /// Visits each cell of C(l, d) of every reading of a scan, beam by beam, with its distance from
    /// the sensor and the meaning of the reading.
    ///
    /// # Panics
    /// If the scan has not one reading for each beam of the model's ring.
    pub fn for_each_covered(
        &self,
        grid: &Grid,
        scan: &Scan,
        mut visit: impl FnMut(Cell, f64, Outcome),
    ) {
        assert_eq!(scan.ranges.len(), self.footprint().beams(), "one reading for each beam");
        for (beam, range) in scan.ranges.iter().enumerate() {
            let Some(outcome) = self.outcome(*range) else { continue };
            let reach = self.reach(outcome);
            self.footprint().for_each_cell(grid, &scan.pose, beam, reach, |covered| {
                visit(covered.cell, covered.cell_distance, outcome);
            });
        }
    }
}

/// Integrates a scan into a map by Eq. (8) as printed, cell by cell in f64. Tests compare
/// [`integrate`] with it. Returns the changes, in row-major order, each cell once.
///
/// # Panics
/// As [`integrate`].
pub fn integrate_literally(model: &SensorModel, map: &mut CoverageMap, scan: &Scan) -> Vec<Change> {
    integrate_new_literally(model, map, scan, &vec![1.0; scan.ranges.len()])
}

/// Integrates a scan as [`integrate_literally`], with the novelty of each beam's reading. Tests
/// compare [`integrate_new`] with it.
///
/// # Panics
/// As [`integrate_new`].
pub fn integrate_new_literally(
    model: &SensorModel,
    map: &mut CoverageMap,
    scan: &Scan,
    novelty: &[f64],
) -> Vec<Change> {
    assert!(model.fits(map), "the model is for other bins or another resolution");
    let grid = *map.grid();
    let mut evidence = [0.0; MAX_BINS];
    let evidence = &mut evidence[..map.bins()];
    let mut changes = Vec::new();
    match &model.parameters().update {
        Update::Product(_) => {
            model.for_each_covered(&grid, scan, |cell, cell_distance, outcome| {
                model.evidence(cell_distance, outcome, evidence);
                changes.extend(map.multiply(cell, evidence));
            });
        }
        Update::Cause(parameters) => {
            let r = model.resolution();
            let explained =
                explain(model, parameters, map, (scan, novelty)).into_iter().enumerate();
            for (beam, (outcome, causes)) in explained.filter_map(|(b, e)| Some((b, e?))) {
                let reach = model.reach(outcome);
                model.footprint().for_each_cell(&grid, &scan.pose, beam, reach, |covered| {
                    let FootprintCell { cell, cell_distance, across } = covered;
                    let met = Met { cell_distance, across };
                    if causes.evidence(parameters, r, met, outcome, evidence) {
                        changes.extend(map.multiply(cell, evidence));
                    }
                });
            }
        }
    }
    merge(changes)
}

/// Integrates the robot's body as a contact sensor. Cells that lie entirely inside the area that
/// the disc of `radius` \[m\] sweeps from `from` to `to` are free and stay so, because the robot
/// touched nothing there. Returns the changes, in row-major order.
///
/// Choice: the paper has no contact sensor. The worlds are static, so that nothing can come to a
/// place where the robot stood.
pub fn integrate_body(
    map: &mut CoverageMap,
    from: Point2<f64>,
    to: Point2<f64>,
    radius: f64,
) -> Vec<Change> {
    let grid = *map.grid();
    // The swept disc is convex: it holds a cell if it holds the corners.
    let is_inside = |cell: &Cell| {
        let corner = |(i, j): (i32, i32)| grid.lower_corner(cell.offset(i, j));
        let mut corners = [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().map(corner);
        corners.all(|corner| is_under_body(corner, from, to, radius))
    };
    let inside = cells_under_body(&grid, from, to, radius).into_iter().filter(is_inside);
    inside.filter_map(|cell| map.pin_free(cell)).collect()
}

/// Returns the cells of a grid with their centres under the disc of `radius` \[m\] somewhere on the
/// way from `from` to `to`, in row-major order.
pub fn cells_under_body(grid: &Grid, from: Point2<f64>, to: Point2<f64>, radius: f64) -> Vec<Cell> {
    let margin = Vector2::repeat(radius);
    let cells = grid.cells_between(from.inf(&to) - margin, from.sup(&to) + margin);
    cells.filter(|cell| is_under_body(grid.center(*cell), from, to, radius)).collect()
}

pub(crate) fn is_under_body(
    point: Point2<f64>,
    from: Point2<f64>,
    to: Point2<f64>,
    radius: f64,
) -> bool {
    let way = to - from;
    let along = (point - from).dot(&way) / way.norm_squared();
    let along = if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 };
    (point - (from + way * along)).norm() <= radius
}

/// Returns the cells that the readings of a scan intercept, with their distances from the sensor:
/// the cells that a beam passed through and those in which it ended.
///
/// # Panics
/// If the scan has not one reading for each beam of the model's ring.
pub fn intercepted(model: &SensorModel, grid: &Grid, scan: &Scan) -> Vec<(Cell, f64)> {
    let mut cells = Vec::new();
    model.for_each_covered(grid, scan, |cell, cell_distance, outcome| {
        let behind =
            matches!(outcome, Outcome::Echo(d) if cell_distance - d > 0.5 * model.resolution());
        if !behind {
            cells.push((cell, cell_distance));
        }
    });
    cells
}

/// Returns one change for each cell, in row-major order.
pub(crate) fn merge(mut changes: Vec<Change>) -> Vec<Change> {
    changes.sort_by_key(|change| change.cell);
    changes.dedup_by(|later, kept| {
        let same = later.cell == kept.cell;
        if same {
            kept.after = later.after;
        }
        same
    });
    changes
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tests compare exact values")]
mod tests {
    use super::*;
    use crate::ModelParameters;
    use covmap_sonar::{Range, SonarRing};
    use nalgebra::Isometry2;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn model() -> SensorModel {
        SensorModel::new(&ModelParameters::by_hand(), &SonarRing::b21r(), 0.1).unwrap()
    }

    fn empty_map() -> CoverageMap {
        let grid = Grid::new(Point2::new(-3.55, -3.55), 0.1, 71, 71).unwrap();
        CoverageMap::new(grid, 11).unwrap()
    }

    fn map_after(scans: &[Scan]) -> CoverageMap {
        let mut map = empty_map();
        scans.iter().for_each(|scan| {
            integrate(&model(), &mut map, scan);
        });
        map
    }

    fn a_range() -> impl Strategy<Value = Range> {
        prop_oneof![
            6 => (0.3..4.0f64).prop_map(Range::Echo),
            1 => Just(Range::NoEcho),
            1 => Just(Range::Missing),
        ]
    }

    fn a_scan() -> impl Strategy<Value = Scan> {
        let pose = (-0.5..0.5f64, -0.5..0.5f64, -PI..PI)
            .prop_map(|(x, y, heading)| Isometry2::new(Vector2::new(x, y), heading));
        (pose, prop::collection::vec(a_range(), 24)).prop_map(|(pose, ranges)| Scan {
            pose,
            time: 0.0,
            ranges,
        })
    }

    #[test]
    fn missing_readings_change_nothing() {
        let scan =
            Scan { pose: Isometry2::identity(), time: 0.0, ranges: vec![Range::Missing; 24] };
        assert_eq!(map_after(&[scan]), empty_map());
    }

    #[test]
    fn no_echo_marks_free_cells_up_to_its_range_and_no_end() {
        let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges: vec![Range::NoEcho; 24] };
        let map = map_after(&[scan]);
        let known: Vec<Cell> = map.grid().cells().filter(|c| map.is_known(*c)).collect();
        assert!(known.iter().all(|c| map.mode(*c) == 0.0));
        let far = |c: &Cell| (map.grid().center(*c)).coords.norm();
        let farthest = known.iter().map(far).fold(0.0, f64::max);
        assert!((1.1..=1.25).contains(&farthest), "{farthest}");
    }

    #[test]
    fn where_the_body_was_nothing_is() {
        let mut map = empty_map();
        let (from, to) = (Point2::new(0.0, 0.0), Point2::new(1.0, 0.0));
        let changes = integrate_body(&mut map, from, to, 0.27);
        assert!(changes.iter().all(|c| map.is_pinned(c.cell) && map.mode(c.cell) == 0.0));
        // Of the stadium's area π·.27² + .54 = .769 m² the cells that lie entirely inside.
        assert!((55..=70).contains(&changes.len()), "{}", changes.len());
        assert!(integrate_body(&mut map, from, to, 0.27).is_empty());
        assert!(integrate_body(&mut map, from, Point2::new(f64::NAN, 0.0), 0.27).is_empty());
    }

    proptest! {
        #[test]
        fn scan_order_does_not_matter(scans in prop::collection::vec(a_scan(), 2..4)) {
            let mut reversed = scans.clone();
            reversed.reverse();
            let (forth, back) = (map_after(&scans), map_after(&reversed));
            for cell in forth.grid().cells() {
                let (a, b) = (forth.histogram(cell), back.histogram(cell));
                for (a, b) in a.probabilities().iter().zip(b.probabilities()) {
                    prop_assert!((a - b).abs() < 1e-4, "{} {}", a, b);
                }
            }
        }

        #[test]
        fn a_turn_by_one_sensor_with_shifted_ranges_is_the_same_measurement(scan in a_scan()) {
            let mut turned = scan.clone();
            turned.pose.rotation *= nalgebra::UnitComplex::new(PI / 12.0);
            turned.ranges.rotate_left(1);
            let (a, b) = (map_after(&[scan]), map_after(&[turned]));
            for cell in a.grid().cells() {
                prop_assert!((a.entropy(cell) - b.entropy(cell)).abs() < 1e-6);
                prop_assert!((a.mean(cell) - b.mean(cell)).abs() < 1e-6);
            }
        }

        #[test]
        fn a_quarter_turn_rotates_the_map(ranges in prop::collection::vec(a_range(), 24)) {
            let scan = |heading| Scan { pose: Isometry2::rotation(heading), time: 0.0, ranges: ranges.clone() };
            let (a, b) = (map_after(&[scan(0.0)]), map_after(&[scan(FRAC_PI_2)]));
            for cell in a.grid().cells() {
                let rotated = Cell::new(70 - cell.y, cell.x);
                prop_assert!((a.mean(cell) - b.mean(rotated)).abs() < 1e-6, "{:?}", cell);
            }
        }

        #[test]
        fn what_changed_is_all_that_changed(scan in a_scan()) {
            let (mut map, before) = (empty_map(), empty_map());
            let changes = integrate(&model(), &mut map, &scan);
            prop_assert!(changes.windows(2).all(|pair| pair[0].cell < pair[1].cell));
            for cell in map.grid().cells() {
                match changes.iter().find(|c| c.cell == cell) {
                    Some(change) => {
                        prop_assert_eq!(change.before, before.entropy(cell));
                        prop_assert_eq!(change.after, map.entropy(cell));
                    }
                    None => prop_assert_eq!(map.histogram(cell), before.histogram(cell)),
                }
            }
        }
    }
}
