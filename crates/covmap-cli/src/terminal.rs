//! The terminal: words, progress, and Ctrl-C.

pub mod interrupt;
pub mod progress;
pub mod say;

use covmap_lab::Watch;
use interrupt::Interrupt;
use progress::Progress;
use std::fmt::Display;

/// Looks on from the terminal.
#[derive(Debug)]
pub struct Terminal<'a> {
    /// Shows how far the work is.
    pub progress: &'a Progress,
    /// Ends it.
    pub interrupt: &'a Interrupt,
}

impl Watch for Terminal<'_> {
    fn tell(&self, progress: &dyn Display) {
        self.progress.tell(progress);
    }

    fn begin(&self, part: &str) {
        self.progress.say(part);
    }

    fn is_stopped(&self) -> bool {
        self.interrupt.is_pressed()
    }
}
