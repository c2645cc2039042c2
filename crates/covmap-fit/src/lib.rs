//! Tuning the sensor model: the parameters under which the map explains the truth best.
//!
//! Section 3 of Stachniss & Burgard (2003), last paragraph: the maximum of the likelihood of
//! the true coverages, found by local search. The principal function is [`fit`]: it takes
//! [`Example`]s (scans, and the truth of some cells), the [`Axis`] of every free parameter,
//! and the parameters to begin with.
//!
//! This crate knows nothing of simulated worlds and of files: the truth is given, cell by
//! cell.
//!
//! # Units
//! Metres, radians, nats.
//!
//! ```
//! use covmap_fit::{Axis, Parameter};
//! use covmap_model::ModelParameters;
//!
//! let axis = Axis { parameter: Parameter::SigmaIn, from: 0.15, to: 0.5 };
//! let mut parameters = ModelParameters::b21r();
//! axis.set(&mut parameters, 1.0);
//! assert!((parameters.sigma_in - 0.5).abs() < 1e-12);
//! ```

mod axis;
mod example;
mod fitting;
mod search;

pub use axis::{Axis, AxisError, Parameter};
pub use example::{ClassScore, Example, ExampleScore};
pub use fitting::{Evaluation, FitError, FitSettings, Fitted, Profile, Weighting, fit, score};
pub use search::{SearchSettings, Step, maximise};
