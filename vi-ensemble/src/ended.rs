//! The end of a trajectory.

use core::fmt;
use vi_core::{State, StepError};

/// The end of a trajectory: its last state, and the error if it failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ended<const N: usize> {
    /// The last good state.
    pub state: State<N>,
    /// Number of steps taken before it ended.
    pub steps: u64,
    /// The error of the next step.
    pub error: StepError,
}

impl<const N: usize> fmt::Display for Ended<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ended after {} steps: {}", self.steps, self.error)
    }
}

impl<const N: usize> core::error::Error for Ended<N> {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        Some(&self.error)
    }
}
