//! The paper's claims, in their order: each a small function from data to its tests.
//!
//! Numbers and thresholds were written before any result was seen. Claim 18, that every run ends,
//! has no verdict; a test of the planner checks it.

mod counting;
mod explored;
mod meeting;
mod model;
mod places;
mod strategies;
mod trade_off;

pub use counting::{claim_5, claim_6, claim_7, claim_9, claim_20};
pub use meeting::claim_8;
pub use model::{claim_1, claim_2, claim_3, claim_4, claim_21};
pub use places::claim_17;
pub use strategies::{claim_10, claim_11, claim_12, claim_13, claim_14, claim_19};
pub use trade_off::{claim_15, claim_16};

use crate::fitting::Fitting;
use crate::limits::Limits;
use crate::oblique::Oblique;
use crate::partial_cells::PartialCell;
use crate::runs::Runs;
use crate::trial::Finding;
use covmap_model::SensorModel;
use explored::explored;

/// The evidence for the claims, for one configuration.
#[derive(Debug)]
pub struct Evidence {
    /// A cell with a coverage of 20 %, four times (Fig. 1, 2).
    pub cells: Vec<PartialCell>,
    /// The sensor model (Fig. 3).
    pub model: SensorModel,
    /// A fit on small simulated worlds.
    pub fitting: Fitting,
    /// Oblique walls.
    pub oblique: Oblique,
    /// The corridor, measured while driving (Table 1, Fig. 5).
    pub corridor: Runs,
    /// Runs of scan counting up to n (Fig. 6).
    pub counting: Runs,
    /// Runs of all strategies, measuring at view-points only (Fig. 7).
    pub at_view_points: Runs,
    /// Runs of all strategies, measuring while driving.
    pub while_driving: Runs,
    /// Runs of strategies in other worlds.
    pub places: Runs,
    /// The names of the worlds among `places` that are maps of map_server.
    pub maps: Vec<String>,
    /// The ends of IG_CL, CL and IG.
    pub limits: Limits,
    /// The robot's speed \[m/s\].
    pub speed: f64,
}

/// Returns the findings of claims 1–17 and 19–21.
pub fn all(e: &Evidence) -> Vec<Finding> {
    vec![
        claim_1(&e.cells),
        claim_2(&e.cells),
        claim_3(&e.model),
        claim_4(&e.fitting),
        claim_5(&e.corridor),
        claim_6(&e.corridor),
        claim_7(&e.corridor),
        claim_8(&e.counting),
        claim_9(&e.corridor),
        claim_10(&e.at_view_points),
        claim_11(&e.at_view_points),
        claim_12(&e.at_view_points),
        claim_13(&e.at_view_points, &e.while_driving),
        claim_14(&e.at_view_points, &e.while_driving),
        claim_15(&e.at_view_points, &e.while_driving),
        claim_16(&e.limits, &e.at_view_points),
        claim_17(&e.at_view_points, &e.places).note(places::buildings(&e.maps)),
        claim_19(&e.while_driving, e.speed),
        claim_20(&e.corridor),
        claim_21(&e.oblique),
    ]
}
