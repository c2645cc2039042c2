//! Where to measure next, and when all is explored.
//!
//! Section 4 of Stachniss & Burgard (2003), equations (11)–(16). The principal type is
//! [`Planner`]: it is told what each scan changed, and chooses the next view-point by one of
//! the paper's [`Strategy`]s.
//!
//! This crate knows nothing of the world: a planner cannot see the truth.
//!
//! # Units
//! Metres, radians, nats.
//!
//! ```
//! use covmap_plan::Strategy;
//!
//! let strategy: Strategy = "IG_CL:0.3".parse()?;
//! assert_eq!(strategy, Strategy::IgCl { alpha: 0.3 });
//! assert_eq!(strategy.to_string(), "IG_CL(.3)");
//! # Ok::<(), covmap_plan::StrategyError>(())
//! ```

mod beam_cache;
mod cells;
mod certificate;
mod deciding;
mod decision;
mod exploration;
mod gain;
mod look_ahead;
mod measured;
mod memory;
mod onlookers;
mod parameters;
mod passage;
mod planner;
mod range_likelihood;
mod stencil;
mod strategy;
mod travel_cost;
mod traversable;
mod view_points;
mod window;

pub use certificate::Reach;
pub use decision::{CandidateRecord, Decision};
pub use exploration::CellStatus;
pub use gain::expected_information_gain;
pub use memory::planner_bytes;
pub use parameters::{BodyEvidence, PlannerError, PlannerParameters, Scope, StallRule};
pub use planner::{GAIN_TOLERANCE, Planner};
pub use range_likelihood::{RangeLikelihood, range_likelihood, reflection};
pub use stencil::{BeamStencil, Stencil, StencilCell};
pub use strategy::{Strategy, StrategyError};
pub use travel_cost::{TravelCosts, travel_costs};
