//! The exploration loop: sense → integrate → choose → drive, to a provable end.
//!
//! Section 5 of Stachniss & Burgard (2003). The principal function is [`explore`]: it takes a
//! [`Mission`] and a [`Robot`], and ends with a certificate that gives the reason why each cell needs
//! no further scan.
//!
//! This crate does not depend on the truth, simulated worlds, files, terminals or clocks: a robot senses
//! and drives, and one hook receives every event.
//!
//! # Units
//! Metres, radians, nats, seconds.

mod ending;
mod event;
mod explorer;
mod mission;
mod parameters;
mod robot;
mod run;

pub use ending::Ending;
pub use event::{Event, TraceHasher};
pub use explorer::{Explorer, ScanError};
pub use mission::{Limits, Mission, MissionError, standing_place};
pub use parameters::{ParameterError, Parameters, RobotParameters};
pub use robot::{RecordedRobot, Robot, Sensed};
pub use run::{Run, View, explore, explore_by};
