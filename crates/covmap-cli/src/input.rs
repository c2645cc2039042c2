//! Worlds and configurations from files.

use crate::memory;
use crate::world_file;
use anyhow::{Result, anyhow, bail};
use covmap::{Grid, Raster};
use covmap_explore::{Limits, Mission};
use covmap_io::{parse_ron, read_ron};
use covmap_lab::{Config, SetupError};
use covmap_model::SensorModel;
use covmap_plan::{Planner, PlannerError};
use covmap_world::{Scenario, Surface, World};
use nalgebra::{Isometry2, Point2, Vector2};
use std::borrow::Cow;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// The shipped default, so that it works in any folder.
const DEFAULT_CONFIG: &str = include_str!("../../../configs/b21r.ron");
const DEFAULT_CONFIG_NAME: &str = "configs/b21r.ron";
/// The paper without our additions.
const PAPER_CONFIG: &str = include_str!("../../../configs/paper.ron");
const PAPER_CONFIG_NAME: &str = "configs/paper.ron";
/// The robot of the logs in three files.
const FOLDER_CONFIG: &str = include_str!("../../../configs/sonar8.ron");
const FOLDER_CONFIG_NAME: &str = "configs/sonar8.ron";
/// The most cells that a beam, or the robot, may be long: beyond, tables of them fill the memory.
const MOST_CELLS_ALONG: f64 = 1500.0;

/// An error about a file, in one sentence that names it.
pub(crate) fn about<E: Display>(path: &Path) -> impl Fn(E) -> anyhow::Error {
    move |error| anyhow!("{}: {error}", path.display())
}

/// The configuration in a file, or the default; and its name for errors.
pub(crate) fn config(file: Option<&Path>) -> Result<(Config, PathBuf)> {
    config_or(file, (DEFAULT_CONFIG_NAME, DEFAULT_CONFIG))
}

/// The configuration that is the paper's, as far as that can be.
pub(crate) fn paper_config() -> Result<(Config, PathBuf)> {
    config_or(None, (PAPER_CONFIG_NAME, PAPER_CONFIG))
}

/// The configuration in a file, or the default for a folder with a log in three files.
pub(crate) fn folder_config(file: Option<&Path>) -> Result<(Config, PathBuf)> {
    config_or(file, (FOLDER_CONFIG_NAME, FOLDER_CONFIG))
}

/// The configuration in a file, or the default for lasers.
pub(crate) fn laser_config(file: Option<&Path>) -> Result<(Config, PathBuf)> {
    config_or(file, ("configs/laser.ron", include_str!("../../../configs/laser.ron")))
}

fn config_or(file: Option<&Path>, (name, text): (&str, &str)) -> Result<(Config, PathBuf)> {
    let name = file.unwrap_or(Path::new(name));
    let config = match file {
        Some(file) => read_ron(file)?,
        None => parse_ron(name, text)?,
    };
    Ok((config, name.to_owned()))
}

/// The world in a scenario or in a map of map_server. What a file does not say about
/// surfaces is `surface`.
pub(crate) fn world(file: &Path, surface: Surface) -> Result<World> {
    Ok(world_file::read(file, surface)?.world)
}

/// The world of a scenario in a file, turned \[rad\] and shifted \[m\].
pub(crate) fn moved(
    scenario: &Scenario,
    turn: f64,
    shift: (f64, f64),
    (file, surface): (&Path, Surface),
) -> Result<World> {
    // What is wrong with the scenario is said in its own coordinates.
    let world = World::from_scenario(scenario, surface).map_err(about(file))?;
    match placed(scenario, turn, shift) {
        Cow::Borrowed(_) => Ok(world),
        Cow::Owned(moved) => World::from_scenario(&moved, surface).map_err(about(file)),
    }
}

/// A scenario turned \[rad\] and shifted \[m\]: as it is, if both are 0.
pub(crate) fn placed(scenario: &Scenario, turn: f64, shift: (f64, f64)) -> Cow<'_, Scenario> {
    let shift = Vector2::new(shift.0, shift.1);
    if turn == 0.0 && shift == Vector2::zeros() {
        return Cow::Borrowed(scenario);
    }
    Cow::Owned(scenario.moved(turn, shift))
}

/// Checks all sections of a configuration, and that its tables will not be absurdly large.
pub(crate) fn check(config: &Config, name: &Path) -> Result<SensorModel> {
    let (_, model) = config.build().map_err(about(name))?;
    let resolution = config.resolution;
    for (what, length) in
        [("model.usable_range", model.max_reach()), ("robot.radius", config.robot.radius)]
    {
        if length / resolution > MOST_CELLS_ALONG {
            bail!(
                "{}: {what}: {length} m are more than {MOST_CELLS_ALONG} cells of {resolution} m; \
                 use a coarser resolution",
                name.display()
            );
        }
    }
    // The planner checks its parameters when it is made: make one for a single cell.
    let grid = Grid::new(Point2::origin(), config.resolution, 1, 1).map_err(about(name))?;
    memory::check_run(&grid, config, 1).map_err(about(name))?;
    check_planner(config, &model, grid).map_err(about(name))?;
    Ok(model)
}

fn check_planner(config: &Config, model: &SensorModel, grid: Grid) -> Result<(), PlannerError> {
    let outside = Raster::filled(grid, false);
    let planner = Planner::new(&config.planner, model, &outside, config.robot.radius, 0.0);
    planner.map(drop)
}

/// The mission to explore the world in a file.
pub(crate) fn mission(
    (world, file): (&World, &Path),
    (config, name): (&Config, &Path),
    start: Option<Isometry2<f64>>,
    limits: Limits,
) -> Result<Mission> {
    check(config, name)?;
    let grid = world.grid(config.resolution).map_err(about(file))?;
    memory::check_run(&grid, config, 1).map_err(about(file))?;
    covmap_lab::mission(world, config, start, limits).map_err(|error| match error {
        SetupError::Config(error) => about(name)(error),
        error => about(file)(error),
    })
}
