//! A run together with its error monitor.

use super::{ErrorEstimate, ErrorMonitor};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::real::Scalar;
use crate::run::Run;
#[cfg(feature = "alloc")]
use crate::run::{Crossing, Crossings, Events};
use crate::state::State;

/// A run with an error monitor: [`Run::monitored`].
#[derive(Clone, Debug)]
pub struct Monitored<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    run: Run<M, S, N, T>,
    monitor: ErrorMonitor<M, S, N, T>,
    limit: f64,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Run<M, S, N, T> {
    /// Adds an error monitor, which changes no bit of the steps. See the [module](crate::run::ErrorMonitor).
    pub fn monitored(self) -> Monitored<M, S, N, T> {
        Monitored { monitor: ErrorMonitor::new(&self), run: self, limit: f64::INFINITY }
    }
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Monitored<M, S, N, T> {
    /// Ends the run with [`StepError::Tolerance`] if a measured error exceeds `limit`, for example ten times the
    /// tolerance. The first steps are not judged, because excursions are still small: until a coordinate has turned
    /// back, or for 64 steps.
    #[must_use]
    pub fn with_limit(self, limit: f64) -> Self {
        Self { limit, ..self }
    }

    /// Takes one step and returns its end state.
    ///
    /// # Errors
    /// As [`Run::step`]. [`StepError::Tolerance`] if a measured error exceeds the limit: the last state stays, and a
    /// further call returns the same error.
    #[inline]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        self.check()?;
        self.run.step()?;
        self.monitor.watch(&self.run);
        self.check()?;
        Ok(self.run.state())
    }

    /// Checks the limit.
    ///
    /// # Errors
    /// [`StepError::Tolerance`] beyond the limit.
    #[inline]
    fn check(&self) -> Result<(), StepError> {
        self.monitor.check(self.limit)
    }

    /// The largest relative error of a step so far, and its time.
    pub fn largest(&self) -> ErrorEstimate {
        self.monitor.largest(&self.run)
    }

    /// The error of the next step, relative to the scales so far.
    ///
    /// # Errors
    /// The errors of the step.
    pub fn error_estimate(&self) -> Result<f64, StepError> {
        self.monitor.error_estimate(&self.run)
    }

    /// Number of measured steps.
    pub fn measurements(&self) -> u64 {
        self.monitor.measurements()
    }

    /// The run. A monitored run has its functions that change nothing, too: `state`, `energy`, `t`, `system`, `checkpoint`.
    pub fn run(&self) -> &Run<M, S, N, T> {
        &self.run
    }

    /// Changes the run: `monitored.change(|run| run.set_state(state))`. A jump of its state is no excursion, and steps
    /// that it takes meanwhile are not measured.
    pub fn change<R>(&mut self, change: impl FnOnce(&mut Run<M, S, N, T>) -> R) -> R {
        // Pending measurements need the system before the change.
        self.monitor.close(&self.run);
        let outcome = change(&mut self.run);
        self.monitor.resume(&self.run);
        outcome
    }

    /// The run without its monitor.
    pub fn into_run(self) -> Run<M, S, N, T> {
        self.run
    }
}

impl<M: Method<S, N, T>, S, const N: usize, T: Scalar> core::ops::Deref for Monitored<M, S, N, T> {
    type Target = Run<M, S, N, T>;

    fn deref(&self) -> &Run<M, S, N, T> {
        &self.run
    }
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Monitored<M, S, N> {
    /// Takes steps up to the time t, as [`Run::until`] does.
    ///
    /// # Errors
    /// As [`Run::until`] and [`Monitored::step`].
    pub fn until(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.run.check_ahead(t)?;
        loop {
            self.check()?;
            let is_there = self.run.approach(t)?;
            self.monitor.watch(&self.run);
            if is_there {
                if self.limit.is_finite() {
                    // Otherwise a peak shortly before the end would stay unmeasured in its window.
                    self.monitor.close(&self.run);
                }
                self.check()?;
                return Ok(self.run.state());
            }
        }
    }

    /// Takes steps to the first event, or to the time `until` if there is none before, as [`Run::next_event`] does.
    ///
    /// # Errors
    /// As [`Run::next_event`] and [`Monitored::step`].
    #[cfg(feature = "alloc")]
    pub fn next_event(&mut self, events: impl Events<N>, until: f64) -> Result<Option<Crossing<N>>, StepError> {
        self.check()?;
        let Self { run, monitor, limit } = self;
        let watch = |run: &Run<M, S, N>| {
            monitor.watch(run);
            monitor.check(*limit)
        };
        Crossings::new(run, events, until, watch).stop()
    }
}
