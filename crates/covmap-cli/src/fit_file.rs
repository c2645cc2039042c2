//! The file that says what is fitted to what, and the examples that it describes.

use crate::input::{self, about};
use crate::interrupt::Interrupt;
use crate::progress::Progress;
use crate::recorded::Recorded;
use crate::world_file;
use anyhow::{Result, bail};
use covmap_explore::{Limits, Mission};
use covmap_fit::{Axis, BodyRecord, Example, Weighting};
use covmap_io::read_ron;
use covmap_lab::{Config, Experiment, Truth};
use covmap_plan::Strategy;
use covmap_sonar::SonarRing;
use covmap_world::{Surface, World};
use rayon::prelude::*;
use serde::Deserialize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Not more scans than this in one example, so that they fit into the memory.
const MOST_SCANS: usize = 1_000_000;

/// What is fitted to what. Files are named relative to this one.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FitFile {
    /// Robot, sonar, the model to begin with, and the planner.
    pub(crate) config: PathBuf,
    /// Who explores the simulated worlds; without it `config`. One explorer for several fits gives
    /// them the same scans.
    pub(crate) explorer: Option<PathBuf>,
    /// The side of a cell where an example does not say another \[m\].
    pub(crate) resolution: f64,
    /// Seed of the starts.
    pub(crate) seed: u64,
    /// How many local searches.
    pub(crate) starts: usize,
    /// The most evaluations of each.
    pub(crate) evaluations: usize,
    /// What the likelihood is the mean of.
    pub(crate) weighting: Weighting,
    /// The free parameters.
    pub(crate) axes: Vec<Axis>,
    /// What is fitted to.
    pub(crate) training: Vec<Source>,
    /// What the result is checked on.
    pub(crate) held_out: Vec<Source>,
}

/// Where an example comes from.
#[derive(Debug, Deserialize)]
pub(crate) enum Source {
    /// A simulated exploration.
    Simulated(Simulated),
    /// The log of a robot, and a survey of where it was.
    Recorded(Recorded),
}

/// A simulated exploration.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Simulated {
    /// The scenario, or a map of map_server.
    pub(crate) scenario: PathBuf,
    /// The side of a cell \[m\]; without it that of the file.
    pub(crate) resolution: Option<f64>,
    /// The surface of everything in the world; without it what the scenario says, and outside of
    /// it the configuration.
    pub(crate) surface: Option<Surface>,
    /// By how much it is turned \[rad\].
    pub(crate) turn: f64,
    /// By how much it is shifted \[m\].
    pub(crate) shift: (f64, f64),
    /// Who explores it.
    pub(crate) strategy: Strategy,
    /// How many scans; without it as many as it takes until the certificate.
    pub(crate) scans: Option<usize>,
    /// Seed of the noise.
    pub(crate) seed: u64,
}

/// A configuration, and the file that it is from.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub(crate) config: Config,
    pub(crate) file: PathBuf,
}

/// A fit's file with the configurations that it names.
#[derive(Debug)]
pub(crate) struct FitPlan {
    pub(crate) file: FitFile,
    /// Where it is.
    path: PathBuf,
    /// What the fit begins with.
    pub(crate) begin: Named,
    /// Who explores.
    pub(crate) explorer: Named,
}

impl Named {
    fn read(path: &Path, named: &Path, resolution: f64) -> Result<Self> {
        let file = beside(path, named);
        let (mut config, _) = input::config(Some(&file))?;
        config.resolution = resolution;
        input::check(&config, &file)?;
        Ok(Self { config, file })
    }
}

impl FitPlan {
    /// Reads and checks the file, and what it names.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let file: FitFile = read_ron(path)?;
        let begin = Named::read(path, &file.config, file.resolution)?;
        let explorer = file.explorer.as_ref().unwrap_or(&file.config);
        let explorer = Named::read(path, explorer, file.resolution)?;
        if begin.config.robot != explorer.config.robot {
            bail!(
                "{}: explorer: {} has another robot than {}; the model is of one ring of sensors",
                path.display(),
                explorer.file.display(),
                begin.file.display()
            );
        }
        Axis::check(&file.axes).map_err(about(path))?;
        for axis in &file.axes {
            axis.place(&begin.config.model).map_err(about(path))?;
        }
        if file.training.is_empty() {
            bail!("{}: training needs at least one entry", path.display());
        }
        if !(1..=1000).contains(&file.starts) || !(1..=1_000_000).contains(&file.evaluations) {
            bail!("{}: starts must lie in 1..=1000, evaluations in 1..=1000000", path.display());
        }
        let plan = Self { file, path: path.to_owned(), begin, explorer };
        for source in plan.file.training.iter().chain(&plan.file.held_out) {
            plan.check(source)?;
        }
        Ok(plan)
    }

    /// The examples of some sources, made side by side.
    pub(crate) fn examples(
        &self,
        sources: &[Source],
        (progress, interrupt): (&Progress, &Interrupt),
    ) -> Result<Vec<Example>> {
        let example = |source: &Source| {
            progress.say(&format!("reading {}", source.file().display()));
            match source {
                Source::Simulated(source) => {
                    source.example(&self.path, &self.explorer, &mut || interrupt.flow())
                }
                Source::Recorded(source) => source.example(&self.path, &self.begin.config),
            }
        };
        sources.par_iter().map(example).collect()
    }

    /// Finds what is wrong with a source before any work is done.
    fn check(&self, source: &Source) -> Result<()> {
        match source {
            Source::Simulated(source) => source.task(&self.path, &self.explorer).map(|_| ()),
            Source::Recorded(source) => source.check(&self.path),
        }
    }
}

/// A file that is named in another one.
pub(crate) fn beside(path: &Path, named: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(named)
}

impl Source {
    /// The file that it is made from.
    pub(crate) fn file(&self) -> &Path {
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
        if let Some(scans) = self.scans.filter(|scans| !(1..=MOST_SCANS).contains(scans)) {
            bail!("{}: scans: {scans} must lie in 1..={MOST_SCANS}", path.display());
        }
        let world = self.world(path, config.sonar.surface)?;
        let file = beside(path, &self.scenario);
        let mut config = config.clone();
        config.planner.strategy = self.strategy;
        config.resolution = self.resolution.unwrap_or(config.resolution);
        let limits = Limits { max_scans: self.scans, ..Limits::default() };
        let mission = input::mission((&world, &file), (&config, name.as_path()), None, limits)?;
        Ok((world, Experiment { mission, sonar: config.sonar, seed: self.seed }))
    }

    /// The world; what no file says about surfaces is `surface`.
    fn world(&self, path: &Path, surface: Surface) -> Result<World> {
        let moves = [self.turn, self.shift.0, self.shift.1];
        if !moves.iter().all(|v| v.is_finite()) || self.shift.0 < 0.0 || self.shift.1 < 0.0 {
            bail!("{}: turn and shift must be finite, the shift not negative", path.display());
        }
        let file = beside(path, &self.scenario);
        if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
            if moves.iter().any(|v| v.abs() > 0.0) {
                bail!("{}: only scenarios can be turned and shifted", file.display());
            }
            return input::world(&file, self.surface.unwrap_or(surface));
        }
        let scenario = world_file::scenario(&file)?;
        let world = input::moved(&scenario, self.turn, self.shift, (&file, surface))?;
        let Some(surface) = self.surface else { return Ok(world) };
        let placed = input::placed(&scenario, self.turn, self.shift);
        World::from_scenario(&placed.with_surface(surface), surface).map_err(about(&file))
    }

    /// Lets the robot explore, and takes what it measured with the truth.
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
