//! States at which functions of the motion change their sign.
//!
//! In: a run, functions g(t, q, v), a time to end at. Out: the states at which one of them changes its sign, in the order of the run.
//!
//! ```text
//! sign       zero counts as positive: g RISES if it goes from below zero to zero or above, and FALLS if it goes from zero or above to below
//! side       the sign that g has next (`side`): at the start of a search, at its end, and after each event
//! event      the side after an instant is not the sign before it
//! instant    the times that differ by at most the resolution of time, four roundings of t, and no more than a millionth of a step
//! ```
//!
//! A function that only touches zero has the same side as before, so that is no event. Two searches that meet at a node agree on the side there:
//! exactly one of them reports an event at their seam. AFTER AN EVENT g has not left its old side, to a rounding of its arguments, and it does with the
//! next longer length of the step: a ball is not below its floor, even if it is stopped there. Rising and falling are meant in the direction of the run.

use super::Run;
use super::search::{Ahead, Reached, Searched, Watched};
use super::side::{Node, ROUNDING, Side};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::real::Dual;
use crate::state::State;
use core::fmt;
use nalgebra::SVector;

/// Where a motion is: the argument of functions of events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment<const N: usize, T = f64> {
    /// Time.
    pub t: T,
    /// Coordinates.
    pub q: SVector<T, N>,
    /// Velocities.
    pub v: SVector<T, N>,
}

/// In which direction a function passes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    Rising,
    Falling,
    Both,
}

/// A function of the motion, and the direction in which it passes zero. The function has to be the same for the same arguments.
///
/// A function in dual numbers gives the event a derivative: `Event::smooth_rising(|m| m.q[1] - Dual::fixed(0.2))`.
pub struct Event<const N: usize> {
    g: Function<N>,
    direction: Direction,
}

/// A function of an event in some numbers.
type In<const N: usize, T> = Box<dyn Fn(&Moment<N, T>) -> T>;

/// The function of an event.
enum Function<const N: usize> {
    /// In plain numbers.
    Plain(In<N, f64>),
    /// In dual numbers.
    Dual(In<N, Dual<f64>>),
}

impl<const N: usize> Event<N> {
    /// Where `g` goes from below zero to zero or above.
    pub fn rising(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: Function::Plain(Box::new(g)), direction: Direction::Rising }
    }

    /// Where `g` goes from zero or above to below.
    pub fn falling(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: Function::Plain(Box::new(g)), direction: Direction::Falling }
    }

    /// Where `g` rises or falls.
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

    /// The function.
    pub(super) fn at(&self, moment: &Moment<N>) -> f64 {
        match &self.g {
            Function::Plain(g) => g(moment),
            Function::Dual(g) => {
                let Moment { t, q, v } = moment;
                g(&Moment { t: Dual::fixed(*t), q: q.map(Dual::fixed), v: v.map(Dual::fixed) }).value
            }
        }
    }

    /// Whether the function is in dual numbers.
    pub(crate) fn has_derivative(&self) -> bool {
        matches!(self.g, Function::Dual(_))
    }

    /// How fast the function changes with a moment that does; `None` if it is not in dual numbers.
    pub(crate) fn slope(&self, moment: &Moment<N, Dual<f64>>) -> Option<f64> {
        match &self.g {
            Function::Plain(_) => None,
            Function::Dual(g) => Some(g(moment).slope),
        }
    }

    /// The function, if it is finite.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] otherwise.
    pub(super) fn value(&self, moment: &Moment<N>) -> Result<f64, StepError> {
        let value = self.at(moment);
        let lost = StepError::NonFinite { t: moment.t, quantity: "function of an event", expression: None };
        if value.is_finite() { Ok(value) } else { Err(lost) }
    }

    /// By how much the value changes if each argument changes by a rounding.
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
            // Beyond the domain of the function a rounding does not lead.
            sum += if difference.is_finite() { difference } else { 0.0 };
        }
        sum
    }

    /// Whether the event is one in this direction.
    pub(super) fn admits(&self, is_rising: bool) -> bool {
        match self.direction {
            Direction::Rising => is_rising,
            Direction::Falling => !is_rising,
            Direction::Both => true,
        }
    }

    /// Whether the event is one in this direction only.
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
    /// All of them.
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
    /// Goes on to the first event, or to the time `until` if there is none before. The run ends there: its state is the one returned. All events of that
    /// instant are in the crossing; see [`Crossing`].
    ///
    /// # Errors
    /// As [`Run::until`], [`StepError::NonFinite`] for a function that is not finite, and [`StepError::CannotLeave`] if the run begins at a
    /// zero of an event of one direction and the motion leads through it again at that instant.
    pub fn next_event(&mut self, events: impl Events<N>, until: f64) -> Result<Option<Crossing<N>>, StepError> {
        Crossings::new(self, events, until).stop()
    }

    /// [`Run::next_event`] for one event.
    ///
    /// # Errors
    /// As there.
    pub fn until_event(&mut self, event: Event<N>, end: f64) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(event, end)
    }

    /// Goes on to where `g` rises, or to the time `end`: [`Run::next_event`] for [`Event::rising`].
    ///
    /// # Errors
    /// As there.
    pub fn until_rising(
        &mut self,
        g: impl Fn(&Moment<N>) -> f64 + 'static,
        end: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(Event::rising(g), end)
    }

    /// Goes on to where `g` falls, or to the time `end`: [`Run::next_event`] for [`Event::falling`].
    ///
    /// # Errors
    /// As there.
    pub fn until_falling(
        &mut self,
        g: impl Fn(&Moment<N>) -> f64 + 'static,
        end: f64,
    ) -> Result<Option<Crossing<N>>, StepError> {
        self.next_event(Event::falling(g), end)
    }

    /// The events up to the time `until`, in their order: an iterator that takes steps as it needs them. The run keeps its own steps, except for the last, which ends
    /// at `until`.
    pub fn events<'a>(&'a mut self, events: impl Events<N> + 'a, until: f64) -> Crossings<'a, N> {
        Crossings::new(self, events, until)
    }
}

