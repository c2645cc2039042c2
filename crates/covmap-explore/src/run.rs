//! The loop.

use crate::{Event, Mission, MissionError, Robot, standing_place};
use covmap::{Cell, Change, CoverageMap, Raster};
use covmap_model::{Body, BodyEvent, Looks, SensorModel};
use covmap_plan::{BodyEvidence, CellStatus, Decision, Planner, Promise, Reach, turns};
use covmap_sonar::{Drive, Range, Scan};
use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// No cell is open: the certificate says why of each.
    Explored,
    /// The budget of scans is spent, and something is still open.
    BudgetSpent,
    /// Nothing is open, but the robot could not leave the cell that it started in.
    StartBlocked,
    /// Nothing is open, but in the end the robot could reach no more than what one scan spends,
    /// or could not move at all.
    BoxedIn,
    /// Nothing is open, but no sensor answered in the whole run: there was not one echo.
    NothingHeard,
    /// Whoever watched the run stopped it.
    Interrupted,
}

/// What a run came to.
#[derive(Debug, Clone)]
pub struct Run {
    /// How it ended.
    pub ending: Ending,
    /// The belief.
    pub map: CoverageMap,
    /// What became of every cell.
    pub certificate: Raster<CellStatus>,
    /// What one more scan, from a place in reach, is expected to change about each cell.
    pub promises: Raster<Option<Promise>>,
    /// Where the robot could drive, as it saw it in the end.
    pub reach: Raster<Reach>,
    /// Every scan, in order.
    pub scans: Vec<Scan>,
    /// What the body told of the map, in order, each with the number of scans before it.
    pub body: Vec<(usize, BodyEvent)>,
    /// The corners of the driven path \[m\].
    pub trajectory: Vec<Point2<f64>>,
    /// Length of the path \[m\].
    pub path_length: f64,
    /// How many decisions were made.
    pub decisions: usize,
    /// Where the robot's centre was when it bumped into something \[m\].
    pub bumped_at: Vec<Point2<f64>>,
    /// How many candidates had a negative expected information gain, over all decisions.
    pub negative_gains: usize,
    /// How many scans were counted for each cell: those that should have told something
    /// about it while it was unfinished.
    pub counts: Raster<u32>,
    /// How many cells were given up by the cap on counted scans.
    pub capped_cells: usize,
}

impl Run {
    /// How far the robot turned on its way: the angles between one piece of the path and the next, each
    /// at most π, summed up \[rad\].
    pub fn turns(&self) -> f64 {
        turns(self.trajectory.windows(2).map(|ends| ends[1] - ends[0]))
    }

    /// The most that one more scan is expected to lower the entropy of some cell of a status by
    /// \[nats\]; `None` if there is none, or nothing is known of that.
    pub fn most_promised(&self, status: CellStatus) -> Option<f64> {
        let of = self.certificate.iter().filter(|(_, is)| **is == status);
        let change = |(cell, _): (Cell, &CellStatus)| Some((*self.promises.get(cell)?)?.change);
        of.filter_map(change).reduce(f64::max)
    }
}

/// What can be looked at while a run goes on.
#[derive(Debug)]
pub struct View<'a> {
    /// The belief.
    pub map: &'a CoverageMap,
    /// The planner.
    pub planner: &'a Planner,
    /// How many scans there were.
    pub scans: usize,
    /// Length of the path so far \[m\].
    pub path_length: f64,
    /// The corners of the path so far \[m\].
    pub trajectory: &'a [Point2<f64>],
}

