//! The file of a campaign.

use crate::error::{CampaignError, Result};
use covmap_io::read_ron;
use covmap_lab::files::beside;
use covmap_plan::Strategy;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A campaign: every world with every setting, strategy, start and seed. Angles are in degrees.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Name of the campaign.
    pub name: String,
    /// The worlds to explore.
    pub worlds: Vec<NamedWorld>,
    /// The configurations.
    pub settings: Vec<Setting>,
    /// The strategies that choose view-points.
    pub strategies: Vec<Strategy>,
    /// The robot's starts in each world.
    pub starts: Starts,
    /// Seeds of the noise.
    pub seeds: Seeds,
    /// The metrics of the summary: names of columns of `runs.csv`.
    pub metrics: Vec<String>,
    /// Whether the driven path, the places of the scans, and the explored share along the path are kept of
    /// each run.
    #[serde(default)]
    pub keep_paths: bool,
}

/// A world with its name in the results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedWorld {
    /// Name in the results.
    pub name: String,
    /// A scenario, or a map of map_server.
    pub file: PathBuf,
    /// Angle by which a scenario is turned counter-clockwise \[°\].
    #[serde(default)]
    pub turn: f64,
    /// Distances by which a scenario is shifted \[m\], not negative.
    #[serde(default)]
    pub shift: (f64, f64),
    /// Side of a cell \[m\], instead of the configuration's.
    #[serde(default)]
    pub resolution: Option<f64>,
    /// Starts in this world, instead of the campaign's.
    #[serde(default)]
    pub starts: Option<Starts>,
    /// Whether the campaign goes on without this world, with a note, if its file is not there.
    #[serde(default)]
    pub optional: bool,
}

/// A configuration with its name in the results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setting {
    /// Name in the results.
    pub name: String,
    /// File of the configuration.
    pub config: PathBuf,
    /// Distance between scans while driving \[m\]; without it the robot measures at view-points only.
    #[serde(default)]
    pub while_driving: Option<f64>,
    /// The number of scans after which a run ends.
    #[serde(default)]
    pub max_scans: Option<usize>,
    /// Parameters that differ from the file, by their paths, such as `planner.scan_spacing`, in the form of
    /// [`covmap_lab::Config::overridden`].
    #[serde(default)]
    pub overrides: BTreeMap<String, serde_json::Value>,
    /// Strategies of this setting, instead of the campaign's.
    #[serde(default)]
    pub strategies: Option<Vec<Strategy>>,
}

/// Starts of the robot in a world.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Starts {
    /// The scenario's start, or the roomiest place.
    Given,
    /// These poses: metres, metres, degrees.
    Poses(Vec<(f64, f64, f64)>),
    /// Roomy places, drawn by a seed.
    Drawn {
        /// The number of places.
        count: usize,
        /// The seed.
        seed: u64,
    },
}

/// Consecutive seeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seeds {
    /// First seed.
    pub first: u64,
    /// The number of seeds.
    pub count: usize,
}

impl NamedWorld {
    /// Whether the world is a map of map_server, such as of a real building, and no scenario.
    pub fn is_map(&self) -> bool {
        let extension = self.file.extension().unwrap_or_default();
        ["yaml", "yml"].iter().any(|yaml| extension.eq_ignore_ascii_case(yaml))
    }

    /// Whether the campaign goes on without the world.
    pub fn is_left_out(&self) -> bool {
        self.optional && !self.file.exists()
    }
}

impl Campaign {
    /// Reads the file of a campaign; its file names are relative to the file itself.
    ///
    /// # Errors
    /// If the file cannot be read.
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

    /// Replaces the file of a world by another file, which must be there.
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
