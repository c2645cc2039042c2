//! All runs of a campaign, checked before any of them starts.

use crate::error::{CampaignError, Result};
use crate::file::{Campaign, NamedWorld, Setting};
use crate::folder::{Manifest, Planned};
use crate::numbers::NUMBERS;
use crate::record::RunKey;
use crate::version::VERSION;
use covmap_explore::{Limits, Mission};
use covmap_io::Digest;
use covmap_io::{MAX_FILE, MapServerMap, read_bytes, read_ron};
use covmap_lab::{Config, Experiment, Fault, LabError, files, memory};
use covmap_plan::Strategy;
use covmap_world::{Scenario, World};
use nalgebra::Isometry2;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Largest number of runs of one campaign.
const MOST_RUNS: usize = 100_000;

/// Every N-th run of a campaign: 2/3 are the runs 1, 4, 7 …, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// All runs.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether the shard has a run.
    pub fn has(self, index: usize) -> bool {
        index % self.of == self.number - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(number, of)| {
            Some(Self { number: number.trim().parse().ok()?, of: of.trim().parse().ok()? })
        });
        match numbers {
            Some(shard) if (1..=shard.of).contains(&shard.number) => Ok(shard),
            _ => Err("a shard is I/N with 1 ≤ I ≤ N, as in 2/3".to_owned()),
        }
    }
}

/// A world with a setting, and the robot's starts in it.
#[derive(Debug)]
pub struct Case {
    /// The world.
    pub world: World,
    /// The world's file, for errors.
    file: PathBuf,
    /// The configuration.
    pub config: Config,
    /// The configuration's file, for errors.
    name: PathBuf,
    /// Limits of a run.
    pub limits: Limits,
    /// The robot's starts.
    pub starts: Vec<Isometry2<f64>>,
    /// Hash of the world's files, its turn and its shift.
    digest: Digest,
}

/// One run.
#[derive(Debug)]
pub struct Job {
    /// The planned run.
    pub planned: Planned,
    /// Index of its case.
    pub case: usize,
    /// Strategy that chooses view-points.
    pub strategy: Strategy,
}

/// All runs of a campaign, in order.
#[derive(Debug)]
pub struct Plan {
    /// The list of the runs.
    pub manifest: Manifest,
    /// Every world with every setting.
    pub cases: Vec<Case>,
    /// The runs, in order.
    pub jobs: Vec<Job>,
    /// Whether paths are kept.
    pub keep_paths: bool,
    /// Notes on the worlds: those that are left out, and warnings about their files.
    pub notes: Vec<String>,
}

impl Plan {
    /// Finds and checks all runs of a campaign.
    ///
    /// # Errors
    /// If anything is wrong with the campaign or a run.
    pub fn new(campaign: &Campaign) -> Result<Self> {
        check_lists(campaign)?;
        let (mut cases, mut jobs, mut notes) = (Vec::new(), Vec::new(), Vec::new());
        for world in &campaign.worlds {
            if world.is_left_out() {
                notes.push(format!("{}: is not there, and is left out", world.file.display()));
                continue;
            }
            let source = Source::read(world, &mut notes)?;
            for setting in &campaign.settings {
                let case = source.case(world, setting, campaign)?;
                let strategies = setting.strategies.as_ref().unwrap_or(&campaign.strategies);
                case.check(strategies)?;
                cases.push(case);
                add_jobs(&mut jobs, &cases, (world, setting, strategies), campaign)?;
            }
        }
        if jobs.is_empty() {
            return Err(CampaignError::NoWorld);
        }
        let manifest = manifest(campaign, &jobs)?;
        for (job, planned) in jobs.iter_mut().zip(&manifest.runs) {
            job.planned = planned.clone();
        }
        Ok(Self { manifest, cases, jobs, keep_paths: campaign.keep_paths, notes })
    }

