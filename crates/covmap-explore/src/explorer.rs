//! A robot's belief and its plans, kept in step.

use crate::{Mission, MissionError, ParameterError};
use covmap::{Cell, Change, CoverageMap, Grid, Raster};
use covmap_model::{Body, BodyEvent, Looks, ModelError, SensorModel};
use covmap_plan::{BodyEvidence, CellStatus, Decision, Planner, Promise, Reach, Scoring};
use covmap_sonar::Scan;
use nalgebra::Point2;

/// The belief of a robot and the planner that reads it, with one way to tell both what happened.
///
/// Belief and planner must hear of the same things in the same order; with an `Explorer` they do. Tell it of
/// every scan ([`see`](Self::see)), of every stretch that the robot drove ([`moved`](Self::moved)), of every
/// cell that it came to ([`arrived`](Self::arrived)) and of every bump ([`bumped`](Self::bumped)), then ask
/// it where to measure next ([`decide`](Self::decide)).
///
/// ```
/// use covmap_explore::{Explorer, Limits, Mission, Parameters, RobotParameters};
/// # use covmap::{Grid, Raster};
/// # use covmap_model::ModelParameters;
/// # use covmap_plan::PlannerParameters;
/// # use covmap_sonar::{Range, RingSpecification, Scan};
/// # use nalgebra::{Isometry2, Point2};
/// let robot = RobotParameters { radius: 0.27, speed: 0.5, ring: RingSpecification::B21r };
/// let (model, planner) = (ModelParameters::b21r(), PlannerParameters::standard());
/// let config = Parameters { resolution: 0.2, robot, model, planner };
/// let grid = Grid::new(Point2::origin(), 0.2, 20, 20)?;
/// let (outside, start) = (Raster::filled(grid, false), Isometry2::translation(2.1, 2.1));
/// let mission = Mission { config, grid, outside, start, limits: Limits::default() };
///
/// let mut explorer = Explorer::new(&mission)?;
/// explorer.see(&Scan { pose: start, time: 0.0, ranges: vec![Range::Echo(1.5); 24] })?;
/// if let Some(decision) = explorer.decide() {
///     for cell in decision.path {
///         // Drive there; then:
///         explorer.moved(grid.center(cell));
///         explorer.arrived(cell);
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Explorer {
    model: SensorModel,
    looks: Looks,
    map: CoverageMap,
    body: Body,
    planner: Planner,
    body_is_evidence: bool,
    at: Point2<f64>,
    cell: Cell,
    beams: usize,
    scans: usize,
    happened: Vec<(usize, BodyEvent)>,
}

/// A scan that is not one of the explorer's ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a scan of {found} readings; the ring has {expected} beams")]
pub struct ScanError {
    /// How many beams the ring has.
    pub expected: usize,
    /// How many readings the scan has.
    pub found: usize,
}

impl Explorer {
    /// A robot at the start of a mission. It knows nothing yet, but that its body fits where it is.
    ///
    /// # Errors
    /// If a parameter is out of its interval, or [`Mission::validate`] finds something.
    pub fn new(mission: &Mission) -> Result<Self, MissionError> {
        mission.validate()?;
        let Mission { config, grid, outside, start, .. } = mission;
        let (ring, model) = config.build()?;
        let (radius, heading) = (config.robot.radius, start.rotation.angle());
        let planner = Planner::new(&config.planner, &model, outside, radius, heading)
            .map_err(ParameterError::from)?;
        let bins = config.model.bins;
        let map = CoverageMap::new(*grid, bins)
            .map_err(|_| ParameterError::from(ModelError::Bins(bins)))?;
        let at = Point2::from(start.translation.vector);
        let cell = grid.cell_at(at).ok_or(MissionError::StartOutside(at.x, at.y))?;
        let mut explorer = Self {
            looks: Looks::new(&model),
            model,
            map,
            body: Body::new(*grid, radius),
            planner,
            body_is_evidence: config.planner.body_evidence == BodyEvidence::Belief,
            at,
            cell,
            beams: ring.beams().len(),
            scans: 0,
            happened: Vec::new(),
        };
        if mission.limits.while_driving.is_some() {
            explorer.planner.measure_while_driving();
        }
        explorer.moved(at);
        explorer.planner.stand_on(cell);
        Ok(explorer)
    }

