//! The step as the steps before it foretell it.
//!
//! In: the velocities and lengths of the last steps. Out: the root of both equations by one Newton step, where that is
//! shorter than what is trusted (`forecast`), the length stays inside the range and D keeps its sign. `None` else, and
//! for every 64th step, which learns what may be trusted.

use super::newton::{self, Elimination, Root, Trial};
use super::{Last, RATIO};
use crate::forecast::{Forecast, length_squared};
use crate::{Node, Real, Scalar, Stepping};
use nalgebra::SVector;

/// Residual that is left where nothing was evaluated to confirm it, at most, in roundings: a quarter by v, a quarter by h.
const UNCONFIRMED: f64 = 0.5;

/// The forecasts of v and h, which learn together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(super) struct Forecasts<const N: usize, T> {
    v: Forecast<N, T>,
    h: Forecast<1, T>,
}

impl<const N: usize, T: Real> Forecasts<N, T> {
    /// Before the first step, which follows the interval `(v, h)`.
    pub(super) fn new(v: SVector<T, N>, h: T) -> Self {
        Self { v: Forecast::new(v), h: Forecast::new(SVector::repeat(h)) }
    }

    /// Whether the next step is one that learns.
    #[inline]
    pub(super) fn is_learning(&self) -> bool {
        self.v.is_learning()
    }

    /// Whether everything is a finite number.
    pub(super) fn is_finite(&self) -> bool {
        self.v.is_finite() && self.h.is_finite()
    }

    /// The forecasts after the step `(v, h)`.
    #[inline]
    pub(super) fn after(self, v: SVector<T, N>, h: T) -> Self {
        Self { v: self.v.after(v), h: self.h.after(SVector::repeat(h)) }
    }
}

impl<const N: usize, T: Scalar> Forecasts<N, T> {
    /// The root, where it was foretold.
    #[inline]
    pub(super) fn root<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        last: &Last<N, T>,
    ) -> Option<Root<N, T>> {
        if !S::SMOOTH || self.is_learning() {
            return None;
        }
        let [guess] = self.h.guess().into();
        let trial = Trial { v: self.v.guess(), h: guess };
        let equations = system.extended_system(node, trial.h, &trial.v);
        let elimination = Elimination::of(&equations);
        let step = elimination.step(&equations, &trial);
        let (v, h) = (trial.v + step.v, trial.h + step.h);
        let density = elimination.density_or_infinite();
        let trusted = length_squared(&step.v) <= self.v.radius() && step.h * step.h <= self.h.radius();
        let in_range = h * T::real(RATIO) >= last.h && h <= last.h * T::real(RATIO);
        let forward = density * last.density > T::zero() && !elimination.is_degenerate();
        let root = Root { v, h, density, iterations: 1, residual: UNCONFIRMED, approach: None };
        (trusted && in_range && forward).then_some(root)
    }

    /// The forecasts after a step that was not foretold: what it taught.
    #[cold]
    pub(super) fn learnt<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>, root: &Root<N, T>) -> Self {
        let h = SVector::repeat(root.h);
        let radius = |(lesson, rounding): (crate::forecast::Lesson<T>, T)| {
            let radius = lesson.radius() * rounding;
            if radius.is_finite() { radius } else { T::zero() }
        };
        match newton::lessons(system, node, root).filter(|_| S::SMOOTH) {
            Some([by_v, by_h]) => Self { v: self.v.learnt(root.v, radius(by_v)), h: self.h.learnt(h, radius(by_h)) },
            None => Self { v: self.v.learnt(root.v, T::zero()), h: self.h.learnt(h, T::zero()) },
        }
    }
}
