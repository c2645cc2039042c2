//! The simulated world, as its users see it.
#![allow(clippy::unwrap_used, reason = "a test may fail")]
#![allow(clippy::float_cmp, reason = "tests compare exact values")]

mod build;
mod coverage;
mod driving;
mod raster;
mod scenarios;
mod sight;
mod sonar;
