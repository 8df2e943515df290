//! The step as the steps before it foretell it.
//!
//! In: the velocities and lengths of the last steps. Out: the root of both equations by Newton steps from the guess, the last
//! of them shorter than what is trusted (`lesson`), the length stays inside the range and D keeps its sign. `None` else, and
//! for every 64th step, which learns what may be trusted.

use super::lesson::Radii;
use super::newton::{self, Elimination, Root, Trial};
use super::{Last, RATIO};
use crate::forecast::{Forecast, length_squared};
use crate::{Increment, Node, Scalar, Stepping};
use nalgebra::SVector;

/// Residual where nothing was evaluated to confirm it, in roundings: that of the evaluation before.
const UNCONFIRMED: f64 = 1.0;

/// Newton steps that may follow a guess.
const ATTEMPTS: u32 = 3;

/// The forecasts of v and h, which learn together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::Real + serde::Serialize",
        deserialize = "T: crate::Real + serde::Deserialize<'de>"
    ))
)]
pub(super) struct Forecasts<const N: usize, T> {
    v: Forecast<N, T>,
    h: Forecast<1, T>,
    radii: Radii<T>,
    /// Where the next step evaluates L.
    place: SVector<T, N>,
}

/// A step that was foretold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<const N: usize, T> {
    /// What solves the equations.
    pub(super) root: Root<N, T>,
    /// What is gained over it.
    pub(super) gain: Increment<N, T>,
    /// Where the last Newton step began,
    trial: Trial<N, T>,
    /// and that step.
    step: newton::Step<N, T>,
}

impl<const N: usize, T: Scalar> Forecasts<N, T> {
    /// Before the first step, which follows the interval `(v, h)`.
    pub(super) fn new(v: SVector<T, N>, h: T) -> Self {
        let (v, h) = (Forecast::new(v), Forecast::new(SVector::repeat(h)));
        Self { v, h, radii: Radii::zero(), place: SVector::zeros() }
    }

    /// Whether the next step is one that learns.
    #[inline]
    pub(super) fn is_learning(&self) -> bool {
        self.v.is_learning()
    }

    /// Where the next step begins its iteration.
    #[inline]
    fn guess(&self) -> Trial<N, T> {
        let [h]: [T; 1] = self.h.guess().into();
        Trial { v: self.v.guess(), h }
    }

    /// Whether everything is a finite number.
    pub(super) fn is_finite(&self) -> bool {
        let place = self.place.iter().all(|entry| entry.is_finite());
        place && self.v.is_finite() && self.h.is_finite() && self.radii.is_finite()
    }

    /// Takes the step from `node` that was foretold.
    #[inline]
    pub(super) fn push<S: Stepping<N, T>>(&mut self, node: &Node<N, T>, found: &Found<N, T>) {
        let Found { trial, step, .. } = found;
        if let Some(place) = self.place_after::<S>(node, found) {
            self.place = place;
        }
        self.v.push(&trial.v, &step.v);
        self.h.push(&SVector::repeat(trial.h), &SVector::repeat(step.h));
    }

    /// Where [`Stepping::extended_step`] evaluates L in the step after `found` from this node, where it is told at all. To it δ gives
    /// a multiple of itself only: what waits for δ is little.
    #[inline]
    fn place_after<S: Stepping<N, T>>(
        &self,
        node: &Node<N, T>,
        Found { trial, step, .. }: &Found<N, T>,
    ) -> Option<SVector<T, N>> {
        let part = T::real(S::PLACE?);
        let (weight_v, weight_h) = (self.v.weight() * part, self.h.weight());
        let h = self.h.after(0, trial.h);
        let (by_v, by_both) = (trial.h + h * weight_v, T::one() + weight_v * weight_h);
        let mut place = node.q;
        for i in 0..N {
            let v = self.v.after(i, trial.v[i]) * part;
            let foretold = node.q[i] + (node.q_low[i] + (trial.h * trial.v[i] + h * v));
            let by_h = trial.v[i] + v * weight_h;
            place[i] = foretold + (step.v[i] * (by_v + step.h * by_both) + step.h * by_h);
        }
        Some(place)
    }

    /// The root and what is gained over it, where it was foretold.
    #[inline(always)]
    pub(super) fn root<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        last: &Last<N, T>,
    ) -> Option<Found<N, T>> {
        if !S::SMOOTH || self.is_learning() {
            return None;
        }
        let (mut trial, mut place, mut before) = (self.guess(), self.place, None);
        for iterations in 1..=ATTEMPTS {
            let mut newton = None;
            let gain = system.extended_step(node, &place, trial.h, &trial.v, |equations| {
                let elimination = Elimination::of(equations);
                let step = elimination.step(equations, &trial);
                newton = Some((elimination, step));
                (step.v, step.h)
            });
            let (elimination, step) = newton?;
            let next = Trial { v: trial.v + step.v, h: trial.h + step.h };
            let lengths = (length_squared(&step.v), step.h * step.h);
            // Steps that do not become much shorter lead to another root, or to none.
            let shorter = |now: T, before: T, radius: T| now <= (before * T::real(0.25)).max(radius);
            let contracts =
                before.is_none_or(|(v, h)| shorter(lengths.0, v, self.radii.v) && shorter(lengths.1, h, self.radii.h));
            if !contracts {
                return None;
            }
            if self.radii.admit(lengths) {
                let (Trial { v, h }, density) = (next, elimination.density_or_infinite());
                let in_range = h * T::real(RATIO) >= last.h && h <= last.h * T::real(RATIO);
                // At the smallest root D has the sign that it had.
                let forward = density * last.density > T::zero() && !elimination.is_degenerate();
                let root = Root { v, h, density, iterations, residual: UNCONFIRMED };
                return (in_range && forward).then_some(Found { root, gain, trial, step });
            }
            (before, trial) = (Some(lengths), next);
            place = node.place::<S>(trial.h, &trial.v);
        }
        None
    }

    /// Takes the step `root` to `end` that was not foretold, after the interval `last`, and what it taught.
    pub(super) fn learn<S: Stepping<N, T>>(
        &mut self,
        system: &S,
        node: &Node<N, T>,
        last: &Last<N, T>,
        root: &Root<N, T>,
        end: &Node<N, T>,
    ) {
        let change = root.v - last.v;
        self.radii = if S::SMOOTH { Radii::learnt(system, node, root, change) } else { Radii::zero() };
        self.v.learn(root.v, self.radii.v);
        self.h.learn(SVector::repeat(root.h), self.radii.h);
        let Trial { v, h } = self.guess();
        self.place = end.place::<S>(h, &v);
    }
}
