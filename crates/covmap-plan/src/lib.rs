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
//! use covmap::{Cell, CoverageMap, Grid, Raster};
//! use covmap_model::{ModelParameters, SensorModel, integrate, integrate_body};
//! use covmap_plan::{Planner, PlannerParameters};
//! use covmap_sonar::{Range, Scan, SonarRing};
//! use nalgebra::{Isometry2, Point2};
//!
//! let (ring, grid) = (SonarRing::b21r(), Grid::new(Point2::origin(), 0.2, 20, 20)?);
//! let model = SensorModel::new(&ModelParameters::b21r(), &ring, 0.2)?;
//! let parameters = PlannerParameters { strategy: "IG_CL:0.3".parse()?, ..PlannerParameters::standard() };
//! let mut planner = Planner::new(&parameters, &model, &Raster::filled(grid, false), 0.27, 0.0)?;
//! let mut map = CoverageMap::new(grid, 11)?;
//! let (home, at) = (Cell::new(10, 10), grid.center(Cell::new(10, 10)));
//! let changes = integrate_body(&mut map, at, at, 0.27);
//! planner.body_moved(&map, at, at, &changes);
//! planner.stand_on(home);
//!
//! let pose = Isometry2::translation(at.x, at.y);
//! let scan = Scan { pose, time: 0.0, ranges: vec![Range::Echo(1.5); 24] };
//! let changes = integrate(&model, &mut map, &scan);
//! planner.observe(&map, &scan, &changes);
//! let decision = planner.choose(&map, home).expect("something is open");
//! assert!(decision.best[0].gain > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
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
