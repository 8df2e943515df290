//! The signals that end a run: SIGINT, sent by Ctrl-C, and SIGTERM.
//!
//! In: nothing. Out: whether one has arrived, so that a run can end between two steps and complete its output. A second
//! signal ends the process at once, because writing the output may block for ever.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A received signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signal {
    /// Its name.
    pub name: &'static str,
    number: i32,
}

impl Signal {
    /// The conventional exit status of a command that this signal ended: 130 for SIGINT, 143 for SIGTERM.
    #[must_use]
    pub fn exit_status(self) -> u8 {
        u8::try_from(128 + self.number).unwrap_or(u8::MAX)
    }
}

/// The handled signals.
pub const SIGNALS: [Signal; 2] =
    [Signal { name: "SIGINT", number: SIGINT }, Signal { name: "SIGTERM", number: SIGTERM }];

/// Handler of the signals.
#[derive(Debug, Default)]
pub struct Interrupt {
    /// One plus the index in [`SIGNALS`] of the received signal; zero until then.
    received: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Installs the handler: the first signal no longer ends the process, the second one does.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn install() -> io::Result<Self> {
        let interrupt = Self::default();
        let is_second = Arc::new(AtomicBool::new(false));
        for (index, signal) in SIGNALS.into_iter().enumerate() {
            let Signal { number, .. } = signal;
            // The order matters: at the first signal the flag is still zero.
            flag::register_conditional_shutdown(number, i32::from(signal.exit_status()), Arc::clone(&is_second))?;
            flag::register(number, Arc::clone(&is_second))?;
            flag::register_usize(number, Arc::clone(&interrupt.received), index + 1)?;
        }
        Ok(interrupt)
    }

    /// The received signal.
    #[must_use]
    pub fn signal(&self) -> Option<Signal> {
        let place = self.received.load(Ordering::Relaxed).checked_sub(1)?;
        SIGNALS.get(place).copied()
    }
}
