//! A window on long work.

use std::fmt::Display;
use std::ops::ControlFlow;

/// Who started long work, and wants to know how far it is, and may end it.
pub trait Watch: Sync {
    /// Is told how far the work is; so often that most of it need not be shown.
    fn tell(&self, progress: &dyn Display);

    /// Is told that the next part of the work begins.
    fn begin(&self, part: &str);

    /// Whether the work is to end.
    fn is_stopped(&self) -> bool;

    /// The same, as a hook answers it.
    fn flow(&self) -> ControlFlow<()> {
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Nobody looks: the work goes on to its end.
impl Watch for () {
    fn tell(&self, _: &dyn Display) {}

    fn begin(&self, _: &str) {}

    fn is_stopped(&self) -> bool {
        false
    }
}