    /// Returns the number of runs that fit into the memory together; at least one.
    ///
    /// # Errors
    /// If a grid is impossible.
    pub fn runs_at_once(&self) -> Result<NonZeroUsize> {
        let fit = |case: &Case| {
            let mut config = case.config.clone();
            // The strategy that takes the most memory.
            config.planner.strategy = Strategy::Ig;
            let grid = case.world.grid(config.resolution).map_err(LabError::from)?;
            Ok(memory::runs_at_once(&grid, &config)?)
        };
        let fits: Vec<usize> = self.cases.iter().map(fit).collect::<Result<_>>()?;
        Ok(fits.into_iter().min().and_then(NonZeroUsize::new).unwrap_or(NonZeroUsize::MIN))
    }

    /// Returns a run as an experiment.
    ///
    /// # Errors
    /// If the run is impossible.
    pub fn experiment(&self, job: &Job) -> Result<Experiment> {
        let (case, key) = (&self.cases[job.case], &job.planned.key);
        let mission = case.mission(job.strategy, case.starts[key.start])?;
        // Nobody reads the decisions of a campaign.
        let mission = Mission { explains: false, ..mission };
        Ok(Experiment { mission, sonar: case.config.sonar, seed: key.seed })
    }
}

/// Checks the campaign as far as this needs no other file.
fn check_lists(campaign: &Campaign) -> Result<()> {
    let Campaign { worlds, settings, seeds, .. } = campaign;
    if !(1..=MOST_RUNS).contains(&seeds.count) {
        return Err(CampaignError::Seeds { count: seeds.count, most: MOST_RUNS });
    }
    if seeds.first.checked_add(seeds.count as u64).is_none() {
        return Err(CampaignError::LastSeed(seeds.first));
    }
    names("name", [&campaign.name])?;
    if campaign.name.contains(['/', '\\']) || [".", ".."].contains(&campaign.name.as_str()) {
        return Err(CampaignError::FolderName(campaign.name.clone()));
    }
    names("worlds", worlds.iter().map(|world| &world.name))?;
    names("settings", settings.iter().map(|setting| &setting.name))?;
    settings.iter().try_for_each(check_setting)?;
    let with_own = |setting: &&Setting| setting.strategies.is_some();
    let own = settings.iter().filter(with_own).filter_map(|s| s.strategies.as_ref());
    let common = settings.iter().any(|setting| setting.strategies.is_none());
    for strategies in own.chain(common.then_some(&campaign.strategies)) {
        for strategy in strategies {
            strategy.validate()?;
        }
        unique("strategies", strategies.iter().map(ToString::to_string))?;
    }
    check_count(campaign)?;
    unique("metrics", campaign.metrics.iter().cloned())?;
    for metric in &campaign.metrics {
        if !NUMBERS.contains(&metric.as_str()) {
            return Err(CampaignError::Metric { name: metric.clone(), known: &NUMBERS });
        }
    }
    Ok(())
}

/// Checks that the limits and overrides of a setting have a meaning.
fn check_setting(setting: &Setting) -> Result<()> {
    let Setting { name, max_scans, overrides, .. } = setting;
    if *max_scans == Some(0) {
        return Err(CampaignError::NoScan(name.clone()));
    }
    let strategy = |path: &&String| {
        path.strip_prefix("planner.strategy")
            .is_some_and(|rest| matches!(rest.get(..1), None | Some(".")))
    };
    if let Some(path) = overrides.keys().find(strategy) {
        return Err(CampaignError::StrategyOverridden {
            setting: name.clone(),
            path: path.clone(),
        });
    }
    Ok(())
}

