//! Statistics of measurements and their errors: proper scores of posteriors, means with their
//! errors, resampling, tests, and the random numbers for all of them.
//!
//! The unit of a series of runs is a paired (start, seed). Runs from the same start resemble each
//! other, so starts are resampled ([`bootstrap`]). An [`Estimate`] has its standard error, and
//! [`holm`] adjusts the p-values when many claims are tested at once.
//!
//! This crate knows nothing of worlds, models or planners.
//!
//! # Units
//! Nats; coverage in \[0, 1\].
//!
//! ```
//! use covmap_statistics::{Estimate, crps};
//!
//! let scans = Estimate::of_mean(&[812.0, 790.0, 845.0, 801.0, 822.0]).ok_or("no run")?;
//! let (low, high) = scans.interval(0.95).ok_or("a single run")?;
//! assert!(low < 814.0 && 814.0 < high);
//! // All mass at the truth.
//! assert!(crps(&[0.0, 1.0, 0.0], 0.5) < 1e-12);
//! # Ok::<(), &str>(())
//! ```

mod bootstrap;
mod estimate;
mod holm;
mod kendall;
mod proper_score;
mod random;
mod resample;
mod share;
mod spread;

pub use bootstrap::{Grouped, bootstrap};
pub use estimate::{Estimate, detectable};
pub use holm::holm;
pub use kendall::kendall_tau;
pub use proper_score::{
    LIKELIHOOD_FLOOR, central, crps, interval_holds, log_likelihood, randomised_pit,
};
pub use random::{normal, stream, uniform};
pub use resample::{central_interval, resample};
pub use share::share_estimate;
pub use spread::Spread;
