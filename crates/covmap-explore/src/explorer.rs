//! The explorer: a robot's belief and planner, kept in step.

use crate::{Mission, MissionError, ParameterError};
use covmap::{Cell, Change, CoverageMap, Grid, Raster};
use covmap_model::{Body, BodyEvent, Looks, ModelError, SensorModel};
use covmap_plan::{BodyEvidence, CellStatus, Decision, Planner, Promise, Reach, Scoring};
use covmap_sonar::Scan;
use nalgebra::Point2;

/// The belief of a robot and its planner, kept in step.
///
/// Belief and planner must take over the same events in the same order; an `Explorer` ensures this. The
/// caller reports every scan ([`see`](Self::see)), every stretch that the robot drove
/// ([`moved`](Self::moved)), every cell where it arrived ([`arrived`](Self::arrived)) and every bump
/// ([`bumped`](Self::bumped)), then asks where to measure next ([`decide`](Self::decide)).
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
/// let mission = Mission { config, grid, outside, start, limits: Limits::default(), explains: true };
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

/// Error of a scan that does not fit the explorer's ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a scan of {found} readings; the ring has {expected} beams")]
pub struct ScanError {
    /// The number of beams of the ring.
    pub expected: usize,
    /// The number of readings of the scan.
    pub found: usize,
}

impl Explorer {
    /// Returns the explorer of a robot at the start of a mission. The robot only knows that its body fits
    /// there.
    ///
    /// # Errors
    /// If a parameter is out of its interval, or [`Mission::validate`] fails.
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
        explorer.planner.explain(mission.explains);
        if let Some(every) = mission.limits.while_driving {
            explorer.planner.measure_while_driving(every);
        }
        explorer.moved(at);
        explorer.planner.stand_on(cell);
        Ok(explorer)
    }

    /// Takes over a scan of the robot.
    ///
    /// # Errors
    /// If the scan does not have one reading for each beam; the explorer is unchanged then.
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

    /// Takes note that the robot drove straight from where it was to a place \[m\], without contact.
    pub fn moved(&mut self, to: Point2<f64>) {
        let event = BodyEvent::Moved { from: self.at, to };
        let changes = self.believe(event).unwrap_or_default();
        self.planner.body_moved(&self.map, self.at, to, &changes);
        self.at = to;
    }

    /// Takes note that the robot came straight from its cell to another one, where it stands now.
    pub fn arrived(&mut self, cell: Cell) {
        self.planner.drove(self.cell, cell);
        self.cell = cell;
    }

    /// Takes note that the robot stands in a cell, in whatever way it came there.
    pub fn found_itself(&mut self, cell: Cell) {
        self.planner.stand_on(cell);
        self.cell = cell;
    }

    /// Takes note that the robot, where it is now, touched something on its way straight from its cell to
    /// another one, as it drove towards a place \[m\].
    pub fn bumped(&mut self, to: Cell, towards: Point2<f64>) {
        let at = self.at;
        self.planner.bump(self.cell, to, at);
        if let Some(changes) = self.believe(BodyEvent::Touched { at, direction: towards - at }) {
            self.planner.body_moved(&self.map, at, at, &changes);
        }
    }

    /// The changes of the map by an event of the body; `None` if the body is no evidence.
    fn believe(&mut self, event: BodyEvent) -> Option<Vec<Change>> {
        self.body_is_evidence.then(|| {
            self.happened.push((self.scans, event));
            self.body.happened(&mut self.map, &event)
        })
    }

    /// Chooses the next view-point, with the way there and the reason; `None` if nothing is left to measure.
    pub fn decide(&mut self) -> Option<Decision> {
        self.planner.choose(&self.map, self.cell)
    }

    /// Decides by the caller's own strategy: see [`Planner::choose_by`].
    pub fn decide_by(&mut self, strategy: &mut dyn Scoring) -> Option<Decision> {
        self.planner.choose_by(&self.map, self.cell, strategy)
    }

    /// Returns the belief.
    pub fn map(&self) -> &CoverageMap {
        &self.map
    }

    /// Returns the planner.
    pub fn planner(&self) -> &Planner {
        &self.planner
    }

    /// Returns the grid of the map.
    pub fn grid(&self) -> &Grid {
        self.map.grid()
    }

    /// Returns the place of the robot \[m\].
    pub fn at(&self) -> Point2<f64> {
        self.at
    }

    /// Returns the robot's cell, where its paths begin.
    pub fn cell(&self) -> Cell {
        self.cell
    }

    /// Returns the number of scans taken over.
    pub fn scans(&self) -> usize {
        self.scans
    }

    /// Whether the robot is shut in: see [`Planner::is_confined`].
    pub fn is_confined(&self) -> bool {
        self.planner.is_confined(self.cell)
    }

    /// Returns the status of each cell.
    pub fn certificate(&mut self) -> Raster<CellStatus> {
        self.planner.certificate(&self.map, self.cell)
    }

    /// Returns the largest expected change of each cell by one more scan from a place in reach.
    pub fn promises(&mut self) -> Raster<Option<Promise>> {
        self.planner.promises_of(self.cell)
    }

    /// Returns for each cell whether the robot can drive there.
    pub fn reach(&self) -> Raster<Reach> {
        self.planner.reach(self.cell)
    }

    /// The belief, and the events of the body in it, in order, each with the number of scans before it.
    pub(crate) fn into_belief(self) -> (CoverageMap, Vec<(usize, BodyEvent)>) {
        (self.map, self.happened)
    }
}
