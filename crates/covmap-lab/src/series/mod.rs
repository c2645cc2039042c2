//! A series of runs: their starts, and the measurements of each run.

mod accuracy;
mod compared;
mod corners;
mod starts;
mod tally;

pub use accuracy::{Accuracy, Errors};
pub use corners::corners;
pub use starts::drawn_starts;
pub use tally::{Measurements, Tally};
