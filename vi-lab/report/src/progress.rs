//! Progress of long operations, on standard error if it is a terminal.

use crate::numbers::about;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, Write as _};
use std::time::{Duration, Instant};

/// Steps between two readings of the clock.
const PATIENCE: u64 = 4096;
/// Steps between two readings of the clock in runs of any system, whose steps may be slow.
const SHORT_PATIENCE: u64 = 256;

/// A bar that appears after the first second.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    started: Instant,
    visible: bool,
    calls: u64,
}

impl Progress {
    /// Length of the bar of a run: fine enough that the slowest run moves it, for the estimate of the remaining time.
    pub const FINENESS: u64 = 1_000_000_000_000_000;

    /// A bar of the given length.
    #[must_use]
    pub fn new(length: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        // The template is a constant; on an error the default style remains.
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left  {wide_msg}") {
            bar.set_style(style);
        }
        Self { bar, started: Instant::now(), visible: false, calls: 0 }
    }

    /// Shows the current operation.
    pub fn message(&self, message: impl Into<std::borrow::Cow<'static, str>>) {
        self.bar.set_message(message);
    }

    /// Moves the bar by one.
    pub fn advance(&mut self) {
        self.calls += 1;
        if self.calls.is_multiple_of(PATIENCE) {
            self.bar.inc(PATIENCE);
            self.show();
        }
    }

    /// Sets the bar of a run, of length [`Self::FINENESS`], to the completed part between 0 and 1. Reports once on
    /// standard error if the rest takes more than a day at this rate.
    pub fn reach(&mut self, part: f64) {
        self.calls += 1;
        if !self.calls.is_multiple_of(SHORT_PATIENCE) {
            return;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // up to 1e15
        self.bar.set_position((part * Self::FINENESS as f64) as u64);
        if self.show() {
            let days = self.started.elapsed().as_secs_f64() * (1.0 - part) / part / 86_400.0;
            if days > 1.0 {
                // Standard error may be closed; the run continues.
                let say = || {
                    writeln!(io::stderr(), "at the rate of its first second, this run takes {} more days", about(days))
                };
                let _ = self.bar.suspend(say);
            }
        }
    }

    /// Moves the bar by many.
    pub fn advance_by(&mut self, count: u64) {
        self.bar.inc(count);
        self.show();
    }

    /// Shows the bar after the first second; returns whether it has just appeared.
    fn show(&mut self) -> bool {
        let appears = !self.visible && self.started.elapsed() > Duration::from_secs(1);
        if appears {
            self.visible = true;
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        appears
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
