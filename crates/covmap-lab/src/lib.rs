//! The laboratory: robots in simulated worlds, the truth about these, and scores against it.
//!
//! Section 5 of Stachniss & Burgard (2003). [`mission`] sets a robot into a world, [`SimulatedRobot`] senses
//! and drives there for [`covmap_explore::explore`], and [`Truth`] scores the map of the run.
//!
//! This crate does not depend on terminals or clocks.
//!
//! # Units
//! Metres, radians, nats, seconds of simulated time.
//!
//! ```
//! use covmap_explore::{Ending, Limits, explore};
//! use covmap_lab::{Config, SimulatedRobot, mission};
//! use covmap_world::{Extent, Scenario, World};
//! use std::ops::ControlFlow;
//!
//! let mut config = Config::b21r();
//! config.resolution = 0.2;
//! let extent = Extent { width: 3.0, height: 2.0 };
//! let scenario = Scenario { name: "room".into(), extent, start: None, obstacles: vec![] };
//! let world = World::from_scenario(&scenario, config.sonar.surface)?;
//! let mission = mission(&world, &config, None, Limits::default())?;
//! let mut robot = SimulatedRobot::new(&world, &config, 1)?;
//! let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(()))?;
//! assert_eq!(run.ending, Ending::Explored);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
mod cut_off;
mod echo;
mod error;
mod experiment;
pub mod files;
mod fit_file;
mod log_map;
pub mod memory;
mod overridden;
mod read_out;
mod recorded;
mod replay;
pub mod results;
mod robot;
mod run_bag;
mod run_path;
mod score;
mod series;
mod setup;
mod summary;
mod trace;
mod trace_file;
mod watch;

pub use config::{Config, ConfigError};
pub use cut_off::CutOff;
pub use echo::{echo_distances, echo_table};
pub use error::{Fault, LabError, MemoryError, Result, about};
pub use experiment::Experiment;
pub use fit_file::{FitFile, FitPlan, Named, Simulated, Source};
pub use log_map::{Log, LogOverview, Mapper, Stride};
pub use memory::run_bytes;
pub use overridden::OverrideError;
pub use read_out::Reader;
pub use recorded::{Frames, Recorded, frames};
pub use replay::{Moment, replay};
pub use robot::SimulatedRobot;
pub use run_bag::write_run_bag;
pub use run_path::RunPath;
pub use score::{Score, Truth};
pub use series::{Accuracy, Errors, Measurements, Tally, corners, drawn_starts};
pub use setup::{SetupError, mission};
pub use summary::{CellCounts, Summary};
pub use trace::{OLDEST_TRACE, TRACE_VERSION, TraceHeader};
pub use trace_file::{Trace, TraceWriter, in_folder, read_header};
pub use watch::Watch;
