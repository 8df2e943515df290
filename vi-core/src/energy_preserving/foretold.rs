//! The step as the steps before it foretell it.
//!
//! In: the velocities and lengths of the last steps. Out: the root of both equations by Newton steps from the guess, the last
//! of them shorter than what is trusted (`forecast`), the length stays inside the range and D keeps its sign. `None` else, and
//! for every 64th step, which learns what may be trusted.

use super::newton::{self, Elimination, Root, Trial};
use super::{Last, RATIO};
use crate::forecast::{Forecast, Lesson, length_squared};
use crate::{Increment, Node, Scalar, Stepping};
use nalgebra::SVector;

/// Part of a rounding that the iteration may leave in v and in h. It has a sign, and a million of them add up: with a quarter
/// the angular momentum of Kepler's problem drifts by 1.3e-12 in a million steps, with this by less than 1e-13.
const SHARE: f64 = 1.0 / 256.0;
/// The same of what is left out of a gain.
const SHARE_OF_GAIN: f64 = 1.0 / 16.0;
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

    /// Takes a step that was foretold.
    #[inline]
    pub(super) fn push(&mut self, Found { trial, step, .. }: &Found<N, T>) {
        self.v.push(&trial.v, &step.v);
        self.h.push(&SVector::repeat(trial.h), &SVector::repeat(step.h));
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
        let [h] = self.h.guess().into();
        let (mut trial, mut before) = (Trial { v: self.v.guess(), h }, None);
        for iterations in 1..=ATTEMPTS {
            let mut newton = None;
            let gain = system.extended_step(node, trial.h, &trial.v, |equations| {
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
            let contracts = before
                .is_none_or(|(v, h)| shorter(lengths.0, v, self.v.radius()) && shorter(lengths.1, h, self.h.radius()));
            if !contracts {
                return None;
            }
            if lengths.0 <= self.v.radius() && lengths.1 <= self.h.radius() {
                let (Trial { v, h }, density) = (next, elimination.density_or_infinite());
                let in_range = h * T::real(RATIO) >= last.h && h <= last.h * T::real(RATIO);
                // At the smallest root D has the sign that it had.
                let forward = density * last.density > T::zero() && !elimination.is_degenerate();
                let root = Root { v, h, density, iterations, residual: UNCONFIRMED, approach: None };
                return (in_range && forward).then_some(Found { root, gain, trial, step });
            }
            (before, trial) = (Some(lengths), next);
        }
        None
    }

    /// Takes a step that was not foretold, after the interval `last`, and what it taught.
    pub(super) fn learn<S: Stepping<N, T>>(
        &mut self,
        system: &S,
        node: &Node<N, T>,
        last: &Last<N, T>,
        (root, gain): (&Root<N, T>, &Increment<N, T>),
    ) {
        let lessons = newton::lessons(system, node, root).filter(|_| S::SMOOTH);
        let [by_v, by_h] = lessons.map_or([T::zero(); 2], |lessons| {
            let radii = lessons.map(|(lesson, rounding)| lesson.radius(SHARE) * rounding);
            // What gains are off by that are carried to the first order only: of the second order too, but another one.
            let (dv, dh) = (root.v - last.v, root.h - last.h);
            let carried = system.extended_step(node, last.h, &last.v, |_| (dv, dh));
            let noise = system.magnitudes(node, root.h, &root.v);
            let epsilon = T::real(T::EPSILON);
            let momentum =
                (length_squared(&(carried.momentum - gain.momentum)), length_squared(&(noise.residual * epsilon)));
            let energy = (carried.energy - gain.energy, noise.energy_residual * epsilon);
            let part = |(second, rounding)| Lesson { first: T::one(), second, rounding }.radius(SHARE_OF_GAIN);
            let part = lesser(part(momentum), part((energy.0 * energy.0, energy.1 * energy.1)));
            [lesser(radii[0], length_squared(&dv) * part), lesser(radii[1], dh * dh * part)]
        });
        self.v.learn(root.v, by_v);
        self.h.learn(SVector::repeat(root.h), by_h);
    }
}

/// The lesser of two numbers, zero where it is none.
fn lesser<T: Scalar>(a: T, b: T) -> T {
    let lesser = if a < b { a } else { b };
    if lesser.is_finite() { lesser } else { T::zero() }
}
