//! The numbers of a run.

use crate::{CutOff, Score};
use covmap_explore::{Ending, Parameters, Run};
use covmap_plan::CellStatus;
use serde::{Deserialize, Serialize};

/// The number of cells with each status of a certificate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellCounts {
    /// Known with an entropy of at most ε.
    pub resolved: usize,
    /// Given up: the entropy did not fall any longer.
    pub exhausted: usize,
    /// In sight of a reachable view-point.
    pub open: usize,
    /// Out of sight.
    pub unreachable: usize,
    /// Not in sight yet, when the run was stopped.
    pub not_seen: usize,
    /// Outside the extent.
    pub outside: usize,
}

impl CellCounts {
    /// Counts the cells of a certificate.
    pub fn of(certificate: &[CellStatus]) -> Self {
        let count = |status| certificate.iter().filter(|s| **s == status).count();
        Self {
            resolved: count(CellStatus::Resolved),
            exhausted: count(CellStatus::Exhausted),
            open: count(CellStatus::Open),
            unreachable: count(CellStatus::Unreachable),
            not_seen: count(CellStatus::NotSeen),
            outside: count(CellStatus::Outside),
        }
    }
}

/// The content of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the world.
    pub world: String,
    /// Spelling of the strategy, such as `IG_CL:0.3`.
    pub strategy: String,
    /// Name of the update, by which readings changed the belief.
    pub update: String,
    /// Seed of the noise.
    pub seed: u64,
    /// r \[m\].
    pub resolution: f64,
    /// The ending.
    pub ending: Ending,
    /// The number of scans, of all beams each.
    pub scans: usize,
    /// The number of decisions.
    pub decisions: usize,
    /// The number of bumps.
    pub bumps: usize,
    /// Length of the driven path \[m\].
    pub path_length_m: f64,
    /// Sum of the turns \[rad\]: the angles between each piece of the path and the next.
    pub turns_rad: f64,
    /// The certificate in numbers.
    pub cells: CellCounts,
    /// Score of the map.
    #[serde(flatten)]
    pub score: Score,
    /// Truly reachable cells that the robot never knew to be free.
    pub cut_off: CutOff,
    /// The number of candidates with E\[I\] < 0, over all decisions.
    pub negative_gains: usize,
    /// The number of cells given up by the cap on counted scans.
    pub capped_cells: usize,
    /// Time of the run \[s\], by the caller's clock.
    pub seconds: f64,
    /// Hash over the trace and the belief; equal runs have equal hashes.
    pub trace_hash: String,
}

impl Summary {
    /// Returns the numbers of a run.
    pub fn new(
        world: &str,
        (parameters, seed): (&Parameters, u64),
        run: &Run,
        (score, cut_off): (&Score, CutOff),
        seconds: f64,
        trace_hash: String,
    ) -> Self {
        Self {
            world: world.to_owned(),
            strategy: parameters.planner.strategy.to_string(),
            update: parameters.model.update.name().to_owned(),
            seed,
            resolution: run.map.grid().resolution(),
            ending: run.ending,
            scans: run.scans.len(),
            decisions: run.decisions,
            bumps: run.bumped_at.len(),
            path_length_m: run.path_length,
            turns_rad: run.turns(),
            cells: CellCounts::of(run.certificate.values()),
            score: *score,
            cut_off,
            negative_gains: run.negative_gains,
            capped_cells: run.capped_cells,
            seconds,
            trace_hash,
        }
    }
}
