//! A corridor that is one cell wide, and a planner that gets to know it cell by cell.

use covmap::{Cell, Change, CoverageMap, Grid, Raster};
use covmap_model::{
    FootprintRule, Linear, ModelParameters, NoEchoParameters, ProductParameters, SensorModel,
    Update,
};
use covmap_plan::{
    CellStatus, Decision, Planner, PlannerParameters, Reason, Scope, StallRule, Strategy,
};
use covmap_sonar::{Beam, Range, Scan, SonarRing};
use nalgebra::{Isometry2, Point2};

/// A place outside of the grid: a body there is over no cell.
const NOWHERE: Point2<f64> = Point2::new(-1e3, -1e3);

/// A robot in a corridor of cells of 1 m. Its sensors are rays from its centre.
#[derive(Clone)]
pub(crate) struct Corridor {
    pub(crate) map: CoverageMap,
    pub(crate) planner: Planner,
    beams: usize,
}

/// A model with two bins that takes no echo as free space up to `range` [m].
pub(crate) fn two_bins(range: f64) -> ModelParameters {
    ModelParameters {
        bins: 2,
        usable_range: range,
        footprint: FootprintRule::Cones { half_angle: 0.0 },
        update: Update::Product(ProductParameters {
            sigma_out: Linear { base: 0.5, per_cell_distance: 0.0, per_range: 0.0 },
            sigma_in: 0.6,
            gamma: Linear { base: 0.1, per_cell_distance: 0.0, per_range: 0.0 },
            behind: 0.0,
            no_echo: NoEchoParameters { range, gamma: 0.2 },
            tempering: 1.0,
        }),
    }
}

/// Parameters with which the robot may measure from every view-point again and tries no passage, the
/// first stall exhausts a cell, and ε = .1.
pub(crate) fn plain(strategy: Strategy) -> PlannerParameters {
    PlannerParameters {
        strategy,
        count_scope: Scope::Observable,
        reason: Reason::InSight,
        entropy_threshold: 0.1,
        scan_spacing: 0.0,
        turn_cost: 0.0,
        passage_length: 0.0,
        stall_rule: StallRule::Unbanded,
        ..PlannerParameters::standard()
    }
}

impl Corridor {
    /// A corridor with `cells` unknown cells; `directions` are those of the rays [degrees].
    pub(crate) fn new(
        cells: usize,
        directions: &[f64],
        model: &ModelParameters,
        parameters: &PlannerParameters,
    ) -> Self {
        Self::build(cells, directions, model, parameters, 0.3, |_| false)
    }

    /// The same with a robot of this radius [m], and with columns outside of the environment.
    pub(crate) fn build(
        cells: usize,
        directions: &[f64],
        model: &ModelParameters,
        parameters: &PlannerParameters,
        radius: f64,
        outside: impl Fn(i32) -> bool,
    ) -> Self {
        let beam = |degrees: &f64| Beam {
            pose: Isometry2::rotation(degrees.to_radians()),
            half_angle: 0.1,
            min_range: 0.0,
            max_range: 10.0,
        };
        let ring = SonarRing::new(directions.iter().map(beam).collect()).unwrap();
        let model = SensorModel::new(model, &ring, 1.0).unwrap();
        let grid = Grid::new(Point2::origin(), 1.0, cells, 1).unwrap();
        let outside = Raster::from_fn(grid, |cell| outside(cell.x));
        let planner = Planner::new(parameters, &model, &outside, radius, 0.0).unwrap();
        let map = CoverageMap::new(grid, model.parameters().bins).unwrap();
        Self { map, planner, beams: directions.len() }
    }

    /// Gives a cell a posterior; returns the change, which the planner does not know of yet.
    fn set(&mut self, x: i32, posterior: &[f64]) -> Option<Change> {
        let mut before = vec![0.0; posterior.len()];
        self.map.read_posterior(Cell::new(x, 0), &mut before);
        let evidence: Vec<f64> = posterior.iter().zip(before).map(|(p, b)| p / b).collect();
        self.map.multiply(Cell::new(x, 0), &evidence)
    }

