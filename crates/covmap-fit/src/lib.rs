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
//! use covmap::{Cell, Grid};
//! use covmap_fit::{Axis, BodyRecord, Example, FitSettings, Parameter, SearchSettings, Weighting, fit};
//! use covmap_model::ModelParameters;
//! use covmap_sonar::{Range, Scan, SonarRing};
//! use nalgebra::{Isometry2, Point2};
//! use std::ops::ControlFlow;
//!
//! let grid = Grid::new(Point2::origin(), 0.2, 20, 20)?;
//! let pose = Isometry2::translation(2.1, 2.1);
//! let scans = vec![Scan { pose, time: 0.0, ranges: vec![Range::Echo(1.0); 24] }];
//! let example = Example {
//!     name: "a room".into(),
//!     ring: SonarRing::b21r(),
//!     body: BodyRecord::standing(0.27, &scans),
//!     scans,
//!     grid,
//!     truth: vec![(Cell::new(13, 10), 0.0), (Cell::new(15, 10), 1.0)],
//! };
//! let settings = FitSettings {
//!     weighting: Weighting::Classes,
//!     axes: vec![Axis { parameter: Parameter::SigmaIn, from: 0.15, to: 0.6 }],
//!     starts: 1,
//!     search: SearchSettings { evaluations: 8, ..SearchSettings::default() },
//! };
//! let begin = ModelParameters::product();
//! let go_on = |_: &covmap_fit::Evaluation| ControlFlow::Continue(());
//! let fitted = fit(&[example], &begin, &settings, || 0.5, go_on)?;
//! let sigma_in = Parameter::SigmaIn.get(&fitted.parameters).expect("a parameter of Eq. (9)");
//! assert!((0.15..=0.6).contains(&sigma_in));
//! # Ok::<(), Box<dyn std::error::Error>>(())
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
pub use compare::{
    CellMean, ComparisonRow, Contender, Difference, compare, table, trajectory_blocks,
};
pub use covmap::Class;
pub use example::{BodyRecord, Example};
pub use fitting::{Evaluation, FitError, FitSettings, Fitted, Profile, fit, score};
pub use method::{BetaCounting, Crm, LogOdds, Method, Update};
pub use read_out::fit_read_out;
pub use reliability::{EntropyBand, Reliability};
pub use search::{SearchSettings, Step, maximise};
pub use tuning::{MethodParameter, TuneError, TuneSettings, Tuned, score_method, tune};
pub use weighting::Weighting;
