//! A line on the terminal that says how far an exploration is.

use crate::say;
use covmap_explore::{Mission, View};
use covmap_io::escaped;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Looking at the whole map takes time: so long passes between two looks, and so many times
/// as long as the last one took.
const PAUSE: Duration = Duration::from_millis(100);
const PATIENCE: u32 = 20;

/// Scans, share of cells finished, mean entropy, path and time; nothing where nobody looks.
#[derive(Debug)]
pub(crate) struct Progress {
    line: Option<ProgressBar>,
    started: Instant,
    next: Instant,
}

impl Progress {
    /// A line on the standard error, if that is a terminal and the user wants it.
    pub(crate) fn new(quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        let line = watched.then(|| {
            let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template("{spinner} {wide_msg}") {
                line.set_style(style);
            }
            line
        });
        Self { line, started: Instant::now(), next: Instant::now() }
    }

    /// Shows how far it is, but not too often. The share is of the cells that are known.
    pub(crate) fn show(&mut self, mission: &Mission, view: &View<'_>) {
        let Some(line) = &self.line else { return };
        let now = Instant::now();
        if now < self.next {
            return;
        }
        line.set_message(format!(
            "{} scans · {:.1} % finished · mean entropy {:.3} nats · {:.1} m · {} s",
            view.scans,
            100.0 * view.planner.share_finished(view.map),
            mean_entropy(mission, view),
            view.path_length,
            self.started.elapsed().as_secs(),
        ));
        self.next = Instant::now() + PAUSE.max(now.elapsed() * PATIENCE);
    }

    /// Shows a line that is not of an exploration, but not too often.
    pub(crate) fn tell(&mut self, text: impl FnOnce() -> String) {
        let Some(line) = &self.line else { return };
        let now = Instant::now();
        if now >= self.next {
            line.set_message(escaped(&text()).to_string());
            self.next = now + PAUSE;
        }
    }

    /// Says that something else takes time now.
    pub(crate) fn say(&self, text: &str) {
        if let Some(line) = &self.line {
            line.set_message(escaped(text).to_string());
        }
    }

    /// Clears the line.
    pub(crate) fn finish(&self) {
        if let Some(line) = &self.line {
            line.finish_and_clear();
        }
    }
}

/// A bar that says how many runs are done, and how much time is left.
#[derive(Debug)]
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// A bar on the standard error, if that is a terminal and the user wants it.
    pub(crate) fn new(quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        let bar = if watched { ProgressBar::new(0) } else { ProgressBar::hidden() };
        let style = "{bar:30} {pos} of {len} runs · {elapsed} so far · {eta} left";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(500));
        Self(bar)
    }

    /// So many runs of so many are done before it begins.
    pub(crate) fn begin(&self, recorded: usize, of: usize) {
        self.0.set_length(of as u64);
        self.0.set_position(recorded as u64);
        // What was done before says nothing of the time that is left.
        self.0.reset_eta();
    }

    /// One more is done.
    pub(crate) fn done(&self) {
        self.0.inc(1);
    }

    /// Prints something to know above the bar.
    pub(crate) fn note(&self, text: &str) {
        self.0.suspend(|| say::note(text));
    }

    /// Clears the bar.
    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// The mean entropy of the cells in the extent \[nats\].
fn mean_entropy(mission: &Mission, view: &View<'_>) -> f64 {
    let inside = mission.outside.iter().filter(|(_, outside)| !**outside);
    let (mut sum, mut count) = (0.0, 0u32);
    for (cell, _) in inside {
        sum += view.map.entropy(cell);
        count += 1;
    }
    sum / f64::from(count.max(1))
}