    /// Gives a cell this posterior, and tells the planner.
    pub(crate) fn know(&mut self, x: i32, posterior: &[f64]) {
        let change = self.set(x, posterior);
        self.planner.body_moved(&self.map, NOWHERE, NOWHERE, change.as_slice());
    }

    /// Makes all cells but the `unknown` ones free for sure.
    pub(crate) fn free_but(&mut self, unknown: &[i32]) {
        let cells: Vec<Cell> = self.map.grid().cells().collect();
        let sure = |bins| (0..bins).map(|bin| if bin == 0 { 1.0 } else { 1e-4 }).collect();
        let posterior: Vec<f64> = sure(self.map.bins());
        for cell in cells.into_iter().filter(|cell| !unknown.contains(&cell.x)) {
            self.know(cell.x, &posterior);
        }
    }

    /// Takes a scan from a cell, after which another cell has the entropy `after` [nats] (of two bins)
    /// and is rather free.
    pub(crate) fn look(&mut self, from: i32, at: i32, after: f64) {
        let p = likelier(after);
        let change = self.set(at, &[p, 1.0 - p]);
        self.scan(from, change.as_slice());
    }

    /// Takes a scan from a cell that changes nothing.
    pub(crate) fn look_in_vain(&mut self, from: i32) {
        self.scan(from, &[]);
    }

    fn scan(&mut self, from: i32, changes: &[Change]) {
        self.observe(from, &vec![Range::Missing; self.beams], changes);
    }

    /// Takes a scan from a cell with these readings and changes.
    pub(crate) fn observe(&mut self, from: i32, ranges: &[Range], changes: &[Change]) {
        let at = self.map.grid().center(Cell::new(from, 0));
        let pose = Isometry2::new(at.coords, 0.0);
        let scan = Scan { pose, time: 0.0, ranges: ranges.to_vec() };
        self.planner.observe(&self.map, &scan, changes);
    }

    /// The columns of L(c) for a robot in a cell.
    pub(crate) fn candidates(&mut self, from: i32) -> Vec<i32> {
        let table = self.planner.candidate_table(&self.map, Cell::new(from, 0));
        table.iter().map(|record| record.cell.x).collect()
    }

    pub(crate) fn choose(&mut self, from: i32) -> Option<Decision> {
        self.planner.choose(&self.map, Cell::new(from, 0))
    }

    /// The chosen column; −1 if none is chosen.
    pub(crate) fn target(&mut self, from: i32) -> i32 {
        self.choose(from).map_or(-1, |decision| decision.target.x)
    }

    pub(crate) fn status(&mut self, from: i32, x: i32) -> CellStatus {
        let certificate = self.planner.certificate(&self.map, Cell::new(from, 0));
        *certificate.get(Cell::new(x, 0)).unwrap()
    }

    /// The number of scans counted for a cell.
    pub(crate) fn counted(&self, x: i32) -> u32 {
        *self.planner.counted_scans().get(Cell::new(x, 0)).unwrap()
    }

    /// V(l): columns and distances.
    pub(crate) fn in_sight(&mut self, from: i32) -> Vec<(i32, f32)> {
        let cells = self.planner.cells_in_sight(Cell::new(from, 0));
        cells.iter().map(|&(x, distance)| (i32::try_from(x).unwrap(), distance)).collect()
    }
}

/// The probability of the likelier of two bins with this entropy [nats], by bisection.
fn likelier(entropy: f64) -> f64 {
    let (mut low, mut high) = (0.5f64, 1.0 - 1e-12);
    for _ in 0..60 {
        let p = 0.5 * (low + high);
        let h = -p * libm::log(p) - (1.0 - p) * libm::log(1.0 - p);
        (low, high) = if h > entropy { (p, high) } else { (low, p) };
    }
    low
}
