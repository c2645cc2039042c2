//! Rings of range sensors, their beams, and the scans that they measure.
//!
//! The device of Stachniss & Burgard (2003) is a B21r with 24 sonars. The principal types are [`SonarRing`],
//! any number of range sensors on a robot, and [`Scan`], the readings of all of them at one pose.
//!
//! This crate knows nothing of maps, and neither explains nor simulates measurements: it describes
//! the device and its readings.
//!
//! # Units
//! Metres, radians counter-clockwise, seconds.
//!
//! ```
//! use covmap_sonar::{Range, Scan, SonarRing};
//! use nalgebra::Isometry2;
//!
//! let ring = SonarRing::b21r();
//! assert_eq!(ring.beams().len(), 24);
//! let mut ranges = vec![Range::NoEcho; 24];
//! ranges[0] = Range::Echo(1.8);
//! let scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges };
//! assert!(ring.fits(&scan));
//! ```

mod drive;
mod ring;
mod scan;

pub use drive::Drive;
pub use ring::{Beam, RingError, RingSpecification, SensorSpecification, SonarRing};
pub use scan::{Range, Scan};
