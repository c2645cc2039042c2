//! Time measurements.

use cpu_time::ThreadTime;
use std::hint::black_box;
use std::time::Instant;

/// A clock.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Clock {
    /// The time that one thread computes, whatever else the machine does: for work on one core.
    Core,
    /// The time that passes: for work on many threads.
    Wall,
}

impl Clock {
    /// Returns the duration of some work \[s\], and its result.
    pub(crate) fn time<T>(self, work: impl FnOnce() -> T) -> (f64, T) {
        match self {
            Clock::Core => {
                let begun = ThreadTime::now();
                let result = black_box(work());
                (begun.elapsed().as_secs_f64(), result)
            }
            Clock::Wall => {
                let begun = Instant::now();
                let result = black_box(work());
                (begun.elapsed().as_secs_f64(), result)
            }
        }
    }
}

/// Returns the duration of some work on this core \[s\], and its result.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    Clock::Core.time(work)
}

/// Returns the value below which a share of all values lies, by the nearest rank; 0 without values.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    #[allow(clippy::cast_possible_truncation, reason = "some hundred values")]
    let rank = (sorted.len() as f64 * share).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Returns the median times of two pieces of work \[s\]. They take turns: a disturbance of the
/// machine affects both.
pub(crate) fn race<A, B>(
    rounds: usize,
    mut ours: impl FnMut() -> A,
    mut other: impl FnMut() -> B,
) -> (f64, f64) {
    let round = |_| (timed(&mut ours).0, timed(&mut other).0);
    let times: Vec<(f64, f64)> = (0..rounds).map(round).collect();
    let (ours, other): (Vec<f64>, Vec<f64>) = times.into_iter().unzip();
    (median(&ours), median(&other))
}
