//! The terminal: words, progress, and Ctrl-C.

pub mod interrupt;
pub mod progress;
pub mod say;

use covmap_lab::Watch;
use interrupt::Interrupt;
use progress::Progress;
use std::fmt::Display;

/// The observer on the terminal.
#[derive(Debug)]
pub struct Terminal<'a> {
    /// The line of progress.
    pub progress: &'a Progress,
    /// The watch for Ctrl-C.
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
