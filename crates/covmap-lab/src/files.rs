//! Worlds and configurations from files.

mod kind;
mod world_file;

pub use world_file::{Remarks, WorldFile, map, read, remarks, scenario};

use crate::error::{Fault, LabError, Result, about};
use crate::memory;
use crate::{Config, SetupError};
use covmap::{Grid, Raster};
use covmap_explore::{Limits, Mission};
use covmap_io::{parse_ron, read_ron};
use covmap_model::SensorModel;
use covmap_plan::{Planner, PlannerError};
use covmap_world::{Scenario, Surface, World};
use nalgebra::{Isometry2, Point2, Vector2};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Largest length of a beam or of the robot's radius, in cells: tables of more would fill the memory.
const MOST_CELLS_ALONG: f64 = 1500.0;

/// A configuration that is built into a program, which so works in any folder.
#[derive(Debug, Clone, Copy)]
pub struct BuiltIn {
    /// Name for errors.
    pub name: &'static str,
    /// Text in RON.
    pub text: &'static str,
}

/// Reads the configuration in a file, or the built-in one if there is no file; also returns its name
/// for errors.
///
/// # Errors
/// If the configuration cannot be read.
pub fn config(file: Option<&Path>, or: BuiltIn) -> Result<(Config, PathBuf)> {
    match file {
        Some(file) => Ok((read_ron(file)?, file.to_owned())),
        None => Ok((parse_ron(Path::new(or.name), or.text)?, or.name.into())),
    }
}

/// Returns the path of a file that another file names.
pub fn beside(path: &Path, named: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).join(named)
}

/// Reads the world in a scenario or in a map of map_server. `surface` is the surface of everything
/// without one in the file.
///
/// # Errors
/// If the file is no world.
pub fn world(file: &Path, surface: Surface) -> Result<World> {
    Ok(read(file, surface)?.world)
}

/// Returns the world of a scenario in a file, turned \[rad\] and shifted \[m\].
///
/// # Errors
/// If the scenario is impossible.
pub fn moved(
    scenario: &Scenario,
    turn: f64,
    shift: (f64, f64),
    (file, surface): (&Path, Surface),
) -> Result<World> {
    // Errors name places in the scenario's own coordinates.
    let world = World::from_scenario(scenario, surface).map_err(about(file))?;
    match placed(scenario, turn, shift) {
        Cow::Borrowed(_) => Ok(world),
        Cow::Owned(moved) => World::from_scenario(&moved, surface).map_err(about(file)),
    }
}

/// Returns a scenario turned \[rad\] and shifted \[m\]; as it is if both are 0.
pub fn placed(scenario: &Scenario, turn: f64, shift: (f64, f64)) -> Cow<'_, Scenario> {
    let shift = Vector2::new(shift.0, shift.1);
    if turn == 0.0 && shift == Vector2::zeros() {
        return Cow::Borrowed(scenario);
    }
    Cow::Owned(scenario.moved(turn, shift))
}

/// Checks all sections of a configuration, and that its tables will not be absurdly large.
///
/// # Errors
/// If anything is wrong with the configuration.
pub fn check(config: &Config, name: &Path) -> Result<SensorModel> {
    check_config(config).map_err(in_file(name))
}

/// Checks a configuration without a file.
pub(crate) fn check_config(config: &Config) -> Result<SensorModel> {
    let (_, model) = config.build()?;
    let resolution = config.resolution;
    for (field, length) in
        [("model.usable_range", model.max_reach()), ("robot.radius", config.robot.radius)]
    {
        if length / resolution > MOST_CELLS_ALONG {
            return Err(
                Fault::TooManyCells { field, length, most: MOST_CELLS_ALONG, resolution }.into()
            );
        }
    }
    // A planner checks its parameters when it is made: make one for a single cell.
    let grid = Grid::new(Point2::origin(), config.resolution, 1, 1)?;
    memory::check_run(&grid, config, 1)?;
    check_planner(config, &model, grid).map_err(Fault::from)?;
    Ok(model)
}

fn check_planner(config: &Config, model: &SensorModel, grid: Grid) -> Result<(), PlannerError> {
    let outside = Raster::filled(grid, false);
    let planner = Planner::new(&config.planner, model, &outside, config.robot.radius, 0.0);
    planner.map(drop)
}

/// Returns the mission to explore the world in a file, with the configuration in another file.
///
/// # Errors
/// If the configuration is invalid, or the robot cannot stand at the start.
pub fn mission(
    (world, file): (&World, &Path),
    (config, name): (&Config, &Path),
    start: Option<Isometry2<f64>>,
    limits: Limits,
) -> Result<Mission> {
    check(config, name)?;
    let grid = world.grid(config.resolution).map_err(about(file))?;
    memory::check_run(&grid, config, 1).map_err(in_file(file))?;
    crate::mission(world, config, start, limits).map_err(|error| match error {
        SetupError::Config(error) => about(name)(error),
        error => about(file)(error),
    })
}

/// Names the file in an error without a file.
pub(crate) fn in_file(file: &Path) -> impl Fn(LabError) -> LabError {
    move |error| match error {
        LabError::Fault(fault) => about(file)(fault),
        other => other,
    }
}
