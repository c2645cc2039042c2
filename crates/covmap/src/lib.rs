//! Coverage maps: the robot's belief about *how much* of each cell is covered.
//!
//! Section 2 of Stachniss & Burgard (2003), equation (11). The principal type is
//! [`CoverageMap`]: a [`Grid`] of cells with a posterior over the coverage of each.
//!
//! This crate knows nothing of sensors, models or robots: it multiplies evidence.
//!
//! # Units
//! Metres, nats; coverage in [0, 1], 0 for an empty cell and 1 for a full one.
//!
//! ```
//! use covmap::{CoverageMap, Grid};
//! use nalgebra::Point2;
//!
//! let grid = Grid::new(Point2::origin(), 0.1, 40, 30)?;
//! let mut map = CoverageMap::new(grid, 11)?;
//! let cell = grid.cell_at(Point2::new(1.23, 0.45)).expect("inside the grid");
//!
//! // Evidence that this cell is covered 20 %, one weight for each bin 0, 0.1, … 1:
//! let evidence = [0.1, 0.5, 2.0, 0.5, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1];
//! let change = map.multiply(cell, &evidence).expect("the cell is not pinned");
//! assert_eq!(map.mode(cell), 0.2);
//! assert!(change.after < change.before);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod belief_file;
mod class;
mod coverage_map;
mod grid;
mod histogram;
pub mod lanes;
mod raster;
mod read_out;
mod scored;
mod short;
mod steps;

pub use belief_file::BeliefFileError;
pub use class::{Class, lower_bin};
pub use coverage_map::{Change, CoverageMap, EvidenceBlock, MapError};
pub use grid::{Cell, Grid, GridError, MAX_CELLS};
pub use histogram::{
    Histogram, MAX_BINS, MIN_BINS, PROBABILITY_FLOOR, bin_coverage, mode_bin, product,
};
pub use raster::Raster;
pub use read_out::{READ_OUT_FLOOR, ReadOut, ReadOutError};
pub use scored::is_scored;
pub use short::short;
pub use steps::{STEPS, Steps, neighbour, opposite, step_between};