/// Checks the number of runs before any of them is planned.
fn check_count(campaign: &Campaign) -> Result<()> {
    let there = campaign.worlds.iter().filter(|world| !world.is_left_out());
    let of_world = |world: &NamedWorld| {
        let starts = world.starts.as_ref().unwrap_or(&campaign.starts).count();
        let of_setting = |setting: &Setting| {
            let strategies = setting.strategies.as_ref().unwrap_or(&campaign.strategies).len();
            strategies.checked_mul(starts)?.checked_mul(campaign.seeds.count)
        };
        sum(campaign.settings.iter().map(of_setting))
    };
    match sum(there.map(of_world)) {
        Some(runs) if runs <= MOST_RUNS => Ok(()),
        runs => Err(CampaignError::ManyRuns { runs, most: MOST_RUNS }),
    }
}

/// A sum, unless it is too large for a number.
fn sum(mut counts: impl Iterator<Item = Option<usize>>) -> Option<usize> {
    counts.try_fold(0usize, |sum, count| sum.checked_add(count?))
}

/// Checks that there are names, that they fit into a table, and that they differ.
fn names<'a>(list: &'static str, names: impl IntoIterator<Item = &'a String>) -> Result<()> {
    let names: Vec<&String> = names.into_iter().collect();
    let good = |name: &&&String| {
        !(1..=100).contains(&name.chars().count()) || name.chars().any(char::is_control)
    };
    if let Some(name) = names.iter().find(good) {
        return Err(CampaignError::Name { list, name: (*name).clone() });
    }
    unique(list, names.into_iter().cloned())
}

/// Checks that a list has entries, each once.
fn unique(list: &'static str, entries: impl Iterator<Item = String>) -> Result<()> {
    let mut entries: Vec<String> = entries.collect();
    if entries.is_empty() {
        return Err(CampaignError::Empty(list));
    }
    entries.sort_unstable();
    match entries.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(CampaignError::Twice { list, entry: pair[0].clone() }),
        None => Ok(()),
    }
}

/// A world's file, read.
struct Source {
    kind: Kind,
    digest: Digest,
}

enum Kind {
    Scenario(Scenario),
    MapServer,
}

impl Source {
    fn read(world: &NamedWorld, notes: &mut Vec<String>) -> Result<Self> {
        let NamedWorld { file, turn, shift, .. } = world;
        let moves = [*turn, shift.0, shift.1];
        let moved = |fault| CampaignError::Moved { world: world.name.clone(), fault };
        if !moves.iter().all(|v| v.is_finite()) || shift.0 < 0.0 || shift.1 < 0.0 {
            let must = "finite, the shift not negative";
            return Err(moved(Fault::Number { field: "turn and shift", must }));
        }
        let bytes = |path: &Path| read_bytes(path, MAX_FILE);
        if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
            let scenario = files::scenario(file)?;
            let digest = Digest::default().with(bytes(file)?).with_numbers(&moves);
            return Ok(Self { kind: Kind::Scenario(scenario), digest });
        }
        if moves.iter().any(|v| v.abs() > 0.0) {
            return Err(moved(Fault::MapMoved));
        }
        // A file that is no map of map_server is refused when the world is made of it.
        let digest = if world.is_map() {
            let map = files::map(file)?;
            notes.extend(files::remarks(file, &map).warnings);
            map_digest(&map)
        } else {
            Digest::default()
        };
        Ok(Self { kind: Kind::MapServer, digest })
    }

    fn case(&self, named: &NamedWorld, setting: &Setting, campaign: &Campaign) -> Result<Case> {
        let name = &setting.config;
        let config: Config = read_ron(name)?;
        let mut config = setting
            .overrides
            .iter()
            .try_fold(config, |config, (path, value)| config.overridden(path, value))
            .map_err(|error| CampaignError::Override { setting: setting.name.clone(), error })?;
        config.resolution = named.resolution.unwrap_or(config.resolution);
        files::check(&config, name)?;
        let (file, surface) = (&named.file, config.sonar.surface);
        let world = match &self.kind {
            Kind::MapServer => files::world(file, surface)?,
            Kind::Scenario(scenario) => {
                files::moved(scenario, named.turn.to_radians(), named.shift, (file, surface))?
            }
        };
        let starts = named.starts.as_ref().unwrap_or(&campaign.starts);
        let starts = starts
            .poses(&world, &config)
            .map_err(|fault| CampaignError::Starts { file: file.clone(), fault })?;
        let Setting { while_driving, max_scans, .. } = *setting;
        let limits = Limits { while_driving, max_scans };
        let (file, name) = (file.clone(), name.clone());
        Ok(Case { world, file, config, name, limits, starts, digest: self.digest.clone() })
    }
}

