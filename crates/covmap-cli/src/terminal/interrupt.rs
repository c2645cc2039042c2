//! Ctrl-C: the first ends the work in good order, the second at once.
//!
//! While no watcher asks, such as when a world is built or a picture drawn, the first ends the
//! program at once as well.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The exit code that a shell expects of a program that Ctrl-C ended.
pub const EXIT_CODE: u8 = 130;

/// The time that a watcher has to notice, such as a planner that decides; after it, the program
/// ends.
const PATIENCE: Duration = Duration::from_secs(30);

/// The state of Ctrl-C.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<State>);

#[derive(Debug, Default)]
struct State {
    pressed: AtomicBool,
    /// Whether a watcher asks again and again.
    watched: AtomicBool,
    /// Whether a watcher asked after Ctrl-C.
    noticed: AtomicBool,
}

impl Interrupt {
    /// Listens to Ctrl-C from now on.
    pub fn listen() -> anyhow::Result<Self> {
        let interrupt = Self::default();
        let heard = interrupt.clone();
        ctrlc::set_handler(move || heard.press())?;
        Ok(interrupt)
    }

    fn press(&self) {
        let State { pressed, watched, .. } = &*self.0;
        if pressed.swap(true, Ordering::SeqCst) || !watched.load(Ordering::SeqCst) {
            std::process::exit(i32::from(EXIT_CODE));
        }
        let waiting = self.clone();
        std::thread::spawn(move || {
            std::thread::sleep(PATIENCE);
            if !waiting.0.noticed.load(Ordering::SeqCst) {
                std::process::exit(i32::from(EXIT_CODE));
            }
        });
    }

    /// Returns whether Ctrl-C was pressed. The caller keeps asking until it calls
    /// [`done`](Self::done).
    pub fn is_pressed(&self) -> bool {
        self.0.watched.store(true, Ordering::SeqCst);
        let pressed = self.0.pressed.load(Ordering::SeqCst);
        if pressed {
            self.0.noticed.store(true, Ordering::SeqCst);
        }
        pressed
    }

    /// Ends the watch until the next question, and returns whether Ctrl-C was pressed.
    pub fn done(&self) -> bool {
        let pressed = self.is_pressed();
        self.0.watched.store(false, Ordering::SeqCst);
        pressed
    }

    /// Returns the answer of a watcher: to continue until Ctrl-C.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.is_pressed() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
