//! The numbers of a run.

use crate::{CutOff, Score};
use covmap_explore::{Ending, Parameters, Run};
use covmap_plan::CellStatus;
use serde::{Deserialize, Serialize};

/// How many cells the certificate puts where.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CellCounts {
    /// Known with an entropy of at most ε.
    pub resolved: usize,
    /// Their entropy did not fall any longer.
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

/// What `summary.json` holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The world's name.
    pub world: String,
    /// The strategy as in Fig. 7.
    pub strategy: String,
    /// How a reading changed the belief: the name of the update.
    pub update: String,
    /// The seed of the noise.
    pub seed: u64,
    /// r \[m\].
    pub resolution: f64,
    /// How it ended.
    pub ending: Ending,
    /// Number of scans, of all beams each.
    pub scans: usize,
    /// Number of decisions.
    pub decisions: usize,
    /// Number of bumps.
    pub bumps: usize,
    /// Length of the driven path \[m\].
    pub path_length_m: f64,
    /// How far it turned on the way: the angles between one piece of the path and the next, summed up
    /// \[rad\].
    pub turns_rad: f64,
    /// The certificate in numbers.
    pub cells: CellCounts,
    /// How good the map is.
    #[serde(flatten)]
    pub score: Score,
    /// What was left unseen of what the robot could truly reach.
    pub cut_off: CutOff,
    /// Candidates with E\[I\] < 0, over all decisions.
    pub negative_gains: usize,
    /// Cells given up by the cap on counted scans.
    pub capped_cells: usize,
    /// Time of the run \[s\], by whoever has a clock.
    pub seconds: f64,
    /// A hash over the trace and the belief; the same for the same run.
    pub trace_hash: String,
}

impl Summary {
    /// The numbers of a run.
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
