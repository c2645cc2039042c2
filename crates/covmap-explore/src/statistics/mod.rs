//! What can be said about a series of runs: intervals, tests, and how many tests there were.
//!
//! The unit is a paired (start, seed). Runs from the same start resemble each other, so starts
//! are what is resampled ([`bootstrap`]); an [`Estimate`] then knows how sure it is, and
//! [`holm`] how much of that is left when many claims are tested at once.

mod bootstrap;
mod estimate;
mod holm;
mod kendall;
mod share;

pub use bootstrap::{Grouped, bootstrap};
pub use estimate::Estimate;
pub use holm::holm;
pub use kendall::kendall_tau;
pub use share::share_estimate;