/// Explores until nothing is open, the budget is spent, or the hook says stop.
///
/// The hook sees every event when it happens: a scan after it is integrated, a decision
/// before it is carried out. The run is a function of the mission and of what the robot
/// senses.
///
/// # Errors
/// If the mission's configuration is invalid, or [`Mission::validate`] finds something.
pub fn explore<R: Robot>(
    mission: &Mission,
    robot: &mut R,
    hook: &mut impl FnMut(&Event, &View<'_>) -> ControlFlow<()>,
) -> Result<Run, MissionError> {
    let mut explorer = Explorer::new(mission, robot, hook)?;
    let ending = match explorer.run() {
        ControlFlow::Continue(ending) => ending,
        ControlFlow::Break(()) => Ending::Interrupted,
    };
    let _ = explorer.report(Event::End { ending });
    Ok(explorer.finish(ending))
}

struct Explorer<'a, R, H> {
    mission: &'a Mission,
    robot: &'a mut R,
    hook: &'a mut H,
    model: SensorModel,
    looks: Looks,
    map: CoverageMap,
    body: Body,
    planner: Planner,
    at: Point2<f64>,
    cell: Cell,
    left_start: bool,
    /// The robot stands where a step ends: not yet, at a start that is off its cell's centre.
    settled: bool,
    /// The robot does not get to the centre of the cell that it started in: the start itself
    /// stands for it.
    cramped: bool,
    /// How far the robot drove since it last measured [m].
    since_scan: f64,
    scans: Vec<Scan>,
    happened: Vec<(usize, BodyEvent)>,
    trajectory: Vec<Point2<f64>>,
    path_length: f64,
    decisions: usize,
    bumped_at: Vec<Point2<f64>>,
    negative_gains: usize,
}

