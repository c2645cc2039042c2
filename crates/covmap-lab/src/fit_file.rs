//! The file of a fit, and the examples that it describes.

use crate::error::{Fault, Result, about};
use crate::files::{self, beside};
use crate::recorded::Recorded;
use crate::watch::Watch;
use crate::{Config, Experiment, Truth};
use covmap_explore::{Limits, Mission};
use covmap_fit::{Axis, BodyRecord, Example, FitSettings, Fitted, SearchSettings, Weighting, fit};
use covmap_io::read_ron;
use covmap_plan::Strategy;
use covmap_sonar::SonarRing;
use covmap_statistics::{stream, uniform};
use covmap_world::{Surface, World};
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Largest number of scans in one example, so that they fit into the memory.
const MOST_SCANS: usize = 1_000_000;

/// File of a fit. Its file names are relative to the file itself.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitFile {
    /// Configuration with the robot, the sonar, the model to begin with, and the planner.
    pub config: PathBuf,
    /// Configuration of the robot that explores the simulated worlds; `config` by default. Several fits
    /// with one explorer have the same scans.
    pub explorer: Option<PathBuf>,
    /// Parameters of the explorer that differ from its file, by their paths, such as
    /// `planner.scan_spacing`: see [`Config::overridden`].
    #[serde(default)]
    pub explorer_overrides: BTreeMap<String, Value>,
    /// Side of a cell, unless an example has its own \[m\].
    pub resolution: f64,
    /// Seed of the starts.
    pub seed: u64,
    /// The number of local searches.
    pub starts: usize,
    /// Largest number of evaluations of each search.
    pub evaluations: usize,
    /// Weighting of the cells in the mean likelihood.
    pub weighting: Weighting,
    /// The free parameters.
    pub axes: Vec<Axis>,
    /// Sources of the examples to fit to.
    pub training: Vec<Source>,
    /// Sources of the examples to check the result on.
    pub held_out: Vec<Source>,
}

/// Source of an example.
#[derive(Debug, Deserialize)]
pub enum Source {
    /// A simulated exploration.
    Simulated(Simulated),
    /// The log of a robot, and a survey of the building.
    Recorded(Recorded),
}

/// A simulated exploration.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Simulated {
    /// The scenario, or a map of map_server.
    pub scenario: PathBuf,
    /// Side of a cell \[m\]; that of the fit's file by default.
    pub resolution: Option<f64>,
    /// Surface of everything in the world. By default the surfaces are those of the scenario, and that of
    /// the configuration where the scenario has none.
    pub surface: Option<Surface>,
    /// Angle by which the world is turned \[rad\].
    pub turn: f64,
    /// Distances by which the world is shifted \[m\].
    pub shift: (f64, f64),
    /// Strategy of the exploration.
    pub strategy: Strategy,
    /// Largest number of scans; without it the run goes on to its certificate.
    pub scans: Option<usize>,
    /// Seed of the noise.
    pub seed: u64,
}

/// A configuration and its file.
#[derive(Debug, Clone)]
pub struct Named {
    /// The configuration.
    pub config: Config,
    /// The file of the configuration.
    pub file: PathBuf,
}

/// A fit's file with the configurations that it names.
#[derive(Debug)]
pub struct FitPlan {
    /// The content of the file.
    pub file: FitFile,
    /// The path of the file.
    path: PathBuf,
    /// Configuration with the model that the fit begins with.
    pub begin: Named,
    /// Configuration of the robot that explores.
    pub explorer: Named,
}

impl Named {
    /// Reads a configuration that the fit's file at `path` names, with the parameters that it sets.
    fn read(
        path: &Path,
        named: &Path,
        resolution: f64,
        overrides: &BTreeMap<String, Value>,
    ) -> Result<Self> {
        let file = beside(path, named);
        let mut config: Config = read_ron(&file)?;
        config.resolution = resolution;
        for (parameter, value) in overrides {
            config = config.overridden(parameter, value).map_err(about(path))?;
        }
        files::check(&config, &file)?;
        Ok(Self { config, file })
    }
}

impl FitPlan {
    /// Reads and checks the file, and the files that it names.
    ///
    /// # Errors
    /// If anything is wrong with these files.
    pub fn read(path: &Path) -> Result<Self> {
        let file: FitFile = read_ron(path)?;
        let begin = Named::read(path, &file.config, file.resolution, &BTreeMap::new())?;
        let explorer = file.explorer.as_ref().unwrap_or(&file.config);
        let explorer = Named::read(path, explorer, file.resolution, &file.explorer_overrides)?;
        if begin.config.robot != explorer.config.robot {
            return Err(about(path)(Fault::OtherRobot {
                explorer: explorer.file,
                config: begin.file,
            }));
        }
        Axis::check(&file.axes).map_err(about(path))?;
        for axis in &file.axes {
            axis.place(&begin.config.model).map_err(about(path))?;
        }
        if file.training.is_empty() {
            return Err(about(path)(Fault::NoTraining));
        }
        in_range(path, "starts", file.starts, 1000)?;
        in_range(path, "evaluations", file.evaluations, 1_000_000)?;
        let plan = Self { file, path: path.to_owned(), begin, explorer };
        for source in plan.file.training.iter().chain(&plan.file.held_out) {
            plan.check(source)?;
        }
        Ok(plan)
    }

