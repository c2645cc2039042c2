//! The exploration loop.

use crate::{Ending, Event, Explorer, Mission, MissionError, Robot, Sensed, standing_place};
use covmap::{Cell, CoverageMap, Raster};
use covmap_model::BodyEvent;
use covmap_plan::{CellStatus, Decision, Planner, Promise, Reach, Scoring, turns};
use covmap_sonar::{Drive, Range, Scan};
use nalgebra::{Isometry2, Point2};
use std::error::Error;
use std::ops::ControlFlow;

/// The result of a run.
#[derive(Debug, Clone)]
pub struct Run {
    /// The ending.
    pub ending: Ending,
    /// Reason why the robot failed, if it did.
    pub failure: Option<String>,
    /// The belief.
    pub map: CoverageMap,
    /// Status of each cell.
    pub certificate: Raster<CellStatus>,
    /// Largest expected change of each cell by one more scan from a place in reach.
    pub promises: Raster<Option<Promise>>,
    /// Whether the robot could drive to each cell, by its belief at the end.
    pub reach: Raster<Reach>,
    /// Every scan, in order.
    pub scans: Vec<Scan>,
    /// Events of the body in the belief, in order, each with the number of scans before it.
    pub body: Vec<(usize, BodyEvent)>,
    /// The corners of the driven path \[m\].
    pub trajectory: Vec<Point2<f64>>,
    /// Length of the path \[m\].
    pub path_length: f64,
    /// The number of decisions.
    pub decisions: usize,
    /// Places of the robot's centre when it bumped into something \[m\].
    pub bumped_at: Vec<Point2<f64>>,
    /// The number of candidates with a negative expected information gain, over all decisions.
    pub negative_gains: usize,
    /// The number of scans counted for each cell: those expected to tell something about the cell while
    /// it was unfinished.
    pub counts: Raster<u32>,
    /// The number of cells given up by the cap on counted scans.
    pub capped_cells: usize,
}

impl Run {
    /// Returns the sum of the robot's turns \[rad\]: the angles between each piece of the path and the next,
    /// at most π each.
    pub fn turns(&self) -> f64 {
        turns(self.trajectory.windows(2).map(|ends| ends[1] - ends[0]))
    }

    /// Returns the largest expected fall of a cell's entropy by one more scan, among the cells of a status
    /// \[nats\]; `None` if there is no such cell, or none with a promise.
    pub fn most_promised(&self, status: CellStatus) -> Option<f64> {
        let of = self.certificate.iter().filter(|(_, is)| **is == status);
        let change = |(cell, _): (Cell, &CellStatus)| Some((*self.promises.get(cell)?)?.change);
        of.filter_map(change).reduce(f64::max)
    }
}

/// The state of a run that goes on, for its hook.
#[derive(Debug)]
pub struct View<'a> {
    /// The belief.
    pub map: &'a CoverageMap,
    /// The planner.
    pub planner: &'a Planner,
    /// The number of scans so far.
    pub scans: usize,
    /// Length of the path so far \[m\].
    pub path_length: f64,
    /// The corners of the path so far \[m\].
    pub trajectory: &'a [Point2<f64>],
}

