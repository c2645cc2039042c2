//! A series of runs: where they start, what is measured of each, and its mean.

mod accuracy;
mod compared;
mod corners;
mod starts;
mod tally;

pub use accuracy::{Accuracy, Errors};
pub use corners::corners;
pub use starts::drawn_starts;
pub use tally::{Measurements, Tally};
