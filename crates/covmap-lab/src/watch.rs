//! The watch over long work.

use std::fmt::Display;
use std::ops::ControlFlow;

/// Observer of long work, which receives its progress and may stop it.
pub trait Watch: Sync {
    /// Receives the progress of the work, more often than it need be shown.
    fn tell(&self, progress: &dyn Display);

    /// Receives the name of the part of the work that begins.
    fn begin(&self, part: &str);

    /// Whether the work is to stop.
    fn is_stopped(&self) -> bool;

    /// Returns whether the work is to stop, as the result of a hook.
    fn flow(&self) -> ControlFlow<()> {
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// No observer: the work goes on to its end.
impl Watch for () {
    fn tell(&self, _: &dyn Display) {}

    fn begin(&self, _: &str) {}

    fn is_stopped(&self) -> bool {
        false
    }
}