/// The hash of a map's cells and their place, which are all the content of the map's two files.
fn map_digest(map: &MapServerMap) -> Digest {
    let (grid, low, pose) = (&map.grid, map.grid.lower_left(), &map.world_from_map);
    let cells: Vec<u8> = map.solid().values().iter().map(|solid| u8::from(*solid)).collect();
    let at = pose.translation.vector;
    let numbers = [low.x, low.y, grid.resolution(), at.x, at.y, pose.rotation.angle()];
    Digest::default().with_numbers(&numbers).with(grid.width().to_string()).with(cells)
}

impl Case {
    fn mission(&self, strategy: Strategy, start: Isometry2<f64>) -> Result<Mission> {
        let mut config = self.config.clone();
        config.planner.strategy = strategy;
        let (world, config) = ((&self.world, self.file.as_path()), (&config, self.name.as_path()));
        Ok(files::mission(world, config, Some(start), self.limits)?)
    }

    /// Checks all runs; whether a start is good does not depend on the strategy.
    fn check(&self, strategies: &[Strategy]) -> Result<()> {
        for start in &self.starts {
            self.mission(strategies[0], *start)?;
        }
        strategies.iter().try_for_each(|s| self.mission(*s, self.starts[0]).map(|_| ()))
    }

    /// The hash of everything that a run is a function of, except the program and the seed.
    fn digest(&self, strategy: Strategy, start: &Isometry2<f64>) -> Result<Digest> {
        let mut config = self.config.clone();
        config.planner.strategy = strategy;
        let at = start.translation.vector;
        Ok(self
            .digest
            .clone()
            .with(serde_json::to_vec(&config)?)
            .with(serde_json::to_vec(&self.limits)?)
            .with_numbers(&[at.x, at.y, start.rotation.angle()]))
    }
}

fn add_jobs(
    jobs: &mut Vec<Job>,
    cases: &[Case],
    (world, setting, strategies): (&NamedWorld, &Setting, &[Strategy]),
    campaign: &Campaign,
) -> Result<()> {
    let (case, seeds) = (cases.len() - 1, campaign.seeds);
    let starts = &cases[case].starts;
    for &strategy in strategies {
        for (start, pose) in starts.iter().enumerate() {
            let digest = cases[case].digest(strategy, pose)?;
            for seed in (seeds.first..).take(seeds.count) {
                let key = RunKey {
                    world: world.name.clone(),
                    setting: setting.name.clone(),
                    strategy: strategy.to_string(),
                    start,
                    seed,
                };
                let keep = [u8::from(campaign.keep_paths)];
                let id = digest.clone().with(seed.to_le_bytes()).with(keep).finish();
                jobs.push(Job { planned: Planned { key, id }, case, strategy });
            }
        }
    }
    Ok(())
}

/// The list of all runs. Up to here the name of a run does not depend on the program.
fn manifest(campaign: &Campaign, jobs: &[Job]) -> Result<Manifest> {
    let mut seen: BTreeMap<&str, &RunKey> = BTreeMap::new();
    for Job { planned, .. } in jobs {
        if let Some(other) = seen.insert(&planned.id, &planned.key) {
            return Err(CampaignError::SameRun(
                Box::new(other.clone()),
                Box::new(planned.key.clone()),
            ));
        }
    }
    let runs: Vec<Planned> = jobs.iter().map(|job| job.planned.clone()).collect();
    Ok(Manifest::new(&campaign.name, &campaign.metrics, runs, VERSION))
}
