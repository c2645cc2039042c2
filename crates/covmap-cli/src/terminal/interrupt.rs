//! Ctrl-C: the first ends the work in good order, the second at once. Where nobody watches for it,
//! while a world is built or a picture drawn, the first ends at once as well.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// What a shell expects of a program that ended by Ctrl-C.
pub const EXIT_CODE: u8 = 130;

/// Whoever watches has so long to notice, such as a planner to decide; then it ends all the same.
const PATIENCE: Duration = Duration::from_secs(30);

/// Whether Ctrl-C was pressed.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<State>);

#[derive(Debug, Default)]
struct State {
    pressed: AtomicBool,
    /// Somebody asks again and again.
    watched: AtomicBool,
    /// Somebody asked after it was pressed.
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

    /// Whether it was pressed. Whoever asks goes on asking until he is [done](Self::done).
    pub fn is_pressed(&self) -> bool {
        self.0.watched.store(true, Ordering::SeqCst);
        let pressed = self.0.pressed.load(Ordering::SeqCst);
        if pressed {
            self.0.noticed.store(true, Ordering::SeqCst);
        }
        pressed
    }

    /// Nobody watches any longer, until it is asked again. Returns whether it was pressed.
    pub fn done(&self) -> bool {
        let pressed = self.is_pressed();
        self.0.watched.store(false, Ordering::SeqCst);
        pressed
    }

    /// What a watcher answers: to go on until it is pressed.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.is_pressed() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