    /// Makes the examples of some sources, in parallel.
    ///
    /// # Errors
    /// If an example cannot be made.
    pub fn examples(&self, sources: &[Source], watch: &dyn Watch) -> Result<Vec<Example>> {
        let example = |source: &Source| {
            watch.begin(&format!("reading {}", source.file().display()));
            match source {
                Source::Simulated(source) => {
                    source.example(&self.path, &self.explorer, &mut || watch.flow())
                }
                Source::Recorded(source) => source.example(&self.path, &self.begin.config),
            }
        };
        sources.par_iter().map(example).collect()
    }

    /// Fits the model to examples, with the number of local searches in the file.
    ///
    /// # Errors
    /// If the fit cannot begin.
    pub fn search(&self, training: &[Example], watch: &dyn Watch) -> Result<Fitted> {
        let file = &self.file;
        let settings = FitSettings {
            weighting: file.weighting,
            axes: file.axes.clone(),
            starts: file.starts,
            search: SearchSettings { evaluations: file.evaluations, ..SearchSettings::default() },
        };
        let mut random = stream(file.seed, "fit", 0);
        let (mut count, mut best) = (0, f64::NEG_INFINITY);
        let report = |evaluation: &covmap_fit::Evaluation| {
            count += 1;
            best = evaluation.log_likelihood.unwrap_or(best).max(best);
            watch.tell(&format_args!(
                "search {} of {} · {count} evaluations · log-likelihood {best:.4} nats a cell",
                evaluation.start + 1,
                file.starts
            ));
            watch.flow()
        };
        let model = &self.begin.config.model;
        Ok(fit(training, model, &settings, || uniform(&mut random), report)?)
    }

    /// Checks a source before any work is done.
    fn check(&self, source: &Source) -> Result<()> {
        match source {
            Source::Simulated(source) => source.task(&self.path, &self.explorer).map(|_| ()),
            Source::Recorded(source) => source.check(&self.path),
        }
    }
}

/// Checks that a number lies in `1..=high`.
fn in_range(path: &Path, field: &'static str, value: usize, high: usize) -> Result<()> {
    if (1..=high).contains(&value) {
        return Ok(());
    }
    Err(about(path)(Fault::Range { field, value, low: 1, high }))
}

impl Source {
    /// Returns the file that the example is made from.
    pub fn file(&self) -> &Path {
        match self {
            Self::Simulated(source) => &source.scenario,
            Self::Recorded(source) => &source.log,
        }
    }
}

impl Simulated {
    /// The world and the experiment in it.
    fn task(&self, path: &Path, explorer: &Named) -> Result<(World, Experiment)> {
        let Named { config, file: name } = explorer;
        in_range(path, "scans", self.scans.unwrap_or(1), MOST_SCANS)?;
        let world = self.world(path, config.sonar.surface)?;
        let file = beside(path, &self.scenario);
        let mut config = config.clone();
        config.planner.strategy = self.strategy;
        config.resolution = self.resolution.unwrap_or(config.resolution);
        let limits = Limits { max_scans: self.scans, ..Limits::default() };
        let mission = files::mission((&world, &file), (&config, name.as_path()), None, limits)?;
        Ok((world, Experiment { mission, sonar: config.sonar, seed: self.seed }))
    }

    /// The world; `surface` is the surface of everything without one in the files.
    fn world(&self, path: &Path, surface: Surface) -> Result<World> {
        let moves = [self.turn, self.shift.0, self.shift.1];
        if !moves.iter().all(|v| v.is_finite()) || self.shift.0 < 0.0 || self.shift.1 < 0.0 {
            let must = "finite, the shift not negative";
            return Err(about(path)(Fault::Number { field: "turn and shift", must }));
        }
        let file = beside(path, &self.scenario);
        if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
            if moves.iter().any(|v| v.abs() > 0.0) {
                return Err(about(&file)(Fault::MapMoved));
            }
            return files::world(&file, self.surface.unwrap_or(surface));
        }
        let scenario = files::scenario(&file)?;
        let world = files::moved(&scenario, self.turn, self.shift, (&file, surface))?;
        let Some(surface) = self.surface else { return Ok(world) };
        let placed = files::placed(&scenario, self.turn, self.shift);
        World::from_scenario(&placed.with_surface(surface), surface).map_err(about(&file))
    }

    /// Lets the robot explore; the example is its scans with the truth.
    fn example(
        &self,
        path: &Path,
        explorer: &Named,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Example> {
        let (world, experiment) = self.task(path, explorer)?;
        let mission = &experiment.mission;
        let run = experiment.explore(&world, &mut |_, view| match view.scans {
            MOST_SCANS.. => ControlFlow::Break(()),
            _ => watch(),
        })?;
        let truth = Truth::new(&world, mission);
        let measured = truth.measured_cells(&run.map);
        let coverage = |cell| truth.coverage.get(cell).copied().unwrap_or(1.0);
        Ok(Example {
            name: self.name(&world, mission),
            ring: ring(mission)?,
            scans: run.scans,
            body: BodyRecord { radius: mission.config.robot.radius, events: run.body },
            grid: mission.grid,
            truth: measured.into_iter().map(|cell| (cell, coverage(cell))).collect(),
        })
    }

    fn name(&self, world: &World, mission: &Mission) -> String {
        let surface = match self.surface {
            None => "",
            Some(Surface::Rough) => ", rough",
            Some(Surface::Smooth) => ", smooth",
        };
        let resolution = mission.config.resolution;
        let Self { strategy, seed, .. } = self;
        format!("{}{surface}, {strategy}, r = {resolution} m, seed {seed}", world.name())
    }
}

fn ring(mission: &Mission) -> Result<SonarRing> {
    Ok(SonarRing::from_specification(&mission.config.robot.ring)?)
}
