//! The file that says what is run.

use crate::error::{CampaignError, Result};
use covmap_io::read_ron;
use covmap_lab::files::beside;
use covmap_plan::Strategy;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Every world with every setting, strategy, start and seed. Angles are in degrees.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// What it is called.
    pub name: String,
    /// Where the robot explores.
    pub worlds: Vec<NamedWorld>,
    /// The configurations.
    pub settings: Vec<Setting>,
    /// How view-points are chosen.
    pub strategies: Vec<Strategy>,
    /// Where it starts in each world.
    pub starts: Starts,
    /// Seeds of the noise.
    pub seeds: Seeds,
    /// What is summarised: names of the columns of `runs.csv`.
    pub metrics: Vec<String>,
    /// Whether the driven path, the places of the scans, and what was explored along the way
    /// are kept of each run.
    #[serde(default)]
    pub keep_paths: bool,
}

/// A world by the name that it has in the results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedWorld {
    /// Its name in the results.
    pub name: String,
    /// A scenario, or a map of map_server.
    pub file: PathBuf,
    /// By how much a scenario is turned \[°\], counter-clockwise.
    #[serde(default)]
    pub turn: f64,
    /// By how much a scenario is shifted \[m\], not negative.
    #[serde(default)]
    pub shift: (f64, f64),
    /// The side of a cell \[m\], instead of the configuration's.
    #[serde(default)]
    pub resolution: Option<f64>,
    /// Starts in this world, instead of the campaign's.
    #[serde(default)]
    pub starts: Option<Starts>,
    /// Whether the campaign goes on without this world, and says so, if its file is not there.
    #[serde(default)]
    pub optional: bool,
}

/// A configuration by the name that it has in the results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setting {
    /// Its name in the results.
    pub name: String,
    /// The configuration.
    pub config: PathBuf,
    /// Measure also on the way, at this distance \[m\].
    #[serde(default)]
    pub while_driving: Option<f64>,
    /// End after this number of scans.
    #[serde(default)]
    pub max_scans: Option<usize>,
    /// Parameters that differ from the file, by their paths, such as `planner.scan_spacing`;
    /// as [`covmap_lab::Config::overridden`] wants them.
    #[serde(default)]
    pub overrides: BTreeMap<String, serde_json::Value>,
    /// Strategies of this setting, instead of the campaign's.
    #[serde(default)]
    pub strategies: Option<Vec<Strategy>>,
}

/// Where the robot starts.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Starts {
    /// Where the scenario says, or in the roomiest place.
    Given,
    /// At these poses: metres, metres, degrees.
    Poses(Vec<(f64, f64, f64)>),
    /// At a number of roomy places, drawn by a seed.
    Drawn {
        /// How many.
        count: usize,
        /// The seed.
        seed: u64,
    },
}

/// A number of seeds, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seeds {
    /// The first.
    pub first: u64,
    /// How many.
    pub count: usize,
}

impl NamedWorld {
    /// Whether it is a map of map_server, such as of a real building, and no scenario.
    pub fn is_map(&self) -> bool {
        let extension = self.file.extension().unwrap_or_default();
        ["yaml", "yml"].iter().any(|yaml| extension.eq_ignore_ascii_case(yaml))
    }

    /// Whether the campaign goes on without it.
    pub fn is_left_out(&self) -> bool {
        self.optional && !self.file.exists()
    }
}

impl Campaign {
    /// Reads the file; what it names is found relative to it.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let mut campaign: Self = read_ron(path)?;
        for world in &mut campaign.worlds {
            world.file = beside(path, &world.file);
        }
        for setting in &mut campaign.settings {
            setting.config = beside(path, &setting.config);
        }
        Ok(campaign)
    }

    /// Takes a world from another file, which must be there.
    ///
    /// # Errors
    /// If the campaign has no world of this name.
    pub fn replace_world(&mut self, name: &str, file: &Path) -> Result<()> {
        match self.worlds.iter_mut().find(|world| world.name == name) {
            Some(world) => {
                world.file = file.to_owned();
                world.optional = false;
                Ok(())
            }
            None => Err(CampaignError::NoSuchWorld(name.to_owned())),
        }
    }
}
