//! The state of a run at one of its decisions.

use crate::error::{PaperError, Result};
use covmap::{Cell, CoverageMap, Grid, Raster};
use covmap_explore::{Event, Limits, explore};
use covmap_gain::{
    BeamStencil, GainCache, NEGLIGIBLE, RangeLikelihood, RangePrediction, Stencil, Upkeep,
    ViewPoints, expected_information_gain, imagined_causes, range_likelihood, reflection,
};
use covmap_io::parse_ron;
use covmap_lab::{Config, SimulatedRobot};
use covmap_model::SensorModel;
use covmap_plan::{CandidateRecord, Decision};
use covmap_sonar::SonarRing;
use covmap_world::World;
use std::ops::ControlFlow;
use std::path::Path;

const WORLD: &str = "scenarios/lab.ron";
const SEED: u64 = 1;

/// A decision with everything on which it was based.
pub(super) struct Moment {
    pub(super) config: Config,
    pub(super) ring: SonarRing,
    pub(super) model: SensorModel,
    pub(super) stencil: Stencil,
    pub(super) map: CoverageMap,
    pub(super) scans: usize,
    /// The number of the decision.
    pub(super) number: usize,
    pub(super) from: Cell,
    pub(super) decision: Decision,
    /// The gain cache after the decision.
    pub(super) gains: GainCache,
    /// The new share of a reading from each view-point.
    novelty: Raster<f64>,
    /// All candidates with their gains.
    pub(super) candidates: Vec<CandidateRecord>,
}

/// A beam from a view-point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub(super) view_point: Cell,
    pub(super) beam: usize,
}

impl Moment {
    /// Explores up to a decision.
    pub(super) fn reach(config: &Config, wanted: usize) -> Result<Self> {
        let scenario =
            parse_ron(Path::new(WORLD), include_str!("../../../../../scenarios/lab.ron"))?;
        let world = World::from_scenario(&scenario, config.sonar.surface)?;
        let limits = Limits { while_driving: None, max_scans: None };
        let mission = covmap_lab::mission(&world, config, None, limits)?;
        let mut robot = SimulatedRobot::new(&world, config, SEED)?;
        let (ring, model) = config.build()?;
        let mut found = None;
        explore(&mission, &mut robot, &mut |event, view| match event {
            Event::Decision { number, from, decision } if *number == wanted => {
                let mut all = view.planner.clone();
                found = Some(Self {
                    config: config.clone(),
                    ring: ring.clone(),
                    model: model.clone(),
                    stencil: view.planner.stencil().clone(),
                    map: view.map.clone(),
                    scans: view.scans,
                    number: wanted,
                    from: *from,
                    decision: decision.clone(),
                    gains: view.planner.gains().clone(),
                    novelty: Raster::from_fn(mission.grid, |cell| {
                        view.planner.prediction_at(cell).novelty
                    }),
                    candidates: all.candidate_table(view.map, *from),
                });
                ControlFlow::Break(())
            }
            _ => ControlFlow::Continue(()),
        })?;
        found.ok_or(PaperError::Missing("a decision of the run in scenarios/lab.ron"))
    }

    pub(super) fn grid(&self) -> &Grid {
        self.map.grid()
    }

    pub(super) fn index(&self, cell: Cell) -> usize {
        self.grid().index(cell).unwrap_or(0)
    }

    pub(super) fn prediction(&self) -> RangePrediction {
        self.config.planner.range_prediction()
    }

    /// Describes the moment in words.
    pub(super) fn words(&self) -> String {
        format!(
            "{WORLD}, IG, r = {} m, decision {} after {} scans",
            self.config.resolution, self.number, self.scans
        )
    }

    /// Returns a cache that learns the whole map at once.
    pub(super) fn fresh_cache(&self) -> Result<GainCache> {
        let mut cache =
            GainCache::new(&self.model, 0.0, *self.grid(), self.prediction(), Upkeep::Kept)?;
        for cell in self.grid().cells() {
            cache.update(&self.map, cell);
            cache.set_novelty(self.index(cell), self.novelty(cell));
        }
        Ok(cache)
    }

    fn novelty(&self, view_point: Cell) -> f64 {
        self.novelty.get(view_point).copied().unwrap_or(1.0)
    }

    /// Returns all candidates.
    pub(super) fn view_points(&self) -> ViewPoints {
        let indices = self.candidates.iter().map(|candidate| self.index(candidate.cell));
        ViewPoints::of(self.grid(), indices)
    }

    /// Returns E\[I\] by the equations as printed.
    pub(super) fn literal_gain(&self, cell: Cell) -> f64 {
        let (map, model, stencil) = (&self.map, &self.model, &self.stencil);
        let prediction = RangePrediction { novelty: self.novelty(cell), ..self.prediction() };
        expected_information_gain(map, model, stencil, prediction, cell)
    }

    pub(super) fn beam(&self, seen: Seen) -> &BeamStencil {
        &self.stencil.beams[seen.beam]
    }

    /// Returns p(d | c) of a beam.
    pub(super) fn likelihood(&self, seen: Seen) -> RangeLikelihood {
        let (beam, prediction) = (self.beam(seen), self.prediction());
        let cell = |i: usize| seen.view_point.offset(beam.cells[i].dx, beam.cells[i].dy);
        let rho = |i| reflection(&self.map, cell(i), prediction.unknown_reflection);
        let mut likelihood = RangeLikelihood::default();
        range_likelihood(beam, prediction.uniform_share, rho, &mut likelihood);
        likelihood
    }

    /// Returns L of an outcome: the probability that any surface of the map caused it.
    pub(super) fn any_cause(&self, seen: Seen, k: usize) -> f64 {
        let (beam, outcome) = (self.beam(seen), self.stencil.outcome(k));
        imagined_causes(&self.map, &self.model, beam, seen.view_point, outcome)
            .map_or(0.0, |causes| causes.by_as_much(self.novelty(seen.view_point)).any)
    }

    /// Returns the number of cells that decide the values of a beam.
    pub(super) fn horizon(&self, seen: Seen) -> usize {
        let index = self.index(seen.view_point);
        let Ok(mut cache) = self.fresh_cache() else { return 0 };
        cache.refresh_sight(&ViewPoints::one(self.grid(), index));
        cache.horizon(index, seen.beam)
    }

    /// Returns the beam of a candidate that tells most in a drawing: one with many likely outcomes,
    /// and with a quarter of it hidden.
    pub(super) fn telling_beam(&self) -> Seen {
        let (beams, echoes) = (self.stencil.beams.len(), self.stencil.ranges.len());
        let all = self
            .candidates
            .iter()
            .flat_map(|candidate| (0..beams).map(|beam| Seen { view_point: candidate.cell, beam }));
        let likely = |seen: &Seen| {
            let likelihood = self.likelihood(*seen);
            let is_likely = |k: &usize| likelihood.probability(*k) > 0.02;
            let near = likelihood.echo[..echoes / 4].iter().sum::<f64>();
            let hidden = likelihood.probability(echoes) + near <= NEGLIGIBLE
                && likelihood.traced <= echoes * 3 / 4;
            let outcomes = (0..=echoes).filter(is_likely).count();
            if hidden { outcomes + echoes } else { outcomes }
        };
        let best = |best: (usize, Seen), seen: Seen| {
            let outcomes = likely(&seen);
            if outcomes > best.0 { (outcomes, seen) } else { best }
        };
        all.fold((0, Seen { view_point: self.from, beam: 0 }), best).1
    }
}
