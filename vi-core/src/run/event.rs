//! Event functions, and the crossings that a search finds.

use crate::error::StepError;
use crate::real::Dual;
use crate::state::State;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt;
use nalgebra::SVector;

/// Relative rounding error of the end of a step: a few roundings.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

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
    g: EventFunction<N>,
    direction: Direction,
}

/// An event function over the numbers T.
type In<const N: usize, T> = Box<dyn Fn(&Moment<N, T>) -> T>;

/// The function of an event.
enum EventFunction<const N: usize> {
    /// A function of plain numbers.
    Plain(In<N, f64>),
    /// A function of dual numbers.
    Dual(In<N, Dual<f64>>),
}

impl<const N: usize> Event<N> {
    /// An event at which `g` goes from below zero to zero or above.
    pub fn rising(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: EventFunction::Plain(Box::new(g)), direction: Direction::Rising }
    }

    /// An event at which `g` goes from zero or above to below.
    pub fn falling(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: EventFunction::Plain(Box::new(g)), direction: Direction::Falling }
    }

    /// An event at which `g` rises or falls.
    pub fn crossing(g: impl Fn(&Moment<N>) -> f64 + 'static) -> Self {
        Self { g: EventFunction::Plain(Box::new(g)), direction: Direction::Both }
    }

    /// [`Event::rising`] with a derivative, for [`Tangent::until_event`](crate::derivatives::Tangent::until_event).
    pub fn smooth_rising(g: impl Fn(&Moment<N, Dual<f64>>) -> Dual<f64> + 'static) -> Self {
        Self { g: EventFunction::Dual(Box::new(g)), direction: Direction::Rising }
    }

    /// [`Event::falling`] with a derivative.
    pub fn smooth_falling(g: impl Fn(&Moment<N, Dual<f64>>) -> Dual<f64> + 'static) -> Self {
        Self { g: EventFunction::Dual(Box::new(g)), direction: Direction::Falling }
    }

    /// [`Event::crossing`] with a derivative.
    pub fn smooth_crossing(g: impl Fn(&Moment<N, Dual<f64>>) -> Dual<f64> + 'static) -> Self {
        Self { g: EventFunction::Dual(Box::new(g)), direction: Direction::Both }
    }

    /// Evaluates the function.
    pub(super) fn at(&self, moment: &Moment<N>) -> f64 {
        match &self.g {
            EventFunction::Plain(g) => g(moment),
            EventFunction::Dual(g) => {
                let Moment { t, q, v } = moment;
                g(&Moment { t: Dual::fixed(*t), q: q.map(Dual::fixed), v: v.map(Dual::fixed) }).value
            }
        }
    }

    /// Whether the function takes dual numbers.
    pub(crate) fn has_derivative(&self) -> bool {
        matches!(self.g, EventFunction::Dual(_))
    }

    /// Rate of change of the function along a dual moment; `None` if it does not take dual numbers.
    pub(crate) fn slope(&self, moment: &Moment<N, Dual<f64>>) -> Option<f64> {
        match &self.g {
            EventFunction::Plain(_) => None,
            EventFunction::Dual(g) => Some(g(moment).slope),
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
    pub(super) fn admits_only(&self, is_rising: bool) -> bool {
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
    /// The state at this instant.
    pub state: State<N>,
    /// The velocity at this instant.
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
