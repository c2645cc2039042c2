//! The file that says what is run.

use crate::fit_file::beside;
use anyhow::{Result, bail};
use covmap_io::read_ron;
use covmap_plan::Strategy;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Every world with every setting, strategy, start and seed. Angles are in degrees.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Campaign {
    /// What it is called.
    pub(crate) name: String,
    /// Where the robot explores.
    pub(crate) worlds: Vec<NamedWorld>,
    /// The configurations.
    pub(crate) settings: Vec<Setting>,
    /// How view-points are chosen.
    pub(crate) strategies: Vec<Strategy>,
    /// Where it starts in each world.
    pub(crate) starts: Starts,
    /// Seeds of the noise.
    pub(crate) seeds: Seeds,
    /// What is summarised: names of the columns of `runs.csv`.
    pub(crate) metrics: Vec<String>,
    /// Whether the driven path, the places of the scans, and what was explored along the way
    /// are kept of each run.
    #[serde(default)]
    pub(crate) keep_paths: bool,
}

/// A world by the name that it has in the results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NamedWorld {
    /// Its name in the results.
    pub(crate) name: String,
    /// A scenario, or a map of map_server.
    pub(crate) file: PathBuf,
    /// By how much a scenario is turned \[°\], counter-clockwise.
    #[serde(default)]
    pub(crate) turn: f64,
    /// By how much a scenario is shifted \[m\], not negative.
    #[serde(default)]
    pub(crate) shift: (f64, f64),
    /// The side of a cell \[m\], instead of the configuration's.
    #[serde(default)]
    pub(crate) resolution: Option<f64>,
    /// Starts in this world, instead of the campaign's.
    #[serde(default)]
    pub(crate) starts: Option<Starts>,
    /// Whether the campaign goes on without this world, and says so, if its file is not there.
    #[serde(default)]
    pub(crate) optional: bool,
}

/// A configuration by the name that it has in the results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Setting {
    /// Its name in the results.
    pub(crate) name: String,
    /// The configuration.
    pub(crate) config: PathBuf,
    /// Measure also on the way, at this distance \[m\].
    #[serde(default)]
    pub(crate) while_driving: Option<f64>,
    /// End after this number of scans.
    #[serde(default)]
    pub(crate) max_scans: Option<usize>,
    /// Parameters that differ from the file, by their paths, such as `planner.scan_spacing`;
    /// as [`covmap_lab::Config::overridden`] wants them.
    #[serde(default)]
    pub(crate) overrides: BTreeMap<String, serde_json::Value>,
    /// Strategies of this setting, instead of the campaign's.
    #[serde(default)]
    pub(crate) strategies: Option<Vec<Strategy>>,
}

/// Where the robot starts.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum Starts {
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
pub(crate) struct Seeds {
    /// The first.
    pub(crate) first: u64,
    /// How many.
    pub(crate) count: usize,
}

impl NamedWorld {
    /// Whether it is a map of map_server, such as of a real building, and no scenario.
    pub(crate) fn is_map(&self) -> bool {
        let extension = self.file.extension().unwrap_or_default();
        ["yaml", "yml"].iter().any(|yaml| extension.eq_ignore_ascii_case(yaml))
    }

    /// Whether the campaign goes on without it.
    pub(crate) fn is_left_out(&self) -> bool {
        self.optional && !self.file.exists()
    }
}

impl Campaign {
    /// Reads the file; what it names is found relative to it.
    pub(crate) fn read(path: &Path) -> Result<Self> {
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
    pub(crate) fn replace_world(&mut self, name: &str, file: &Path) -> Result<()> {
        match self.worlds.iter_mut().find(|world| world.name == name) {
            Some(world) => {
                world.file = file.to_owned();
                world.optional = false;
                Ok(())
            }
            None => bail!("--world: the campaign has no world called {name:?}"),
        }
    }
}
