//! The numbers of a map.

use covmap_log::Readings;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What `summary.json` holds: of the keys of an exploration those that apply.
#[derive(Debug, Serialize)]
pub(crate) struct MapSummary {
    /// The log's name.
    pub(crate) world: String,
    pub(crate) sensor: &'static str,
    /// r \[m\].
    pub(crate) resolution: f64,
    /// Frames of the log: skipped, standing, or scans of the map.
    pub(crate) frames: usize,
    pub(crate) skipped: usize,
    pub(crate) standing: usize,
    pub(crate) scans: usize,
    /// Places where the poses jump, so that nobody knows the way.
    pub(crate) jumps: usize,
    pub(crate) path_length_m: f64,
    pub(crate) cells: CellCounts,
    /// The share of the known cells that the body did not pin with an entropy above .65.
    pub(crate) share_entropy_above_0_65: f64,
    /// The read-out through which that is, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) read_out: Option<PathBuf>,
    pub(crate) seconds: f64,
    /// All readings of the log, by the lines that they stand in.
    pub(crate) readings: BTreeMap<&'static str, Readings>,
    /// What the map depends on, and what says so.
    pub(crate) taken_from: Vec<String>,
    /// What else there is to know of the log.
    pub(crate) remarks: Vec<String>,
    /// What was lost of the log, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) warning: Option<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct CellCounts {
    pub(crate) known: usize,
    pub(crate) unknown: usize,
}
