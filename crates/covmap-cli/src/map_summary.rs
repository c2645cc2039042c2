//! The numbers of a map.

use covmap_log::Readings;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The content of `summary.json`: the keys of an exploration that apply.
#[derive(Debug, Serialize)]
pub(crate) struct MapSummary {
    /// The name of the log.
    pub(crate) world: String,
    pub(crate) sensor: &'static str,
    /// r \[m\].
    pub(crate) resolution: f64,
    /// The frames of the log: skipped, standing, or scans of the map.
    pub(crate) frames: usize,
    pub(crate) skipped: usize,
    pub(crate) standing: usize,
    pub(crate) scans: usize,
    /// The number of jumps of the poses, over which the way is unknown.
    pub(crate) jumps: usize,
    pub(crate) path_length_m: f64,
    pub(crate) cells: CellCounts,
    /// Share of the known cells, without those that the body pinned, with an entropy above .65.
    pub(crate) share_entropy_above_0_65: f64,
    /// The read-out behind this share, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) read_out: Option<PathBuf>,
    pub(crate) seconds: f64,
    /// All readings of the log, by the tag of their lines.
    pub(crate) readings: BTreeMap<&'static str, Readings>,
    /// The numbers that the map depends on, with their sources.
    pub(crate) taken_from: Vec<String>,
    /// Further remarks about the log.
    pub(crate) remarks: Vec<String>,
    /// The parts of the log that were lost, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) warning: Option<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct CellCounts {
    pub(crate) known: usize,
    pub(crate) unknown: usize,
}
