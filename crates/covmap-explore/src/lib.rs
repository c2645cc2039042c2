//! The exploration loop: sense → integrate → choose → drive, to a provable end.
//!
//! Section 5 of Stachniss & Burgard (2003). The principal function is [`explore`]: it takes a
//! [`Mission`] and a [`Robot`], and ends with a certificate that says of every cell why there
//! is nothing left to do.
//!
//! This crate knows nothing of files, terminals and clocks: all that happens is reported to
//! one hook.
//!
//! # Units
//! Metres, radians, nats, seconds of simulated time.
//!
//! ```
//! use covmap_explore::{Config, Ending, Limits, Mission, SimulatedRobot, explore};
//! use covmap_world::{Extent, Scenario, World};
//! use std::ops::ControlFlow;
//!
//! let mut config = Config::b21r();
//! config.resolution = 0.2;
//! let extent = Extent { width: 3.0, height: 2.0 };
//! let scenario = Scenario { name: "room".into(), extent, start: None, obstacles: vec![] };
//! let world = World::from_scenario(&scenario, config.sonar.surface)?;
//! let mission = Mission::new(&world, &config, None, Limits::default())?;
//! let mut robot = SimulatedRobot::new(&world, &config, 1)?;
//! let run = explore(&mission, &mut robot, &mut |_, _| ControlFlow::Continue(()))?;
//! assert_eq!(run.ending, Ending::Explored);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
mod cut_off;
mod memory;
mod mission;
mod overridden;
mod robot;
mod run;
mod score;
mod series;
mod summary;
mod trace;

pub use config::{Config, ConfigError, RobotParameters};
pub use cut_off::CutOff;
pub use memory::run_bytes;
pub use mission::{Limits, Mission, MissionError, standing_place};
pub use overridden::OverrideError;
pub use robot::{RecordedRobot, Robot, SimulatedRobot};
pub use run::{Ending, Run, View, explore};
pub use score::{Score, Truth};
pub use series::{Accuracy, Errors, Measurements, Tally, corners, drawn_starts};
pub use summary::{CellCounts, Summary};
pub use trace::{Event, TRACE_VERSION, TraceHasher, TraceHeader};
