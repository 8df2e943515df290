//! States at which functions of the motion vanish.
//!
//! In: a run, functions g(t, q, v), a time to end at. Out: the states where a function changes its sign, in their order, by steps of the exact length: along the
//! path over a step signs are told, and their changes are then located by steps from the node before (`sign_changes`).
//!
//! Zero counts as positive: g is RISING where it comes from below zero, FALLING where it goes there. What only touches zero is no event; nor is a zero at
//! the very start, so that a run that was stopped at an event goes on from it: there g has the sign that it takes next. So a search looks from a billionth of a
//! step after its start to as much after its end, where what it finds is an event at the end: of two searches that follow each other one finds it. Two events of one step are found where a sample
//! or an extremum lies between them; of faster ones, less than an eighth of a step apart, a pair may be missed.
//! AFTER AN EVENT |g| is not larger than at neighbouring lengths of the step, to rounding.

use super::sign_changes::{START, Sample, changes, located};
use super::{DenseOutput, Run};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::state::State;
use core::fmt;
use nalgebra::SVector;

/// In which direction a function passes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Either.
    Both,
}

/// A function g(t, q, v) of time, coordinates and velocities.
pub type Function<'a, const N: usize> = dyn Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> f64 + 'a;

/// A function of the motion, and the direction in which it passes zero.
#[derive(Clone, Copy)]
pub struct Event<'a, const N: usize> {
    g: &'a Function<'a, N>,
    direction: Direction,
}

impl<'a, const N: usize> Event<'a, N> {
    /// An event where `g(t, q, v)` passes zero in a direction. It has to be continuous, and the same for the same arguments.
    pub fn new(g: &'a Function<'a, N>, direction: Direction) -> Self {
        Self { g, direction }
    }
}

impl<const N: usize> fmt::Debug for Event<'_, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Event").field("direction", &self.direction).finish_non_exhaustive()
    }
}

/// An event that was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<const N: usize> {
    /// The index of the event among those that were asked for.
    pub event: usize,
    /// Whether g was below zero before.
    pub is_rising: bool,
    /// The state there.
    pub state: State<N>,
    /// The velocity there.
    pub v: SVector<f64, N>,
    /// Length of the step that leads there from the node before it.
    pub length: f64,
}

/// The events of a run; see [`Run::events`].
///
/// An item is a [`Crossing`], or the error of the step that fails: then the run is at its last good node, and the iterator ends.
pub struct Events<'a, const N: usize> {
    run: Box<dyn Searched<N> + 'a>,
    wanted: &'a [Event<'a, N>],
    until: f64,
    /// Whether each function was positive, where that is known.
    signs: Vec<Option<bool>>,
    /// What was found in the step that was searched: the last first.
    found: Vec<Crossing<N>>,
    is_over: bool,
}

impl<'a, const N: usize> Events<'a, N> {
    pub(super) fn new<M: Method<S, N>, S: Lagrangian<N> + Copy>(
        run: &'a mut Run<M, S, N>,
        wanted: &'a [Event<'a, N>],
        until: f64,
    ) -> Self {
        let run = Box::new(Ahead { run, ahead: None });
        Self { run, wanted, until, signs: vec![None; wanted.len()], found: Vec::new(), is_over: false }
    }

    /// The next event, or none before the end.
    fn advance(&mut self) -> Result<Option<Crossing<N>>, StepError> {
        while self.found.is_empty() {
            let is_at_end = self.run.take(self.until)?;
            if is_at_end {
                return Ok(None);
            }
            let step = self.run.look_ahead(self.until)?;
            self.found = step.crossings(&*self.run, self.wanted, &mut self.signs)?;
        }
        Ok(self.found.pop())
    }
}

impl<const N: usize> Iterator for Events<'_, N> {
    type Item = Result<Crossing<N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let next = self.advance().transpose();
        self.is_over = !matches!(next, Some(Ok(_)));
        next
    }
}

impl<const N: usize> fmt::Debug for Events<'_, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Events").field("until", &self.until).field("found", &self.found).finish_non_exhaustive()
    }
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// Goes on to the first event, or to the time `until` where there is none before. The run ends there: its state is the one returned. Of functions that
    /// vanish together the first one is told; [`Run::events`] tells all.
    ///
    /// # Errors
    /// As [`Run::until`].
    pub fn next_event(&mut self, events: &[Event<'_, N>], until: f64) -> Result<Option<Crossing<N>>, StepError> {
        let first = self.events(events, until).next().transpose()?;
        if let Some(Crossing { length, .. }) = first {
            if length.to_bits() == self.time_to(until).to_bits() {
                self.end_at(until)?;
            } else if length.is_normal() {
                self.step_of(length)?;
            }
        }
        Ok(first)
    }

    /// The events up to the time `until`, in their order: an iterator, which takes steps as it needs them. The run keeps its own steps, but for the last, which ends
    /// at `until`.
    pub fn events<'a>(&'a mut self, events: &'a [Event<'a, N>], until: f64) -> Events<'a, N> {
        Events::new(self, events, until)
    }
}

