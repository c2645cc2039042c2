//! A robot that knows a part of a world, with a clock on its planner.

use crate::clock::Clock;
use anyhow::{Context, Result};
use covmap::{Cell, CoverageMap, Grid};
use covmap_explore::{Mission, Robot, Run};
use covmap_gain::{Stencil, expected_information_gain};
use covmap_lab::{Config, SimulatedRobot};
use covmap_model::{Looks, SensorModel, integrate_body};
use covmap_plan::{Decision, Planner};
use covmap_sonar::Drive;
use covmap_sonar::Scan;
use covmap_world::World;
use nalgebra::{Isometry2, Point2};

/// The seed of all noise.
pub(crate) const SEED: u64 = 1;

pub(crate) struct Situation<'a> {
    config: &'a Config,
    robot: SimulatedRobot<'a>,
    model: SensorModel,
    looks: Looks,
    stencil: Stencil,
    heading: f64,
    clock: Clock,
    grid: Grid,
    pub(crate) map: CoverageMap,
    pub(crate) planner: Planner,
    pub(crate) at: Cell,
}

impl<'a> Situation<'a> {
    /// Places a robot at the start of a mission; it plans by `config`.
    pub(crate) fn new(
        world: &'a World,
        mission: &Mission,
        config: &'a Config,
        clock: Clock,
    ) -> Result<Self> {
        let (_, model) = config.build()?;
        let heading = mission.start.rotation.angle();
        let (outside, radius) = (&mission.outside, config.robot.radius);
        let start = mission.grid.cell_at(mission.start.translation.vector.into());
        Ok(Self {
            config,
            robot: SimulatedRobot::new(world, config, SEED)?,
            stencil: Stencil::new(&model, heading),
            map: CoverageMap::new(mission.grid, config.model.bins)?,
            planner: Planner::new(&config.planner, &model, outside, radius, heading)?,
            heading,
            clock,
            grid: mission.grid,
            looks: Looks::new(&model),
            model,
            at: start.context("the start lies in the grid")?,
        })
    }

    /// Takes over the measurements of a run, without a decision: no gain is computed yet.
    pub(crate) fn follow(&mut self, run: &Run) {
        run.scans.iter().for_each(|scan| {
            self.take_over(scan);
        });
        for way in run.trajectory.windows(2) {
            self.moved(way[0], way[1]);
            self.stand(self.grid.cell_at(way[1]).unwrap_or(self.at));
        }
    }

    /// Puts the robot in the cell of a point, and measures there.
    pub(crate) fn visit(&mut self, point: Point2<f64>) {
        let Some(cell) = self.grid.cell_at(point) else { return };
        let center = self.grid.center(cell);
        self.moved(center, center);
        self.stand(cell);
        self.scan();
    }

    /// Carries out a decision, measures, and returns the time that the planner took to note it
    /// \[s\].
    pub(crate) fn go(&mut self, decision: &Decision) -> f64 {
        let mut seconds = 0.0;
        for cell in &decision.path {
            let (from, to) = (self.grid.center(self.at), self.grid.center(*cell));
            if let Ok(Drive::Bumped { at }) = self.robot.drive(from, to) {
                self.planner.bump(self.at, *cell, at);
                break;
            }
            seconds += self.moved(from, to);
            self.planner.drove(self.at, *cell);
            self.at = *cell;
        }
        seconds + self.scan()
    }

    /// Decides, and returns the time taken \[s\].
    pub(crate) fn choose(&mut self) -> (f64, Option<Decision>) {
        self.clock.time(|| self.planner.choose(&self.map, self.at))
    }

    /// Returns E\[I\] of a view-point by the equations as printed.
    pub(crate) fn literal_gain(&self, view_point: Cell) -> f64 {
        let prediction = self.planner.prediction_at(view_point);
        expected_information_gain(&self.map, &self.model, &self.stencil, prediction, view_point)
    }

    fn stand(&mut self, cell: Cell) {
        self.planner.stand_on(cell);
        self.at = cell;
    }

    fn moved(&mut self, from: Point2<f64>, to: Point2<f64>) -> f64 {
        let changes = integrate_body(&mut self.map, from, to, self.config.robot.radius);
        self.clock.time(|| self.planner.body_moved(&self.map, from, to, &changes)).0
    }

    fn scan(&mut self) -> f64 {
        let pose = Isometry2::new(self.grid.center(self.at).coords, self.heading);
        let scan = Scan { pose, time: 0.0, ranges: self.robot.fire(&pose) };
        self.take_over(&scan)
    }

    fn take_over(&mut self, scan: &Scan) -> f64 {
        let changes = self.looks.integrate(&self.model, &mut self.map, scan);
        self.clock.time(|| self.planner.observe(&self.map, scan, &changes)).0
    }
}