/// One of the events that were met at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Met {
    /// The index of the event among those that were asked for.
    pub event: usize,
    /// Whether the function was below zero before.
    pub is_rising: bool,
}

/// The events that were met at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing<const N: usize> {
    /// The events, by their index.
    pub events: Vec<Met>,
    /// The state there.
    pub state: State<N>,
    /// The velocity there.
    pub v: SVector<f64, N>,
    /// Length of the step that leads there from the node before it.
    pub length: f64,
}

impl<const N: usize> Crossing<N> {
    /// Whether the event of this index was met.
    #[must_use]
    pub fn is_of(&self, event: usize) -> bool {
        self.direction(event).is_some()
    }

    /// Whether the function of the event of this index was rising; `None` if the event was not met.
    #[must_use]
    pub fn direction(&self, event: usize) -> Option<bool> {
        self.events.iter().find(|met| met.event == event).map(|met| met.is_rising)
    }
}

/// The events of a run; see [`Run::events`].
///
/// An item is a [`Crossing`], or the error of the step that fails. After an error the run is at its last good node, and the iterator ends.
pub struct Crossings<'a, const N: usize> {
    run: Box<dyn Searched<N> + 'a>,
    wanted: Box<dyn Events<N> + 'a>,
    until: f64,
    /// What is known of each function; nothing before the first step.
    watched: Vec<Watched>,
    /// What was found in the step that was searched, the last first.
    found: Vec<Result<Crossing<N>, StepError>>,
    is_over: bool,
}

impl<'a, const N: usize> Crossings<'a, N> {
    pub(super) fn new<M, S>(run: &'a mut Run<M, S, N>, wanted: impl Events<N> + 'a, until: f64) -> Self
    where
        M: Method<S, N>,
        S: Lagrangian<N> + Copy,
    {
        let run = Box::new(Ahead::new(run));
        Self { run, wanted: Box::new(wanted), until, watched: Vec::new(), found: Vec::new(), is_over: false }
    }

    /// Goes on to the first crossing.
    ///
    /// # Errors
    /// Those of the steps, and [`StepError::CannotLeave`].
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

    /// On which side of zero each function is at the start of the search.
    fn start(&mut self) -> Result<Vec<Side>, StepError> {
        let mut node = Node::of(self.run.node())?;
        let sides = self.wanted.all().iter().map(|event| node.side(event)).collect::<Result<Vec<_>, _>>()?;
        self.watched = sides.iter().map(Watched::new).collect();
        Ok(sides)
    }

    /// The next crossing, or none before the end; with `is_first` no further one is wanted.
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

impl<const N: usize> Reached<N> {
    /// Where the motion is there.
    pub(super) fn moment(&self) -> Moment<N> {
        Moment { t: self.state.t, q: self.state.q, v: self.v }
    }
}