/// Explores until no cell is open, the budget is spent, the hook stops the run, or the robot fails.
///
/// The hook receives every event when it happens: a scan after it is integrated, a decision
/// before it is carried out. The run is a function of the mission and of the results of the robot's
/// [`sense`](Robot::sense) and [`drive`](Robot::drive).
///
/// # Errors
/// If the mission's parameters are invalid, or [`Mission::validate`] fails.
pub fn explore<R: Robot>(
    mission: &Mission,
    robot: &mut R,
    hook: &mut impl FnMut(&Event, &View<'_>) -> ControlFlow<()>,
) -> Result<Run, MissionError> {
    Circle::new(mission, robot, hook, None)?.finished()
}

/// Explores with the caller's own strategy, which scores the candidates of every decision: see [`Scoring`].
/// The run ends when the strategy scores no candidate above −∞.
///
/// # Errors
/// As [`explore`].
pub fn explore_by<R: Robot>(
    mission: &Mission,
    robot: &mut R,
    hook: &mut impl FnMut(&Event, &View<'_>) -> ControlFlow<()>,
    strategy: &mut dyn Scoring,
) -> Result<Run, MissionError> {
    Circle::new(mission, robot, hook, Some(strategy))?.finished()
}

/// Reason why a run stops.
enum Stop {
    /// The hook stopped it.
    ByHook,
    /// The robot failed, for this reason.
    Failed(String),
}

/// The result of a part of a run, or the reason to stop.
type Flow<T = ()> = ControlFlow<Stop, T>;

/// Continues with the robot's result, or stops with the reason why it failed.
fn done<T, E: Error>(result: Result<T, E>) -> Flow<T> {
    match result {
        Ok(value) => ControlFlow::Continue(value),
        Err(error) => ControlFlow::Break(Stop::Failed(error.to_string())),
    }
}

/// The loop: sense, integrate, choose, drive.
struct Circle<'a, R, H> {
    mission: &'a Mission,
    robot: &'a mut R,
    hook: &'a mut H,
    strategy: Option<&'a mut dyn Scoring>,
    explorer: Explorer,
    left_start: bool,
    /// Whether the robot stands where a step ends; not so at a start off its cell's centre, nor where it
    /// was stopped or drifted to.
    settled: bool,
    /// Whether the robot cannot get to the centre of the cell that it started in: the start itself
    /// replaces the centre.
    cramped: bool,
    /// Distance that the robot drove since the last scan [m].
    since_scan: f64,
    scans: Vec<Scan>,
    trajectory: Vec<Point2<f64>>,
    path_length: f64,
    decisions: usize,
    bumped_at: Vec<Point2<f64>>,
    negative_gains: usize,
}

impl<'a, R: Robot, H: FnMut(&Event, &View<'_>) -> ControlFlow<()>> Circle<'a, R, H> {
    fn new(
        mission: &'a Mission,
        robot: &'a mut R,
        hook: &'a mut H,
        strategy: Option<&'a mut dyn Scoring>,
    ) -> Result<Self, MissionError> {
        let explorer = Explorer::new(mission)?;
        Ok(Self {
            trajectory: vec![explorer.at()],
            mission,
            robot,
            hook,
            strategy,
            explorer,
            left_start: false,
            settled: false,
            cramped: false,
            since_scan: 0.0,
            scans: Vec::new(),
            path_length: 0.0,
            decisions: 0,
            bumped_at: Vec::new(),
            negative_gains: 0,
        })
    }

    fn finished(mut self) -> Result<Run, MissionError> {
        let (ending, failure) = match self.run() {
            ControlFlow::Continue(ending) => (ending, None),
            ControlFlow::Break(Stop::ByHook) => (Ending::Interrupted, None),
            ControlFlow::Break(Stop::Failed(reason)) => (Ending::RobotFailed, Some(reason)),
        };
        let _ = self.report(Event::End { ending });
        Ok(self.finish(ending, failure))
    }

    fn next(&mut self) -> Option<Decision> {
        match &mut self.strategy {
            None => self.explorer.decide(),
            Some(own) => self.explorer.decide_by(&mut **own),
        }
    }

    fn run(&mut self) -> Flow<Ending> {
        self.scan()?;
        while let Some(decision) = self.next() {
            if self.is_budget_spent() {
                return ControlFlow::Continue(Ending::BudgetSpent);
            }
            let (path, stays) = (decision.path.clone(), decision.path.is_empty());
            self.decide(decision)?;
            let arrives = self.drive(&path)?;
            if (stays || arrives) && !self.is_budget_spent() {
                self.scan()?;
            }
        }
        ControlFlow::Continue(self.ending())
    }

    /// The ending of a run after which no cell is open.
    fn ending(&self) -> Ending {
        let answers = |scan: &Scan| scan.ranges.iter().any(|r| matches!(r, Range::Echo(_)));
        if !self.scans.iter().any(answers) {
            Ending::NothingHeard
        } else if !self.explorer.is_confined() {
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

    fn decide(&mut self, decision: Decision) -> Flow {
        self.negative_gains += decision.negative_gains;
        let from = self.explorer.cell();
        let event = Event::Decision { number: self.decisions, from, decision };
        self.decisions += 1;
        self.report(event)
    }

    fn scan(&mut self) -> Flow {
        let heading = self.mission.start.rotation.angle();
        let expected = Isometry2::new(self.explorer.at().coords, heading);
        let Sensed { pose, ranges } = done(self.robot.sense(&expected))?;
        if pose.translation != expected.translation {
            self.drifted(pose.translation.vector.into())?;
        }
        let time = self.path_length / self.mission.config.robot.speed;
        let scan = Scan { pose, time, ranges };
        done(self.explorer.see(&scan))?;
        self.since_scan = 0.0;
        self.scans.push(scan.clone());
        self.report(Event::Scan { number: self.scans.len() - 1, scan })
    }

    /// Takes note that the robot is not at the expected place.
    fn drifted(&mut self, to: Point2<f64>) -> Flow {
        let Some(cell) = self.explorer.grid().cell_at(to) else {
            let reason = format!("the robot is outside of the map, at ({}, {})", to.x, to.y);
            return ControlFlow::Break(Stop::Failed(reason));
        };
        self.advance(to);
        if cell != self.explorer.cell() {
            self.explorer.found_itself(cell);
        }
        self.settled = false;
        ControlFlow::Continue(())
    }

    /// Drives over some cells; `false` if the robot did not get to the last one.
    fn drive(&mut self, path: &[Cell]) -> Flow<bool> {
        if !self.settled {
            self.settled = true;
            let arrives = self.drive_straight(self.explorer.cell())?;
            if !arrives {
                self.cramped |= !self.left_start;
                return ControlFlow::Continue(false);
            }
        }
        for cell in path {
            if !self.drive_straight(*cell)? {
                return ControlFlow::Continue(false);
            }
            self.left_start = true;
            self.explorer.arrived(*cell);
        }
        ControlFlow::Continue(true)
    }

    /// Drives to the robot's place in a cell, with scans on the way if the mission asks for them; `false` if
    /// the robot did not get there. After a bump it backs to where it came from.
    fn drive_straight(&mut self, cell: Cell) -> Flow<bool> {
        let (home, place) = (self.explorer.at(), self.place(cell));
        loop {
            let at = self.explorer.at();
            let left = (place - at).norm();
            let step = self
                .mission
                .limits
                .while_driving
                .map_or(f64::INFINITY, |every| every - self.since_scan);
            let measures = step < left;
            let goal = if measures { at + (place - at) * (step.max(0.0) / left) } else { place };
            match done(self.robot.drive(at, goal))? {
                Drive::Arrived => self.advance(goal),
                Drive::Bumped { at } => {
                    self.advance(at);
                    self.bumped_at.push(at);
                    self.explorer.bumped(cell, goal);
                    let event = Event::Bump { cell, at, towards: goal };
                    self.advance(home);
                    self.report(event)?;
                    return ControlFlow::Continue(false);
                }
                Drive::Stopped { at } => {
                    self.drifted(at)?;
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
        let length = (to - self.explorer.at()).norm();
        if length > 0.0 {
            self.path_length += length;
            self.since_scan += length;
            self.explorer.moved(to);
            self.trajectory.push(to);
        }
    }

    fn report(&mut self, event: Event) -> Flow {
        let view = View {
            map: self.explorer.map(),
            planner: self.explorer.planner(),
            scans: self.scans.len(),
            path_length: self.path_length,
            trajectory: &self.trajectory,
        };
        match (self.hook)(&event, &view) {
            ControlFlow::Continue(()) => ControlFlow::Continue(()),
            ControlFlow::Break(()) => ControlFlow::Break(Stop::ByHook),
        }
    }

    fn finish(mut self, ending: Ending, failure: Option<String>) -> Run {
        let (certificate, promises) = (self.explorer.certificate(), self.explorer.promises());
        let (reach, planner) = (self.explorer.reach(), self.explorer.planner());
        let (counts, capped_cells) = (planner.counted_scans(), planner.capped_cells());
        let (map, body) = self.explorer.into_belief();
        Run {
            ending,
            failure,
            map,
            certificate,
            promises,
            reach,
            scans: self.scans,
            body,
            trajectory: self.trajectory,
            path_length: self.path_length,
            decisions: self.decisions,
            bumped_at: self.bumped_at,
            negative_gains: self.negative_gains,
            counts,
            capped_cells,
        }
    }
}
