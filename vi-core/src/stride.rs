//! Momentum steps of one length, one after the other.
//!
//! In: a node, the step h, and the velocities of the strides before. Out: the velocity v that solves the momentum equation,
//! and the stride that follows. Three ways, the first that does:
//!
//! ```text
//! A constant    v = −A⁻¹ r(0), the inverse computed once per run
//! foretold      v extrapolated, then Newton steps until one is shorter than the trusted ρ (`forecast`)
//! sought        Newton's iteration to the rounding floor, every residual measured; else the continuation in h
//! ```
//!
//! Every 64th stride is a lesson: it starts from the last velocity, to learn what may be trusted.

use crate::continuation::{self, Pace};
use crate::fixed_step::Branch;
use crate::forecast::{Forecast, Lesson, length_squared};
use crate::linear::Matrix;
use crate::momentum::{self, Solution};
use crate::{Node, Real, Scalar, StepError, Stepping};
use nalgebra::SVector;

/// Newton steps that may follow a guess before every residual is measured.
const ATTEMPTS: u32 = 3;

/// Part of a rounding that Newton's iteration may leave.
const SHARE: f64 = 1.0;

/// The inverse of a constant A.
pub(crate) type Inverse<S, const N: usize, T> = <<S as Stepping<N, T>>::Jacobian as Matrix<N, T>>::Inverse;

/// A momentum step of a given length that is taken again and again.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct Stride<const N: usize, T> {
    pub(crate) h: T,
    pub(crate) forecast: Forecast<N, T>,
}

impl<const N: usize, T: Real> Stride<N, T> {
    /// The first stride, with a guess of its velocity.
    pub(crate) fn new(h: T, guess: SVector<T, N>) -> Self {
        Self { h, forecast: Forecast::new(guess) }
    }

    /// The velocity from the one foretold, and how many Newton steps it took; the indicator is 1 in each lane where it can
    /// be trusted.
    #[inline]
    fn attempt<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> (SVector<T, N>, T, u32) {
        let guess = self.forecast.guess();
        let equation = system.momentum_equation(node, self.h, &guess);
        let step = equation.jacobian.solve(&equation.residual);
        let (length, v) = (length_squared(&step), guess - step);
        let done = length.at_most(self.forecast.radius());
        if done.holds() {
            return (v, done, 1);
        }
        // By copies, so that a loop over steps may keep its own in registers.
        further(*system, *node, (self.h, self.forecast.radius()), v, length, done)
    }

    /// The velocity from the last one, and ρ² from how the steps became shorter.
    fn lesson<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> (SVector<T, N>, T, T) {
        let Self { h, forecast } = self;
        let mut v = forecast.newest();
        let newton_step = |v: &SVector<T, N>| {
            let equation = system.momentum_equation(node, *h, v);
            (equation.jacobian.solve(&equation.residual), equation.jacobian)
        };
        let (step, _) = newton_step(&v);
        let first = length_squared(&step);
        v -= step;
        let (step, jacobian) = newton_step(&v);
        let second = length_squared(&step);
        let noise = system.magnitudes(node, *h, &v).residual * T::real(T::EPSILON);
        let rounding = length_squared(&jacobian.solve(&noise));
        let radius = Lesson { first, second, rounding }.radius(SHARE) * second.at_most(first * T::real(0.25));
        let trusted = |length: T| length.at_most(radius) * radius.is_above(T::zero());
        v -= step;
        let mut done = trusted(second);
        if !done.holds() {
            let (step, _) = newton_step(&v);
            v -= step * (T::one() - done);
            done = done.max(trusted(length_squared(&step)));
        }
        (v, done, radius)
    }
}

/// The Newton steps that follow where the first was too long.
#[inline(never)]
fn further<const N: usize, T: Real, S: Stepping<N, T>>(
    system: S,
    node: Node<N, T>,
    (h, radius): (T, T),
    mut v: SVector<T, N>,
    mut before: T,
    mut done: T,
) -> (SVector<T, N>, T, u32) {
    for attempt in 2..=ATTEMPTS {
        let equation = system.momentum_equation(&node, h, &v);
        let step = equation.jacobian.solve(&equation.residual);
        let length = length_squared(&step);
        // A lane that is done stays as it is: what a trajectory becomes does not depend on its neighbours.
        v -= step * (T::one() - done);
        // A step that is not much shorter than the one before belongs to another root.
        done = done.max(length.at_most(radius) * length.at_most(before * T::real(0.25)));
        if done.holds() {
            return (v, done, attempt);
        }
        before = length;
    }
    (v, done, ATTEMPTS)
}

impl<const N: usize, T: Scalar> Stride<N, T> {
    /// The inverse of A where it is constant and solves the equation to rounding.
    pub(crate) fn inverse<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> Option<Inverse<S, N, T>> {
        if !S::CONSTANT_JACOBIAN {
            return None;
        }
        let equation = system.momentum_equation(node, self.h, &SVector::zeros());
        let inverse = equation.jacobian.inverse();
        let v = -S::Jacobian::apply(&inverse, &equation.residual);
        (momentum::residual(system, node, self.h, &v) <= momentum::FLOOR).then_some(inverse)
    }

    /// The velocity by one product with the inverse of A, or from the one foretold, and the Newton iterations it took;
    /// `None` where it has to be sought.
    #[inline]
    pub(crate) fn foretold<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        inverse: Option<&Inverse<S, N, T>>,
    ) -> Option<(SVector<T, N>, u32)> {
        if S::CONSTANT_JACOBIAN {
            let rest = system.momentum_equation(node, self.h, &SVector::zeros());
            return Some((-S::Jacobian::apply(inverse?, &rest.residual), 0));
        }
        if !S::SMOOTH || self.forecast.is_learning() {
            return None;
        }
        let (v, done, iterations) = self.attempt(system, node);
        done.holds().then_some((v, iterations))
    }

    /// Takes a velocity that was foretold.
    #[inline]
    pub(crate) fn take<S: Stepping<N, T>>(&mut self, v: SVector<T, N>) {
        if S::CONSTANT_JACOBIAN { self.forecast.replace(v) } else { self.forecast.push(v) }
    }

    /// The velocity without the forecast, or by a lesson for it; and the Newton iterations it took. The forecast takes it.
    ///
    /// # Errors
    /// Those of Newton's iteration and of the continuation.
    pub(crate) fn seek<S: Stepping<N, T>>(
        &mut self,
        system: &S,
        node: &Node<N, T>,
        branch: Branch,
    ) -> Result<(SVector<T, N>, u32), StepError> {
        if S::SMOOTH && branch == Branch::Nearest && self.forecast.is_learning() {
            let (v, done, radius) = self.lesson(system, node);
            if done.holds() && v.iter().all(|entry| entry.is_finite()) {
                self.forecast.learn(v, radius);
                return Ok((v, 2));
            }
        }
        let Self { h, forecast } = self;
        let start = forecast.newest();
        // Where a smooth motion was not foretold, what was foretold may be anywhere.
        let guess = if S::SMOOTH { start } else { forecast.guess() };
        let Solution { v, iterations } = match branch {
            Branch::Nearest => continuation::nearest(system, node, *h, guess, start)?,
            Branch::Connected => continuation::solve(system, node, *h, start, Pace::CLOSE)?,
        };
        forecast.miss(v);
        Ok((v, iterations))
    }
}
