//! Progress of what takes longer than a second, on standard error if it is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// Steps between two looks at the clock.
const PATIENCE: u64 = 4096;

/// A bar that appears after the first second.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    started: Instant,
    visible: bool,
    calls: u64,
}

impl Progress {
    /// A bar of the given length.
    pub(crate) fn new(length: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        // The template is a constant; were it wrong, the bar's own style would do.
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left  {wide_msg}") {
            bar.set_style(style);
        }
        Self { bar, started: Instant::now(), visible: false, calls: 0 }
    }

    /// Says what is being done.
    pub(crate) fn message(&self, message: impl Into<std::borrow::Cow<'static, str>>) {
        self.bar.set_message(message);
    }

    /// Moves the bar by one.
    pub(crate) fn advance(&mut self) {
        self.calls += 1;
        if self.calls.is_multiple_of(PATIENCE) {
            self.bar.inc(PATIENCE);
            self.show();
        }
    }

    /// Moves the bar to a position.
    pub(crate) fn reach(&mut self, position: u64) {
        self.calls += 1;
        if self.calls.is_multiple_of(PATIENCE) {
            self.bar.set_position(position);
            self.show();
        }
    }

    /// Moves the bar by many.
    pub(crate) fn advance_by(&mut self, count: u64) {
        self.bar.inc(count);
        self.show();
    }

    fn show(&mut self) {
        if !self.visible && self.started.elapsed() > Duration::from_secs(1) {
            self.visible = true;
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
