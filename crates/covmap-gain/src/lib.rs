//! The cells in sight of every view-point, and the information gain that is expected there.
//!
//! Section 4 of Stachniss & Burgard (2003), equations (13) and (14). The principal type is
//! [`GainCache`]: the caller tells it which cells of the map changed, and it returns the cells in
//! sight of a view-point and the gain that is expected there. [`expected_information_gain`] is the
//! same gain by the equations as printed.
//!
//! This crate knows neither the world nor the choice of a view-point.
//!
//! # Units
//! Metres, radians, nats.
//!
//! ```
//! use covmap::Grid;
//! use covmap_gain::{GainCache, InformationGain, RangePrediction, Upkeep, ViewPoints};
//! use covmap_model::{ModelParameters, SensorModel};
//! use covmap_sonar::SonarRing;
//! use nalgebra::Point2;
//!
//! let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.2)?;
//! let grid = Grid::new(Point2::origin(), 0.2, 40, 30)?;
//! let prediction = RangePrediction {
//!     gain: InformationGain::Eq14,
//!     unknown_reflection: 0.0,
//!     uniform_share: 0.0,
//!     novelty: 1.0,
//! };
//! let mut gains = GainCache::new(&model, 0.0, grid, prediction, Upkeep::Kept)?;
//! gains.refresh_gains(&ViewPoints::one(&grid, 620));
//! assert!(gains.gain(620) > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod literal;
mod range_likelihood;
mod stencil;

mod belief;
mod numbers;
mod sight;
mod view_points;

mod probes;
mod product;

mod evaluator;
mod outcomes;

mod cache;
mod cause;

mod evidence;
mod largest;
mod layout;
mod memory;
mod upkeep;

pub use cache::{GAIN_TOLERANCE, GainCache};
pub use layout::{MemoryLayout, PlaneLayout};
pub use literal::{expected_changes, expected_information_gain, imagined_causes};
pub use product::{RangeInterpolation, TableErrors};
pub use range_likelihood::{
    InformationGain, RangeLikelihood, RangePrediction, range_likelihood, reflection,
};
pub use sight::NEGLIGIBLE;
pub use stencil::{BeamError, BeamStencil, Stencil, StencilCell};
pub use upkeep::Upkeep;
pub use view_points::ViewPoints;
