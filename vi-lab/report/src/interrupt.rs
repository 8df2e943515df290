//! The signals that ask a run to end: SIGINT, which Ctrl-C sends, and SIGTERM.
//!
//! In: nothing. Out: whether one has come, so that a run can end between two steps and complete its output. A second
//! signal ends the process at once: what waits to be written may wait for ever.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A signal that has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Its name.
    pub name: &'static str,
    number: i32,
}

impl Signal {
    /// The exit status of a command that this signal ended, by custom: 130 for SIGINT, 143 for SIGTERM.
    #[must_use]
    pub fn exit_status(self) -> u8 {
        u8::try_from(128 + self.number).unwrap_or(u8::MAX)
    }
}

/// The signals that are heeded.
pub const SIGNALS: [Signal; 2] =
    [Signal { name: "SIGINT", number: SIGINT }, Signal { name: "SIGTERM", number: SIGTERM }];

/// Heeds signals from now on.
#[derive(Debug, Default)]
pub struct Interrupt {
    /// One more than the place in [`SIGNALS`] of the signal that came; zero until then.
    came: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Signals no longer end the process, but for the second one.
    ///
    /// # Errors
    /// What the system says where it does not allow this.
    pub fn heed() -> io::Result<Self> {
        let interrupt = Self::default();
        let is_second = Arc::new(AtomicBool::new(false));
        for (index, signal) in SIGNALS.into_iter().enumerate() {
            let Signal { number, .. } = signal;
            // In this order: the first signal finds that none came before it.
            flag::register_conditional_shutdown(number, i32::from(signal.exit_status()), Arc::clone(&is_second))?;
            flag::register(number, Arc::clone(&is_second))?;
            flag::register_usize(number, Arc::clone(&interrupt.came), index + 1)?;
        }
        Ok(interrupt)
    }

    /// The signal that has come.
    #[must_use]
    pub fn signal(&self) -> Option<Signal> {
        let place = self.came.load(Ordering::Relaxed).checked_sub(1)?;
        SIGNALS.get(place).copied()
    }
}
