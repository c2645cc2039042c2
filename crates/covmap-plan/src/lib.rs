//! Planning: where to measure next, and when all is explored.
//!
//! Section 4 of Stachniss & Burgard (2003), equations (11), (12), (15) and (16); `covmap-gain`
//! evaluates the expected information gain. The principal type is [`Planner`]: it takes over what
//! each scan changed, and chooses the next view-point by one of the paper's [`Strategy`]s.
//!
//! This crate does not depend on the world: a planner cannot see the truth.
//!
//! # Units
//! Metres, radians, nats.
//!
//! ```
//! use covmap_plan::Strategy;
//!
//! let strategy: Strategy = "IG_CL:0.3".parse()?;
//! assert_eq!(strategy, Strategy::IgCl { alpha: 0.3 });
//! assert_eq!(strategy.to_string(), "IG_CL:0.3");
//! # Ok::<(), covmap_plan::StrategyError>(())
//! ```

mod candidate;
mod certificate;
mod deciding;
mod decision;
mod exploration;
mod ground;
mod measured;
mod memory;
mod parameters;
mod passage;
mod planner;
mod reach;
mod scoring;
mod strategy;
mod travel_cost;
mod traversable;
mod turning;
mod window;
mod windowed;

pub use candidate::{CandidateRecord, Decision};
pub use certificate::Promise;
pub use exploration::CellStatus;
pub use memory::planner_bytes;
pub use parameters::{
    BodyEvidence, Effort, InPlace, PlannerError, PlannerParameters, Reason, Scope, StallRule,
};
pub use planner::Planner;
pub use reach::Reach;
pub use scoring::{Scoring, Situation};
pub use strategy::{Strategy, StrategyError};
pub use travel_cost::{TravelCosts, travel_costs};
pub use turning::turns;
