//! The sensor model of coverage maps: how a scan changes the belief of the robot.
//!
//! Section 3 of Stachniss & Burgard (2003), equations (1)–(10). The principal type is
//! [`SensorModel`]; [`integrate`] multiplies a scan into a map.
//!
//! This crate knows neither the world in which the scans were taken nor where the robot measures
//! next.
//!
//! # Units
//! Metres, radians, nats; coverage in [0, 1].
//!
//! ```
//! use covmap::{CoverageMap, Grid};
//! use covmap_model::{ModelParameters, SensorModel, integrate};
//! use covmap_sonar::{Range, Scan, SonarRing};
//! use nalgebra::{Isometry2, Point2};
//!
//! let model = SensorModel::new(&ModelParameters::b21r(), &SonarRing::b21r(), 0.1)?;
//! let grid = Grid::new(Point2::new(-3.0, -3.0), 0.1, 60, 60)?;
//! let mut map = CoverageMap::new(grid, model.parameters().bins)?;
//! let mut scan = Scan { pose: Isometry2::identity(), time: 0.0, ranges: vec![Range::NoEcho; 24] };
//! scan.ranges[0] = Range::Echo(1.2);
//! let changes = integrate(&model, &mut map, &scan);
//! assert!(changes.iter().all(|change| map.is_known(change.cell)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
mod cause;
mod footprint;
mod integrate;
mod looks;
mod occupancy;
mod outcome;
mod parameters;
mod product;
mod registers;
mod scan_counts;
mod sensor_model;

pub use body::{Body, BodyEvent};
pub use cause::{Causes, Clues, Met, Role, gaussian, opaque};
pub use footprint::{Footprint, FootprintCell, FootprintError, FootprintRule};
pub use integrate::{
    cells_under_body, integrate, integrate_body, integrate_literally, integrate_new,
    integrate_new_literally, intercepted,
};
pub use looks::Looks;
pub use occupancy::{OccupancyGrid, OccupancyParameters};
pub use outcome::Outcome;
pub use parameters::{CauseParameters, FreeSpace, NoEchoShare, Repeats, Update};
pub use parameters::{Linear, ModelError, ModelParameters, NoEchoParameters, ProductParameters};
pub use registers::Registers;
pub use scan_counts::{Counting, ScanCounts};
pub use sensor_model::SensorModel;
