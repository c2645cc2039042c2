//! The paper's claims, in their order: each a small function from data to its tests.
//!
//! Numbers and thresholds were written before any result was seen. Claim 18, that every run
//! ends, is no verdict but a test of the planner.

mod counting;
mod explored;
mod meeting;
mod model;
mod places;
mod strategies;
mod trade_off;

use super::fitting::Fitting;
use super::limits::Limits;
use super::oblique::Oblique;
use super::runs::Runs;
use super::trial::Finding;
use crate::figures::partial_cells::PartialCell;
use covmap_model::SensorModel;
use covmap_plan::Strategy;
use explored::explored;

/// All that the claims are judged by, for one configuration.
#[derive(Debug)]
pub(crate) struct Evidence {
    /// A cell that is covered 20 %, four times (Fig. 1, 2).
    pub(crate) cells: Vec<PartialCell>,
    /// The sensor model (Fig. 3).
    pub(crate) model: SensorModel,
    /// A fit on small simulated worlds.
    pub(crate) fitting: Fitting,
    /// Oblique walls.
    pub(crate) oblique: Oblique,
    /// The corridor, measured while driving (Table 1, Fig. 5).
    pub(crate) corridor: Runs,
    /// Scan counting up to n (Fig. 6).
    pub(crate) counting: Runs,
    /// All strategies, measuring at view-points only (Fig. 7).
    pub(crate) at_view_points: Runs,
    /// All strategies, measuring while driving.
    pub(crate) while_driving: Runs,
    /// Strategies in other worlds.
    pub(crate) places: Runs,
    /// Those of these worlds that are maps of map_server.
    pub(crate) maps: Vec<String>,
    /// The ends of IG_CL.
    pub(crate) limits: Limits,
    /// How fast the robot drives \[m/s\].
    pub(crate) speed: f64,
}

/// Claims 1–17 and 19–21.
pub(crate) fn all(e: &Evidence) -> Vec<Finding> {
    vec![
        model::claim_1(&e.cells),
        model::claim_2(&e.cells),
        model::claim_3(&e.model),
        model::claim_4(&e.fitting),
        counting::claim_5(&e.corridor),
        counting::claim_6(&e.corridor),
        counting::claim_7(&e.corridor),
        meeting::claim_8(&e.counting),
        counting::claim_9(&e.corridor),
        strategies::claim_10(&e.at_view_points),
        strategies::claim_11(&e.at_view_points),
        strategies::claim_12(&e.at_view_points),
        strategies::claim_13(&e.at_view_points, &e.while_driving),
        strategies::claim_14(&e.at_view_points, &e.while_driving),
        trade_off::claim_15(&e.at_view_points, &e.while_driving),
        trade_off::claim_16(&e.limits, &e.at_view_points),
        places::claim_17(&e.at_view_points, &e.places).note(places::buildings(&e.maps)),
        strategies::claim_19(&e.while_driving, e.speed),
        counting::claim_20(&e.corridor),
        model::claim_21(&e.oblique),
    ]
}

/// Names of the metrics of a run.
const SCANS: &str = "scans";
const PATH: &str = "path_length_m";
const COMPLETENESS: &str = "completeness";

pub(crate) use counting::{MOST_COUNTS, measured_until_explored};

/// Extended counting with n = 50, as in Table 1.
pub(crate) const EXTENDED: Strategy = Strategy::Count { times: 50.0, half_distance: Some(2.0) };
/// Counting with n = 1.
pub(crate) const ONCE: Strategy = Strategy::Count { times: 1.0, half_distance: None };
