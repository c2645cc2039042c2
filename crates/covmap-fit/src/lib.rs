//! Tuning the sensor model: the parameters under which the map explains the truth best.
//!
//! Section 3 of Stachniss & Burgard (2003), last paragraph: [`fit`] seeks the maximum of the
//! likelihood of the true coverages of [`Example`]s, by local search along each free [`Axis`].
//! [`compare`] measures how well other methods explain the truth, tuned alike by [`tune`].
//!
//! This crate knows neither simulated worlds nor files: the caller gives the truth, cell by cell.
//!
//! # Units
//! Metres, radians, nats.
//!
//! ```
//! let axis = covmap_fit::Axis { parameter: covmap_fit::Parameter::SigmaIn, from: 0.15, to: 0.5 };
//! let mut parameters = covmap_model::ModelParameters::product();
//! axis.set(&mut parameters, 1.0);
//! assert_eq!(axis.parameter.get(&parameters), Some(0.5));
//! ```

mod ascent;
mod axis;
mod class;
mod class_score;
mod compare;
mod example;
mod fitting;
mod method;
mod read_out;
mod reliability;
mod search;
mod tuning;
mod weighting;

pub use axis::{Axis, AxisError, Parameter};
pub use class::ByClass;
pub use class_score::{ClassScore, ExampleScore};
pub use compare::{CALIBRATION_LEVELS, CalibrationTable, ClassComparison, ComparisonSettings};
pub use compare::{CellMean, Contender, Difference, Row, compare, table, trajectory_blocks};
pub use covmap::Class;
pub use example::{BodyRecord, Example};
pub use fitting::{Evaluation, FitError, FitSettings, Fitted, Profile, fit, score};
pub use method::{BetaCounting, Crm, LogOdds, Method, Update};
pub use read_out::fit_read_out;
pub use reliability::{EntropyBand, Reliability};
pub use search::{SearchSettings, Step, maximise};
pub use tuning::{MethodParameter, TuneError, TuneSettings, Tuned, score_method, tune};
pub use weighting::Weighting;