impl<'a, R: Robot, H: FnMut(&Event, &View<'_>) -> ControlFlow<()>> Explorer<'a, R, H> {
    fn new(mission: &'a Mission, robot: &'a mut R, hook: &'a mut H) -> Result<Self, MissionError> {
        mission.validate()?;
        let Mission { config, grid, outside, start, .. } = mission;
        let (_, model) = config.build()?;
        let planner = Planner::new(
            &config.planner,
            &model,
            outside,
            config.robot.radius,
            start.rotation.angle(),
        )
        .map_err(crate::ParameterError::from)?;
        let map = CoverageMap::new(*grid, config.model.bins)
            .map_err(|_| covmap_model::ModelError::Bins(config.model.bins))
            .map_err(crate::ParameterError::from)?;
        let at = Point2::from(start.translation.vector);
        let cell = grid.cell_at(at).ok_or(MissionError::StartOutside(at.x, at.y))?;
        Ok(Self {
            mission,
            robot,
            hook,
            looks: Looks::new(&model),
            model,
            map,
            body: Body::new(*grid, config.robot.radius),
            planner,
            at,
            cell,
            left_start: false,
            settled: false,
            cramped: false,
            since_scan: 0.0,
            scans: Vec::new(),
            happened: Vec::new(),
            trajectory: vec![at],
            path_length: 0.0,
            decisions: 0,
            bumped_at: Vec::new(),
            negative_gains: 0,
        })
    }

    fn run(&mut self) -> ControlFlow<(), Ending> {
        self.body_was_between(self.at, self.at);
        self.planner.stand_on(self.cell);
        self.scan()?;
        while let Some(decision) = self.planner.choose(&self.map, self.cell) {
            if self.is_budget_spent() {
                return ControlFlow::Continue(Ending::BudgetSpent);
            }
            let (path, stays) = (decision.path.clone(), decision.path.is_empty());
            self.decide(decision)?;
            if (self.drive(&path)? || stays) && !self.is_budget_spent() {
                self.scan()?;
            }
        }
        ControlFlow::Continue(self.ending())
    }

    /// How a run ended after which nothing is open.
    fn ending(&self) -> Ending {
        let answers = |scan: &Scan| scan.ranges.iter().any(|r| matches!(r, Range::Echo(_)));
        if !self.scans.iter().any(answers) {
            Ending::NothingHeard
        } else if !self.planner.is_confined(self.cell) {
            Ending::Explored
        } else if self.left_start {
            Ending::BoxedIn
        } else {
            Ending::StartBlocked
        }
    }

    fn is_budget_spent(&self) -> bool {
        self.mission.limits.max_scans.is_some_and(|most| self.scans.len() >= most)
    }

    fn place(&self, cell: Cell) -> Point2<f64> {
        let Mission { grid, start, .. } = self.mission;
        standing_place(grid, start.translation.vector.into(), self.cramped, cell)
    }

    fn decide(&mut self, decision: Decision) -> ControlFlow<()> {
        self.negative_gains += decision.negative_gains;
        let event = Event::Decision { number: self.decisions, from: self.cell, decision };
        self.decisions += 1;
        self.report(event)
    }

    fn scan(&mut self) -> ControlFlow<()> {
        let pose = Isometry2::new(self.at.coords, self.mission.start.rotation.angle());
        let time = self.path_length / self.mission.config.robot.speed;
        let scan = Scan { pose, time, ranges: self.robot.sense(&pose) };
        let changes = self.looks.integrate(&self.model, &mut self.map, &scan);
        let changes = self.body.hold(&mut self.map, changes);
        self.planner.observe(&self.map, &scan, &changes);
        self.since_scan = 0.0;
        self.scans.push(scan.clone());
        self.report(Event::Scan { number: self.scans.len() - 1, scan })
    }

    /// Drives from where it is over some cells; `false` if it bumped into something.
    fn drive(&mut self, path: &[Cell]) -> ControlFlow<(), bool> {
        if !self.settled {
            self.settled = true;
            self.cramped = !self.drive_straight(self.cell)?;
            if self.cramped {
                return ControlFlow::Continue(false);
            }
        }
        for cell in path {
            if !self.drive_straight(*cell)? {
                return ControlFlow::Continue(false);
            }
            self.left_start = true;
            self.planner.drove(self.cell, *cell);
            self.cell = *cell;
        }
        ControlFlow::Continue(true)
    }

    /// Drives to its place in a cell, measuring on the way if that is wanted. After a bump the
    /// robot backs to where it came from.
    fn drive_straight(&mut self, cell: Cell) -> ControlFlow<(), bool> {
        let (home, place) = (self.at, self.place(cell));
        loop {
            let left = (place - self.at).norm();
            let step = self
                .mission
                .limits
                .while_driving
                .map_or(f64::INFINITY, |every| every - self.since_scan);
            let measures = step < left;
            let goal =
                if measures { self.at + (place - self.at) * (step.max(0.0) / left) } else { place };
            match self.robot.drive(self.at, goal) {
                Drive::Arrived => self.advance(goal),
                Drive::Bumped { at } => {
                    self.advance(at);
                    self.bumped_at.push(at);
                    self.planner.bump(self.cell, cell, at);
                    self.body_touched(at, goal);
                    let event = Event::Bump { cell, at, towards: goal };
                    self.advance(home);
                    self.report(event)?;
                    return ControlFlow::Continue(false);
                }
            }
            if !measures {
                return ControlFlow::Continue(true);
            }
            if !self.is_budget_spent() {
                self.scan()?;
            }
            self.since_scan = 0.0;
        }
    }

    fn advance(&mut self, to: Point2<f64>) {
        let length = (to - self.at).norm();
        if length > 0.0 {
            self.path_length += length;
            self.since_scan += length;
            self.body_was_between(self.at, to);
            self.trajectory.push(to);
            self.at = to;
        }
    }

    fn body_was_between(&mut self, from: Point2<f64>, to: Point2<f64>) {
        let changes = self.believe_the_body(BodyEvent::Moved { from, to });
        self.planner.body_moved(&self.map, from, to, &changes.unwrap_or_default());
    }

    /// The body stopped at something on its way to a goal.
    fn body_touched(&mut self, at: Point2<f64>, goal: Point2<f64>) {
        if let Some(changes) =
            self.believe_the_body(BodyEvent::Touched { at, direction: goal - at })
        {
            self.planner.body_moved(&self.map, at, at, &changes);
        }
    }

    /// What changed in the map by what happened to the body; `None` if that is no evidence.
    fn believe_the_body(&mut self, event: BodyEvent) -> Option<Vec<Change>> {
        let believes = self.mission.config.planner.body_evidence == BodyEvidence::Belief;
        believes.then(|| {
            self.happened.push((self.scans.len(), event));
            self.body.happened(&mut self.map, &event)
        })
    }

    fn report(&mut self, event: Event) -> ControlFlow<()> {
        let view = View {
            map: &self.map,
            planner: &self.planner,
            scans: self.scans.len(),
            path_length: self.path_length,
            trajectory: &self.trajectory,
        };
        (self.hook)(&event, &view)
    }

    fn finish(mut self, ending: Ending) -> Run {
        Run {
            ending,
            certificate: self.planner.certificate(&self.map, self.cell),
            promises: self.planner.promises_of(self.cell),
            reach: self.planner.reach(self.cell),
            counts: self.planner.counted_scans(),
            map: self.map,
            scans: self.scans,
            body: self.happened,
            trajectory: self.trajectory,
            path_length: self.path_length,
            decisions: self.decisions,
            bumped_at: self.bumped_at,
            negative_gains: self.negative_gains,
            capped_cells: self.planner.capped_cells(),
        }
    }
}