    /// The robot measured.
    ///
    /// # Errors
    /// If the scan has not one reading for each beam; nothing is changed then.
    pub fn see(&mut self, scan: &Scan) -> Result<(), ScanError> {
        let (expected, found) = (self.beams, scan.ranges.len());
        if found != expected {
            return Err(ScanError { expected, found });
        }
        let changes = self.looks.integrate(&self.model, &mut self.map, scan);
        let changes = self.body.hold(&mut self.map, changes);
        self.planner.observe(&self.map, scan, &changes);
        self.scans += 1;
        Ok(())
    }

    /// The robot drove straight from where it was to a place \[m\], and touched nothing.
    pub fn moved(&mut self, to: Point2<f64>) {
        let event = BodyEvent::Moved { from: self.at, to };
        let changes = self.believe(event).unwrap_or_default();
        self.planner.body_moved(&self.map, self.at, to, &changes);
        self.at = to;
    }

    /// The robot came straight from the cell where it was to another one, and stands there now.
    pub fn arrived(&mut self, cell: Cell) {
        self.planner.drove(self.cell, cell);
        self.cell = cell;
    }

    /// The robot stands in a cell, however it came there.
    pub fn found_itself(&mut self, cell: Cell) {
        self.planner.stand_on(cell);
        self.cell = cell;
    }

    /// Where it is, the robot touched something on its way from its cell straight to another one, when it
    /// drove towards a place \[m\].
    pub fn bumped(&mut self, to: Cell, towards: Point2<f64>) {
        let at = self.at;
        self.planner.bump(self.cell, to, at);
        if let Some(changes) = self.believe(BodyEvent::Touched { at, direction: towards - at }) {
            self.planner.body_moved(&self.map, at, at, &changes);
        }
    }

    /// What changed in the map by what happened to the body; `None` if that is no evidence.
    fn believe(&mut self, event: BodyEvent) -> Option<Vec<Change>> {
        self.body_is_evidence.then(|| {
            self.happened.push((self.scans, event));
            self.body.happened(&mut self.map, &event)
        })
    }

    /// The next view-point, the way there and the reason; `None` if nothing is open.
    pub fn decide(&mut self) -> Option<Decision> {
        self.planner.choose(&self.map, self.cell)
    }

    /// The same by a strategy of one's own: see [`Planner::choose_by`].
    pub fn decide_by(&mut self, strategy: &mut dyn Scoring) -> Option<Decision> {
        self.planner.choose_by(&self.map, self.cell, strategy)
    }

    /// The belief.
    pub fn map(&self) -> &CoverageMap {
        &self.map
    }

    /// The planner.
    pub fn planner(&self) -> &Planner {
        &self.planner
    }

    /// The grid of the map.
    pub fn grid(&self) -> &Grid {
        self.map.grid()
    }

    /// Where the robot is \[m\].
    pub fn at(&self) -> Point2<f64> {
        self.at
    }

    /// The cell in which it stands: where its ways begin.
    pub fn cell(&self) -> Cell {
        self.cell
    }

    /// How many scans it saw.
    pub fn scans(&self) -> usize {
        self.scans
    }

    /// Whether the robot cannot get farther away than it is wide.
    pub fn is_confined(&self) -> bool {
        self.planner.is_confined(self.cell)
    }

    /// What became of every cell.
    pub fn certificate(&mut self) -> Raster<CellStatus> {
        self.planner.certificate(&self.map, self.cell)
    }

    /// What one more scan, from a place in reach, is expected to change about each cell.
    pub fn promises(&mut self) -> Raster<Option<Promise>> {
        self.planner.promises_of(self.cell)
    }

    /// Where the robot can drive.
    pub fn reach(&self) -> Raster<Reach> {
        self.planner.reach(self.cell)
    }

    /// The belief, and what the body told of it, in order, each with the number of scans before it.
    pub(crate) fn into_belief(self) -> (CoverageMap, Vec<(usize, BodyEvent)>) {
        (self.map, self.happened)
    }
}
