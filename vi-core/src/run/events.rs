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

use super::Run;
use super::search::{Ahead, Searched, StepEnd, Watched};
use super::side::{Node, ROUNDING, Side};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::real::Dual;
use crate::state::State;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt;
use nalgebra::SVector;

/// Time, coordinates and velocities: the argument of event functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment<const N: usize, T = f64> {
    /// Time.
    pub t: T,
    /// Coordinates.
    pub q: SVector<T, N>,
    /// Velocities.
    pub v: SVector<T, N>,
}

/// The direction of a zero crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Rising,
    Falling,
    Both,
}

/// An event function, and its crossing direction. The function must return the same value for the same arguments.
///
/// A function of dual numbers gives the event a derivative: `Event::smooth_rising(|m| m.q[1] - Dual::fixed(0.2))`.
pub struct Event<const N: usize> {
    g: Function<N>,
    direction: Direction,
}

/// An event function over the numbers T.
type In<const N: usize, T> = Box<dyn Fn(&Moment<N, T>) -> T>;

/// The function of an event.
enum Function<const N: usize> {
    /// In plain numbers.
    Plain(In<N, f64>),
    /// In dual numbers.
    Dual(In<N, Dual<f64>>),
}

impl<const N: usize> Event<N> {
    /// An event at which `g` goes from below zero to zero or above.
    pub fn rising(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: Function::Plain(Box::new(g)), direction: Direction::Rising }
    }

    /// An event at which `g` goes from zero or above to below.
    pub fn falling(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: Function::Plain(Box::new(g)), direction: Direction::Falling }
    }

    /// An event at which `g` rises or falls.
    pub fn crossing(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: Function::Plain(Box::new(g)), direction: Direction::Both }
    }

    /// [`Event::rising`] with a derivative, for [`Tangent::until_event`](crate::derivatives::Tangent::until_event).
    pub fn smooth_rising(g: impl Fn(&Moment<N, Dual<f64>>) -> Dual<f64> + 'static) -> Self {
        Self { g: Function::Dual(Box::new(g)), direction: Direction::Rising }
    }

    /// [`Event::falling`] with a derivative.
    pub fn smooth_falling(g: impl Fn(&Moment<N, Dual<f64>>) -> Dual<f64> + 'static) -> Self {
        Self { g: Function::Dual(Box::new(g)), direction: Direction::Falling }
    }

    /// [`Event::crossing`] with a derivative.
    pub fn smooth_crossing(g: impl Fn(&Moment<N, Dual<f64>>) -> Dual<f64> + 'static) -> Self {
        Self { g: Function::Dual(Box::new(g)), direction: Direction::Both }
    }

    /// Evaluates the function.
    pub(super) fn at(&self, moment: &Moment<N>) -> f64 {
        match &self.g {
            Function::Plain(g) => g(moment),
            Function::Dual(g) => {
                let Moment { t, q, v } = moment;
                g(&Moment { t: Dual::fixed(*t), q: q.map(Dual::fixed), v: v.map(Dual::fixed) }).value
            }
        }
    }

    /// Whether the function takes dual numbers.
    pub(crate) fn has_derivative(&self) -> bool {
        matches!(self.g, Function::Dual(_))
    }

    /// Rate of change of the function along a dual moment; `None` if it does not take dual numbers.
    pub(crate) fn slope(&self, moment: &Moment<N, Dual<f64>>) -> Option<f64> {
        match &self.g {
            Function::Plain(_) => None,
            Function::Dual(g) => Some(g(moment).slope),
        }
    }

    /// Evaluates the function and checks that the value is finite.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] otherwise.
    pub(super) fn value(&self, moment: &Moment<N>) -> Result<f64, StepError> {
        let value = self.at(moment);
        let lost = StepError::NonFinite { t: moment.t, quantity: "function of an event", expression: None };
        if value.is_finite() { Ok(value) } else { Err(lost) }
    }

    /// Rounding error of the value: its change if each argument changes by a rounding.
    pub(super) fn rounding(&self, moment: &Moment<N>, value: f64) -> f64 {
        let mut changed = *moment;
        let mut sum = 0.0;
        for index in 0..=2 * N {
            let argument = |moment: &mut Moment<N>, x: Option<f64>| -> f64 {
                let place = match index.checked_sub(1) {
                    None => &mut moment.t,
                    Some(i) if i < N => &mut moment.q[i],
                    Some(i) => &mut moment.v[i - N],
                };
                core::mem::replace(place, x.unwrap_or(*place))
            };
            let x = argument(&mut changed, None);
            argument(&mut changed, Some(x + ROUNDING * x.abs()));
            let difference = (self.at(&changed) - value).abs();
            argument(&mut changed, Some(x));
            // A rounding does not leave the domain of the function.
            sum += if difference.is_finite() { difference } else { 0.0 };
        }
        sum
    }

    /// Whether the event includes crossings in this direction.
    pub(super) fn admits(&self, is_rising: bool) -> bool {
        match self.direction {
            Direction::Rising => is_rising,
            Direction::Falling => !is_rising,
            Direction::Both => true,
        }
    }

    /// Whether the event includes crossings in this direction only.
    fn admits_only(&self, is_rising: bool) -> bool {
        self.admits(is_rising) && !self.admits(!is_rising)
    }
}