/// A run that is searched, its integrator erased: so the search is compiled once, and not for each integrator of each system.
trait Searched<const N: usize> {
    /// Takes the step that was looked at, which ends at `until` where it led beyond. Whether the run is there.
    fn take(&mut self, until: f64) -> Result<bool, StepError>;
    /// The step after the node of the run.
    fn look_ahead(&mut self, until: f64) -> Result<Step<N>, StepError>;
    /// The end of the step of a length, or of the one that ends at `until` if that is shorter.
    fn reached(&self, length: f64, until: f64) -> Result<Reached<N>, StepError>;
}

/// A run, and the run after its next step.
struct Ahead<'a, M: Method<S, N>, S, const N: usize> {
    run: &'a mut Run<M, S, N>,
    ahead: Option<Run<M, S, N>>,
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Searched<N> for Ahead<'_, M, S, N> {
    fn take(&mut self, until: f64) -> Result<bool, StepError> {
        self.run.check_ahead(until)?;
        if let Some(ahead) = self.ahead.take() {
            let is_beyond = ahead.time_to(until) * self.run.h().signum() < 0.0;
            if is_beyond {
                self.run.end_at(until)?;
            } else {
                *self.run = ahead;
            }
        }
        let is_at_end = self.run.time_to(until) == 0.0;
        if is_at_end {
            self.run.set_time(until);
        }
        Ok(is_at_end)
    }

    fn look_ahead(&mut self, until: f64) -> Result<Step<N>, StepError> {
        let start = self.run.state();
        let ahead = self.ahead.insert(self.run.after_a_step()?);
        let path = Box::new(ahead.dense_output(&start)?.since_start());
        let h = self.run.time_to(ahead.t()) + ahead.node().t_low;
        let left = self.run.time_to(until);
        let is_last = ahead.time_to(until) * h.signum() <= 0.0;
        Ok(Step { t: start.t, h, left, is_last, until, path })
    }

    fn reached(&self, length: f64, until: f64) -> Result<Reached<N>, StepError> {
        let mut aside = self.run.clone();
        let left = self.run.time_to(until);
        let length = if length.abs() < left.abs() { length } else { left };
        if length.to_bits() == left.to_bits() {
            aside.end_at(until)?;
        } else if length.is_normal() {
            // A length below the smallest of a step is none.
            aside.step_of(length)?;
        }
        Ok(Reached { length, state: aside.state(), v: aside.velocity()? })
    }
}

/// The end of a step from the node before an event.
struct Reached<const N: usize> {
    length: f64,
    state: State<N>,
    v: SVector<f64, N>,
}

/// A step that is searched.
struct Step<const N: usize> {
    /// Time of the node before it.
    t: f64,
    h: f64,
    /// The time left to the end of the search, `until`.
    left: f64,
    is_last: bool,
    until: f64,
    /// The motion over it, by the time since its start.
    path: Box<dyn DenseOutput<N>>,
}

impl<const N: usize> Step<N> {
    /// The crossings of it, the last first; `signs` go on to its end.
    fn crossings(
        &self,
        run: &dyn Searched<N>,
        wanted: &[Event<'_, N>],
        signs: &mut [Option<bool>],
    ) -> Result<Vec<Crossing<N>>, StepError> {
        let &Self { h, left, .. } = self;
        let mut found = Vec::new();
        for (index, (event, sign)) in wanted.iter().zip(signs).enumerate() {
            let along: &dyn Fn(f64) -> Result<f64, StepError> = &|part| {
                let passed = part * h;
                let state = self.path.state(passed);
                event.value(&State { t: self.t + passed, ..state }, &self.path.velocity(passed))
            };
            let by_steps: &dyn Fn(f64) -> Result<Sample, StepError> = &|part| {
                let Reached { state, v, .. } = run.reached(part * h, f64::INFINITY.copysign(h))?;
                Ok(Sample { part, value: event.value(&state, &v)? })
            };
            // Where a search begins and ends, signs are those of steps: velocities of a path are off there, and the search before or after has another path.
            if sign.is_none() {
                let first = by_steps(START)?;
                *sign = (first.value != 0.0).then_some(first.is_positive());
            }
            let last = if self.is_last { Some(by_steps(left / h + START)?) } else { None };
            for change in changes(along, last, sign)? {
                let Some(part) = located(by_steps, along, &change)? else {
                    // It is in the next step.
                    *sign = Some(!change.is_rising);
                    continue;
                };
                *sign = Some(change.is_rising);
                let length = part * h;
                if event.admits(change.is_rising) && (length - left) * h.signum() <= START * h.abs() {
                    let Reached { state, v, length } = run.reached(length, self.until)?;
                    // Where it is not finite there is no event.
                    event.value(&state, &v)?;
                    found.push(Crossing { event: index, is_rising: change.is_rising, state, v, length });
                }
            }
        }
        found.sort_by(|a, b| b.length.abs().total_cmp(&a.length.abs()));
        Ok(found)
    }
}

impl<const N: usize> Event<'_, N> {
    /// g at a state.
    fn value(&self, state: &State<N>, v: &SVector<f64, N>) -> Result<f64, StepError> {
        let value = (self.g)(state.t, &state.q, v);
        let lost = StepError::NonFinite { t: state.t, quantity: "function of an event", expression: None };
        if value.is_finite() { Ok(value) } else { Err(lost) }
    }

    /// Whether it is one in this direction.
    fn admits(&self, is_rising: bool) -> bool {
        match self.direction {
            Direction::Rising => is_rising,
            Direction::Falling => !is_rising,
            Direction::Both => true,
        }
    }
}
