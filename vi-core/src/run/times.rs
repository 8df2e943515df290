//! States at given times.
//!
//! In: a run, and times in its direction. Out: the state at each, by a step from the last node before it that ends there. Several times are taken beside the run,
//! which keeps its own steps.

use super::{Run, Solution};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::state::State;

/// Part of a step by which the last one may be longer.
pub(super) const LONGER: f64 = 1e-6;

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// Takes steps up to the time t. The last one ends there: then `state().t` is t.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a time that is not finite, or not ahead of the run; else that of the step that fails, after which the run holds the last good
    /// state.
    pub fn until(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.check_ahead(t)?;
        // The loop has a run of its own: behind a pointer its numbers would go through memory in every step.
        let mut run = self.clone();
        let mut outcome = Ok(false);
        while let Ok(false) = outcome {
            outcome = run.approach(t);
        }
        *self = run;
        outcome.map(|_| self.state())
    }

    /// [`Run::until`] the time at which `duration` is over, forwards or backwards as the steps go.
    ///
    /// # Errors
    /// Those of [`Run::until`]; [`StepError::InvalidInput`] for a negative duration.
    pub fn for_time(&mut self, duration: f64) -> Result<State<N>, StepError> {
        if !(duration >= 0.0 && duration.is_finite()) {
            let (input, allowed) = ("the duration of a run", "finite and not negative");
            return Err(StepError::InvalidInput { input, allowed, value: duration });
        }
        let node = &self.node;
        self.until(node.t + (node.t_low + duration.copysign(self.h())))
    }

    /// States at the given times with their energies. The run ends at its last node that is not beyond the last time.
    ///
    /// [`Run::states_at`] returns the same states one by one, those before an error too.
    ///
    /// # Errors
    /// That of the step that fails; [`StepError::InvalidInput`] for a time that is not finite, or behind the one before.
    pub fn at_times(&mut self, times: impl IntoIterator<Item = f64>) -> Result<Solution<N>, StepError> {
        let system = self.system;
        let states: Result<Vec<State<N>>, StepError> = self.states_at(times).collect();
        Solution::of(&system, states?)
    }

    /// States at the given times, in the order in which the run meets them: an iterator that takes steps as it needs them. The run ends at its last node that is not
    /// beyond the last time.
    pub fn states_at<I: IntoIterator<Item = f64>>(&mut self, times: I) -> Grid<'_, M, S, I::IntoIter, N> {
        Grid { run: self, ahead: None, times: times.into_iter() }
    }

    /// The time from the node reached last to `t`, by both parts of its time.
    #[doc(hidden)]
    pub fn time_to(&self, t: f64) -> f64 {
        (t - self.node.t) - self.node.t_low
    }

    /// Whether the run can continue to the time `t`.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] if it cannot.
    pub(crate) fn check_ahead(&self, t: f64) -> Result<(), StepError> {
        if t.is_finite() && self.time_to(t) * self.h().signum() >= 0.0 {
            return Ok(());
        }
        let allowed = "finite, and ahead of the run";
        Err(StepError::InvalidInput { input: "the time to propagate to", allowed, value: t })
    }

    /// Takes one step toward the time `t`, which ends there if the next one would end beyond. Returns whether it did.
    pub(crate) fn approach(&mut self, t: f64) -> Result<bool, StepError> {
        let left = self.time_to(t);
        if left == 0.0 {
            self.set_time(t);
            return Ok(true);
        }
        let h = self.h();
        let direction = h.signum();
        // Up to a rounding of t the last step may be longer than h, so that no step of the length of a rounding follows. Far from zero a rounding is many steps.
        let rounding = (f64::EPSILON * t.abs()).min(LONGER * h.abs());
        let beyond = (self.longest() - left) * direction + rounding;
        if beyond < 0.0 {
            return self.step().map(|_| false);
        }
        if M::FINDS_LENGTH {
            let ahead = self.after_a_step()?;
            if ahead.time_to(t) * direction >= 0.0 {
                *self = ahead;
                return Ok(false);
            }
        }
        self.end_at(t).map(|()| true)
    }

    /// The next step is no longer than this, which has the sign of [`Run::h`].
    #[doc(hidden)]
    pub fn longest(&self) -> f64 {
        self.method.longest(self.h, &self.memory)
    }

    /// Takes one step that ends at the time `t`.
    ///
    /// # Errors
    /// Those of [`Run::step_of`].
    #[doc(hidden)]
    pub fn end_at(&mut self, t: f64) -> Result<(), StepError> {
        let left = self.time_to(t);
        // A length below the smallest of a step is none.
        if !left.is_normal() {
            self.set_time(t);
            return Ok(());
        }
        // If the next step ends there, it is that one.
        let is_next = !M::FINDS_LENGTH && left.to_bits() == self.h().to_bits();
        let outcome = if is_next { self.single_step() } else { self.step_of(left) };
        outcome.map(|_| self.set_time(t))
    }

    /// The run after the next step.
    ///
    /// # Errors
    /// Those of [`Run::step`].
    #[doc(hidden)]
    pub fn after_a_step(&self) -> Result<Self, StepError> {
        let mut ahead = self.clone();
        ahead.single_step().map(|_| ahead)
    }

    /// Sets the time of the node reached last, to which it is equal but for rounding.
    #[doc(hidden)]
    pub fn set_time(&mut self, t: f64) {
        self.node.set_time(t);
    }
}

/// The states of a run at given times; see [`Run::states_at`].
///
/// An item is the state at the next of the times, or the error of the step that fails. The run is then at its last good node, and the iterator returns the same error
/// for every time that is left.
#[derive(Debug)]
pub struct Grid<'a, M: Method<S, N>, S, I, const N: usize> {
    run: &'a mut Run<M, S, N>,
    /// The run after the next step, if that leads beyond the next time.
    ahead: Option<Run<M, S, N>>,
    times: I,
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, I, const N: usize> Grid<'_, M, S, I, N> {
    /// The state at the time t.
    fn at(&mut self, t: f64) -> Result<State<N>, StepError> {
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
                return Ok(aside.state());
            }
            *self.run = ahead;
        }
        Ok(State { t, ..self.run.state() })
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
        Some(self.at(t))
    }
}