impl<const N: usize> fmt::Debug for Event<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Event").field("direction", &self.direction).finish_non_exhaustive()
    }
}

/// One event or several.
pub trait Events<const N: usize> {
    /// All events.
    fn all(&self) -> &[Event<N>];
}

impl<const N: usize> Events<N> for Event<N> {
    fn all(&self) -> &[Event<N>] {
        core::slice::from_ref(self)
    }
}

impl<const N: usize> Events<N> for [Event<N>] {
    fn all(&self) -> &[Event<N>] {
        self
    }
}

impl<const N: usize, const K: usize> Events<N> for [Event<N>; K] {
    fn all(&self) -> &[Event<N>] {
        self
    }
}

impl<const N: usize> Events<N> for Vec<Event<N>> {
    fn all(&self) -> &[Event<N>] {
        self
    }
}

impl<const N: usize, E: Events<N> + ?Sized> Events<N> for &E {
    fn all(&self) -> &[Event<N>] {
        (**self).all()
    }
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// Takes steps to the first event, or to the time `until` if there is none before. The run ends at the returned
    /// state. The crossing contains all events of that instant; see [`Crossing`].
    ///
    /// # Errors
    /// As [`Run::until`]; [`StepError::NonFinite`] for a function that is not finite; [`StepError::CannotLeave`] if the
    /// run begins at a zero of a one-directional event whose function passes zero again at that instant.
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

/// Takes no notice of a step. One function for all searches, so that they are one type.
#[allow(clippy::unnecessary_wraps, reason = "the type of a function that takes notice")]
fn unwatched<R>(_: &R) -> Result<(), StepError> {
    Ok(())
}

/// One event of an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Met {
    /// Index of the event in the list given.
    pub event: usize,
    /// Whether the function was below zero before.
    pub is_rising: bool,
}

/// The events of one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing<const N: usize> {
    /// The events, in the order of their indices.
    pub events: Vec<Met>,
    /// The state there.
    pub state: State<N>,
    /// The velocity there.
    pub v: SVector<f64, N>,
    /// Length of the step from the previous node to this state.
    pub length: f64,
}

impl<const N: usize> Crossing<N> {
    /// Whether this instant includes the event of this index.
    #[must_use]
    pub fn is_of(&self, event: usize) -> bool {
        self.direction(event).is_some()
    }

    /// Whether the function of the event of this index rose; `None` if the event did not occur.
    #[must_use]
    pub fn direction(&self, event: usize) -> Option<bool> {
        self.events.iter().find(|met| met.event == event).map(|met| met.is_rising)
    }
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
        let t = Node::of(self.run.node())?.moment.t;
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
        let mut node = Node::of(self.run.node())?;
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

impl<const N: usize> StepEnd<N> {
    /// The moment of this crossing.
    pub(super) fn moment(&self) -> Moment<N> {
        Moment { t: self.state.t, q: self.state.q, v: self.v }
    }
}
