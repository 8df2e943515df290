//! States at sign changes of event functions.
//!
//! For event functions g(t, q, v) and an end time, the search returns the states at which a function changes sign, in
//! order.
//!
//! ```text
//! sign       zero counts as positive: g RISES if it goes from below zero to zero or above, and FALLS if it goes from zero or above to below
//! side       the sign that g has next (`side`): at the start of a search, at its end, and after each event
//! event      the side after an instant differs from the sign before it
//! instant    times that differ by at most the time resolution: four roundings of t, and at most a millionth of a step
//! ```
//!
//! A function that only touches zero keeps its side, so there is no event. Two searches that meet at a node agree on
//! the side there, so that exactly one of them reports an event at their common end. At the returned state g has its
//! old side, to a rounding of its arguments, and leaves it at the next longer step length: a ball is never below its
//! floor, even if the run stops there. Rising and falling refer to the direction of the run.
//!
//! A step may pass a dead point of a mechanism, but no step ends at it. The dense output then gives the crossing, and a
//! run cannot stop at it.

use super::Run;
use super::event::{Crossing, Event, Events, Moment};
use super::search::{Ahead, Searched, Watched};
use super::side::{NodeAndAfter, Side};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt;

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// Takes steps to the first event, or to the time `until` if there is none before. The run ends at the returned
    /// state. The crossing contains all events of that instant; see [`Crossing`].
    ///
    /// # Errors
    /// As [`Run::until`]; [`StepError::Singular`] for an event at a dead point of a mechanism, at which no step ends;
    /// [`StepError::NonFinite`] for a function that is not finite; [`StepError::CannotLeave`] if the run begins at a
    /// zero of a one-directional event whose function passes zero again at that instant.
    pub fn next_event(&mut self, events: impl Events<N>, until: f64) -> Result<Option<Crossing<N>>, StepError> {
        Crossings::new(self, events, until, unwatched).stop()
    }

    /// [`Run::next_event`] for one event.
    ///
    /// # Errors
    /// As [`Run::next_event`].
    pub fn until_event(&mut self, event: Event<N>, end: f64) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(event, end)
    }

    /// Takes steps until `g` rises, or to the time `end`: [`Run::next_event`] for [`Event::rising`].
    ///
    /// # Errors
    /// As [`Run::next_event`].
    pub fn until_rising(
        &mut self,
        g: impl Fn(&Moment<N>) -> f64 + 'static,
        end: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(Event::rising(g), end)
    }

    /// Takes steps until `g` falls, or to the time `end`: [`Run::next_event`] for [`Event::falling`].
    ///
    /// # Errors
    /// As [`Run::next_event`].
    pub fn until_falling(
        &mut self,
        g: impl Fn(&Moment<N>) -> f64 + 'static,
        end: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(Event::falling(g), end)
    }

    /// Iterates over the events up to the time `until` and takes steps on demand. The run keeps its own steps, except
    /// for the last, which ends at `until`. If the iterator is dropped after an event, the run is at the node before it.
    pub fn events<'a>(&'a mut self, events: impl Events<N> + 'a, until: f64) -> Crossings<'a, N> {
        Crossings::new(self, events, until, unwatched)
    }
}

/// Ignores a step. One function for all searches, so that they have one type.
#[allow(clippy::unnecessary_wraps, reason = "the type of functions that watch steps")]
fn unwatched<R>(_: &R) -> Result<(), StepError> {
    Ok(())
}

/// The events of a run; see [`Run::events`].
///
/// An item is a [`Crossing`], or the error of the failed step. After an error the run is at its last good node, and the
/// iterator ends.
pub struct Crossings<'a, const N: usize> {
    run: Box<dyn Searched<N> + 'a>,
    wanted: Box<dyn Events<N> + 'a>,
    until: f64,
    /// The state of each function; empty before the first step.
    watched: Vec<Watched>,
    /// Results of the last searched step, in reverse order.
    found: Vec<Result<Crossing<N>, StepError>>,
    is_over: bool,
}

impl<'a, const N: usize> Crossings<'a, N> {
    /// The crossings of a run; `watch` is called after each of its steps, and its error ends them.
    pub(super) fn new<M, S>(
        run: &'a mut Run<M, S, N>,
        wanted: impl Events<N> + 'a,
        until: f64,
        watch: impl FnMut(&Run<M, S, N>) -> Result<(), StepError> + 'a,
    ) -> Self
    where
        M: Method<S, N>,
        S: Lagrangian<N> + Copy,
    {
        let run = Box::new(Ahead::new(run, watch));
        Self { run, wanted: Box::new(wanted), until, watched: Vec::new(), found: Vec::new(), is_over: false }
    }

    /// Takes steps to the first crossing.
    ///
    /// # Errors
    /// Errors of the steps, and [`StepError::CannotLeave`].
    pub(super) fn stop(mut self) -> Result<Option<Crossing<N>>, StepError> {
        if self.run.take(self.until)? {
            return Ok(None);
        }
        let t = NodeAndAfter::of(self.run.node())?.moment.t;
        let sides = self.start()?;
        let cannot_leave =
            |event: usize, within: f64| Err(StepError::CannotLeave { t, event, value: sides[event].value, within });
        let is_held = |(side, event): (&Side, &Event<N>)| side.is_turned && event.admits_only(side.is_positive);
        if let Some(event) = sides.iter().zip(self.wanted.all()).position(is_held) {
            return cannot_leave(event, sides[event].after);
        }
        let Some(crossing) = self.advance(true)? else { return Ok(None) };
        let again = crossing.events.iter().find(|met| sides[met.event].is_zero);
        match again {
            Some(met) if crossing.state.t.to_bits() == t.to_bits() => cannot_leave(met.event, crossing.length.abs()),
            _ => self.run.stop(crossing.length).map(|()| Some(crossing)),
        }
    }

    /// The side of each function at the start of the search.
    fn start(&mut self) -> Result<Vec<Side>, StepError> {
        let mut node = NodeAndAfter::of(self.run.node())?;
        let sides = self.wanted.all().iter().map(|event| node.side(event)).collect::<Result<Vec<_>, _>>()?;
        self.watched = sides.iter().map(Watched::new).collect();
        Ok(sides)
    }

    /// The next crossing; `None` if there is none before the end. With `is_first` the search stops at it.
    fn advance(&mut self, is_first: bool) -> Result<Option<Crossing<N>>, StepError> {
        while self.found.is_empty() {
            if self.run.take(self.until)? {
                return Ok(None);
            }
            if self.watched.is_empty() {
                self.start()?;
            }
            let step = self.run.look_ahead(self.until)?;
            self.found = step.crossings(&*self.run, self.wanted.all(), &mut self.watched, is_first);
            self.found.reverse();
        }
        self.found.pop().transpose()
    }
}

impl<const N: usize> Iterator for Crossings<'_, N> {
    type Item = Result<Crossing<N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_over {
            return None;
        }
        let next = self.advance(false).transpose();
        self.is_over = !matches!(next, Some(Ok(_)));
        next
    }
}

impl<const N: usize> fmt::Debug for Crossings<'_, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Crossings").field("until", &self.until).field("found", &self.found).finish_non_exhaustive()
    }
}
