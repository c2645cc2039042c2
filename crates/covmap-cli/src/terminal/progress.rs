//! A line on the terminal with the progress of an exploration.

use super::say;
use covmap_campaign::Step;
use covmap_explore::{Mission, View};
use covmap_io::escaped;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::fmt::Display;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The pause between two lines. Evaluating the whole map takes time: the pause is at least this
/// long, and at least [`PATIENCE`] times as long as the last evaluation.
const PAUSE: Duration = Duration::from_millis(100);
const PATIENCE: u32 = 20;

/// The line of progress: scans, path, open cells, mean entropy and time; nothing without a
/// terminal.
///
/// There is no share of the finished work: scans find open cells, and the share would fall.
#[derive(Debug)]
pub struct Progress {
    line: Option<ProgressBar>,
    started: Instant,
    next: Mutex<Instant>,
}

impl Progress {
    /// Returns a line on the standard error, if that is a terminal and the user wants it.
    pub fn new(quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        let line = watched.then(|| {
            let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template("{spinner} {wide_msg}") {
                line.set_style(style);
            }
            line
        });
        Self { line, started: Instant::now(), next: Mutex::new(Instant::now()) }
    }

    /// Shows the progress of an exploration, but not too often.
    pub fn show(&self, mission: &Mission, view: &View<'_>) {
        self.sometimes(|| {
            format!(
                "{} scans · {:.1} m · {} known cells open · mean entropy {:.3} nats · {} s",
                view.scans,
                view.path_length,
                view.planner.open_cells(view.map),
                mean_entropy(mission, view),
                self.started.elapsed().as_secs(),
            )
        });
    }

    /// Shows another line, but not too often.
    pub fn tell(&self, text: &dyn Display) {
        self.sometimes(|| escaped(&text).to_string());
    }

    /// Shows a line if the last one has stood long enough; costly lines appear less often.
    fn sometimes(&self, text: impl FnOnce() -> String) {
        let (Some(line), Ok(mut next)) = (&self.line, self.next.lock()) else { return };
        let now = Instant::now();
        if now >= *next {
            set(line, text());
            *next = Instant::now() + PAUSE.max(now.elapsed() * PATIENCE);
        }
    }

    /// Reports that another task takes time now.
    pub fn say(&self, text: &str) {
        if let Some(line) = &self.line {
            set(line, escaped(text).to_string());
        }
    }

    /// Clears the line; another message begins it anew.
    pub fn finish(&self) {
        if let Some(line) = &self.line {
            line.finish_and_clear();
        }
    }
}

/// Shows a message, also after the line was cleared.
fn set(line: &ProgressBar, message: String) {
    if line.is_finished() {
        line.reset();
    }
    line.set_message(message);
}

/// A bar with the number of finished runs of a campaign, their measurements, and the time left.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    /// Scans and metres of all runs since the bar began.
    measured: Mutex<(u64, f64)>,
}

impl Bar {
    /// Returns a bar on the standard error, if that is a terminal and the user wants it.
    pub fn new(campaign: &str, quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        let bar = if watched { ProgressBar::new(0) } else { ProgressBar::hidden() };
        let style =
            "{prefix}: {bar:20} {pos} of {len} runs{msg} · {elapsed} so far · some {eta} left";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        bar.set_prefix(campaign.to_owned());
        bar.enable_steady_tick(Duration::from_millis(500));
        Self { bar, measured: Mutex::default() }
    }

    /// Updates the bar by a step of a campaign.
    pub fn note(&self, step: &Step) {
        match step {
            Step::Begin { recorded, of } => {
                self.bar.set_length(*of as u64);
                self.bar.set_position(*recorded as u64);
                // Earlier runs say nothing about the time left.
                self.bar.reset_eta();
            }
            Step::Note(text) => self.bar.suspend(|| say::note(text)),
            Step::Scan { metres } => self.add_scan(*metres),
            Step::Done => self.bar.inc(1),
        }
    }

    fn add_scan(&self, metres: f64) {
        if self.bar.is_hidden() {
            return;
        }
        if let Ok(mut measured) = self.measured.lock() {
            let (scans, driven) = (measured.0 + 1, measured.1 + metres);
            *measured = (scans, driven);
            self.bar.set_message(format!(" · {scans} scans · {driven:.0} m"));
        }
    }

    /// Clears the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Returns the mean entropy of the cells in the extent \[nats\].
fn mean_entropy(mission: &Mission, view: &View<'_>) -> f64 {
    let inside = mission.outside.iter().filter(|(_, outside)| !**outside);
    let (mut sum, mut count) = (0.0, 0u32);
    for (cell, _) in inside {
        sum += view.map.entropy(cell);
        count += 1;
    }
    sum / f64::from(count.max(1))
}
