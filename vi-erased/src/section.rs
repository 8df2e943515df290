//! Events of a run, type-erased.
//!
//! In: a coordinate or velocity with a value, a period, or any function of time, coordinates and velocities. Out: an
//! [`Event`] of a system with N coordinates.

use core::fmt;
use std::sync::Arc;
#[cfg(feature = "derivatives")]
use vi_core::real::Dual;
use vi_core::run::{Event, Moment};

/// The direction in which a function crosses zero, along the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The function rises through zero.
    Rising,
    /// The function falls through zero.
    Falling,
    /// Both directions.
    Both,
}

/// A function of time, coordinates and velocities.
#[derive(Clone)]
pub struct Watch(Arc<Function>);

/// A function of t, q, v.
type Function = dyn Fn(f64, &[f64], &[f64]) -> f64 + Send + Sync;

impl Watch {
    /// The function `g(t, q, v)`.
    pub fn new(g: impl Fn(f64, &[f64], &[f64]) -> f64 + Send + Sync + 'static) -> Self {
        Self(Arc::new(g))
    }

    /// The value of the function.
    #[must_use]
    pub fn value(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        (self.0)(t, q, v)
    }
}

impl PartialEq for Watch {
    /// Whether it is the same function.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Watch")
    }
}

/// A surface that a motion crosses, in a direction.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// A coordinate crosses this value.
    Coordinate {
        /// Index of the coordinate.
        index: usize,
        /// Its value.
        at: f64,
        /// Rising, falling, or both.
        direction: Direction,
    },
    /// A velocity crosses this value.
    Velocity {
        /// Index of its coordinate.
        index: usize,
        /// Its value.
        at: f64,
        /// Rising, falling, or both.
        direction: Direction,
    },
    /// The time is `start` plus a whole number of periods.
    Period {
        /// Time of the first one.
        start: f64,
        /// The time between two crossings.
        period: f64,
    },
    /// A function crosses zero.
    Function(Watch, Direction),
}

impl Section {
    /// A function that changes sign at the section.
    fn value(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        match self {
            Self::Coordinate { index, at, .. } => q[*index] - at,
            Self::Velocity { index, at, .. } => v[*index] - at,
            Self::Period { start, period } => {
                let passed = (t - start) / period;
                // Within half a period of zero, so that late crossings are as accurate as early ones.
                let is_odd = if passed.round() % 2.0 == 0.0 { 1.0 } else { -1.0 };
                is_odd * (core::f64::consts::PI * (passed - passed.round())).sin()
            }
            Self::Function(g, _) => g.value(t, q, v),
        }
    }

    fn direction(&self) -> Direction {
        match self {
            Self::Coordinate { direction, .. } | Self::Velocity { direction, .. } | Self::Function(_, direction) => {
                *direction
            }
            Self::Period { .. } => Direction::Both,
        }
    }

    /// The event that the function crosses zero in the direction of the section.
    pub(crate) fn event<const N: usize>(&self) -> Event<N> {
        let section = self.clone();
        let g = move |moment: &Moment<N>| section.value(moment.t, moment.q.as_slice(), moment.v.as_slice());
        match self.direction() {
            Direction::Rising => Event::rising(g),
            Direction::Falling => Event::falling(g),
            Direction::Both => Event::crossing(g),
        }
    }

    /// The same event with a derivative; `None` for a period and a function, which have none.
    #[cfg(feature = "derivatives")]
    pub(crate) fn smooth_event<const N: usize>(&self) -> Option<Event<N>> {
        let (is_velocity, index, at) = match self {
            Self::Coordinate { index, at, .. } => (false, *index, *at),
            Self::Velocity { index, at, .. } => (true, *index, *at),
            Self::Period { .. } | Self::Function(..) => return None,
        };
        let g = move |moment: &Moment<N, Dual<f64>>| {
            (if is_velocity { moment.v[index] } else { moment.q[index] }) - Dual::fixed(at)
        };
        Some(match self.direction() {
            Direction::Rising => Event::smooth_rising(g),
            Direction::Falling => Event::smooth_falling(g),
            Direction::Both => Event::smooth_crossing(g),
        })
    }
}
