//! States at given times.
//!
//! In: a run, and times in its direction. Out: the state at each, by a step aside from the last node before it: the run keeps its own steps.

use super::Integrator;
use crate::error::StepError;
use crate::state::State;

/// The states of a run at given times; see [`Integrator::propagate_grid`].
///
/// An item is the state at the next of the times, or the error of the step that fails: then the run is at its last good node, and the iterator returns the
/// same error for every time that is left.
#[derive(Debug)]
pub struct Grid<'a, I, const N: usize> {
    run: &'a mut I,
    /// The run after the next step, where that leads beyond the next time.
    ahead: Option<I>,
    times: core::slice::Iter<'a, f64>,
}

impl<'a, I: Integrator<N>, const N: usize> Grid<'a, I, N> {
    pub(super) fn new(run: &'a mut I, times: &'a [f64]) -> Self {
        Self { run, ahead: None, times: times.iter() }
    }

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

impl<I: Integrator<N>, const N: usize> Iterator for Grid<'_, I, N> {
    type Item = Result<State<N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        let t = self.times.next()?;
        Some(self.at(*t))
    }
}
