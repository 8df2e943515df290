//! Output at given times.
//!
//! The last step before each time starts from the last node and ends exactly there. For several times the run computes
//! these steps on a copy, and keeps its own steps.

use super::Run;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::node::Node;
use crate::state::State;

/// Relative amount by which the last step may exceed h.
pub(super) const LONGER: f64 = 1e-6;

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// Takes steps up to the time t. The last one ends there: then `state().t` is t.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a time that is not finite or not ahead of the run; otherwise the error of the
    /// failed step. The run then holds the last good state.
    pub fn until(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.check_ahead(t)?;
        // The loop owns its run: through a pointer every step would load and store its numbers.
        let mut run = self.clone();
        let mut outcome = Ok(false);
        while let Ok(false) = outcome {
            outcome = run.approach(t);
        }
        *self = run;
        outcome.map(|_| self.state())
    }

    /// Advances by `duration`, as [`Run::until`], in the direction of the steps.
    ///
    /// # Errors
    /// As [`Run::until`]; [`StepError::InvalidInput`] for a negative duration.
    pub fn for_time(&mut self, duration: f64) -> Result<State<N>, StepError> {
        if !(duration >= 0.0 && duration.is_finite()) {
            let (input, allowed) = ("the duration of a run", "finite and not negative");
            return Err(StepError::InvalidInput { input, allowed, value: duration });
        }
        let node = &self.node;
        self.until(node.t + (node.t_low + duration.copysign(self.h())))
    }

    /// Iterates over states at the given times, in the order of the run, and takes steps on demand. The run ends at its
    /// last node that is not beyond the last time.
    pub fn states_at<I: IntoIterator<Item = f64>>(&mut self, times: I) -> Grid<'_, M, S, I::IntoIter, N> {
        Grid { run: self, ahead: None, times: times.into_iter() }
    }

    /// The time from the last node to `t`, including the low part of its time.
    #[doc(hidden)]
    pub fn time_to(&self, t: f64) -> f64 {
        (t - self.node.t) - self.node.t_low
    }

    /// Whether the run can continue to the time `t`.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] if it cannot.
    #[doc(hidden)]
    pub fn check_ahead(&self, t: f64) -> Result<(), StepError> {
        if t.is_finite() && self.time_to(t) * self.h().signum() >= 0.0 {
            return Ok(());
        }
        let allowed = "finite, and ahead of the run";
        Err(StepError::InvalidInput { input: "the time to propagate to", allowed, value: t })
    }

    /// Takes one step toward the time `t`. It ends at `t` if the next one would end beyond; the return value says
    /// whether it did.
    pub(crate) fn approach(&mut self, t: f64) -> Result<bool, StepError> {
        self.approach_by(t, Self::step)
    }

    /// Takes one step toward the time `t` as `approach`, for calls outside of loops.
    ///
    /// # Errors
    /// As [`Run::until`].
    #[doc(hidden)]
    pub fn approach_once(&mut self, t: f64) -> Result<bool, StepError> {
        self.approach_by(t, Self::single_step)
    }

    #[inline(always)]
    fn approach_by(
        &mut self,
        t: f64,
        step: impl FnOnce(&mut Self) -> Result<State<N>, StepError>,
    ) -> Result<bool, StepError> {
        let left = self.time_to(t);
        if left == 0.0 {
            self.set_time(t);
            return Ok(true);
        }
        let h = self.h();
        let direction = h.signum();
        // Within a rounding of t the last step may exceed h, so that no step of rounding length follows. Far from zero
        // a rounding is many steps.
        let rounding = (f64::EPSILON * t.abs()).min(LONGER * h.abs());
        let beyond = (self.longest() - left) * direction + rounding;
        if beyond < 0.0 {
            return step(self).map(|_| false);
        }
        if self.method.facts().finds_length {
            let ahead = self.after_a_step()?;
            if ahead.time_to(t) * direction >= 0.0 {
                *self = ahead;
                return Ok(false);
            }
        }
        self.end_at(t).map(|()| true)
    }

    /// Upper bound of the next step length, with the sign of [`Run::h`].
    #[doc(hidden)]
    pub fn longest(&self) -> f64 {
        self.method.status(self.h, &self.memory).longest
    }

    /// Takes one step that ends at the time `t`.
    ///
    /// # Errors
    /// As [`Run::step_of`].
    #[doc(hidden)]
    pub fn end_at(&mut self, t: f64) -> Result<(), StepError> {
        let left = self.time_to(t);
        // A subnormal remainder is no step.
        if !left.is_normal() {
            self.set_time(t);
            return Ok(());
        }
        // A remainder of exactly one step is the next step.
        let is_next = !self.method.facts().finds_length && left.to_bits() == self.h().to_bits();
        let outcome = if is_next { self.single_step() } else { self.step_of(left) };
        outcome.map(|_| self.set_time(t))
    }

    /// A copy of the run after the next step.
    ///
    /// # Errors
    /// As [`Run::step`].
    #[doc(hidden)]
    pub fn after_a_step(&self) -> Result<Self, StepError> {
        let mut ahead = self.clone();
        ahead.single_step().map(|_| ahead)
    }

    /// Sets the time of the last node, which may change by rounding only.
    #[doc(hidden)]
    pub fn set_time(&mut self, t: f64) {
        self.node.set_time(t);
    }
}

/// States of a run at given times; see [`Run::states_at`].
///
/// An item is the state at the next time, or the error of the failed step. The run is then at its last good node, and
/// the iterator returns the same error for every remaining time.
#[derive(Debug)]
pub struct Grid<'a, M: Method<S, N>, S, I, const N: usize> {
    run: &'a mut Run<M, S, N>,
    /// The run after the next step, if that step ends beyond the next time.
    ahead: Option<Run<M, S, N>>,
    pub(super) times: I,
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, I, const N: usize> Grid<'_, M, S, I, N> {
    /// The state at the time t, and its node.
    pub(super) fn at(&mut self, t: f64) -> Result<(State<N>, Node<N>), StepError> {
        self.run.check_ahead(t)?;
        let direction = self.run.h().signum();
        while self.run.time_to(t) != 0.0 {
            let ahead = match self.ahead.take() {
                Some(ahead) => ahead,
                None => self.run.after_a_step()?,
            };
            if ahead.time_to(t) * direction < 0.0 {
                self.ahead = Some(ahead);
                let mut aside = self.run.clone();
                aside.end_at(t)?;
                return Ok((aside.state(), aside.node));
            }
            *self.run = ahead;
        }
        Ok((State { t, ..self.run.state() }, self.run.node))
    }
}

impl<M, S, I, const N: usize> Iterator for Grid<'_, M, S, I, N>
where
    M: Method<S, N>,
    S: Lagrangian<N> + Copy,
    I: Iterator<Item = f64>,
{
    type Item = Result<State<N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        let t = self.times.next()?;
        Some(self.at(t).map(|(state, _)| state))
    }
}
