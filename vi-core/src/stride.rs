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

/// A momentum step that was found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    /// What the momenta gain.
    pub(crate) gain: SVector<T, N>,
    /// Newton iterations that it took.
    pub(crate) iterations: u32,
}

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
}

impl<const N: usize, T: Scalar> Stride<N, T> {
    /// The step from the velocity foretold; `None` where it cannot be trusted. One loop, in line: a call that is lent
    /// the node would keep a loop over steps from holding it in registers.
    #[inline(always)]
    fn attempt<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> Option<Found<N, T>> {
        let (mut v, mut before) = (self.forecast.guess(), None);
        for iterations in 1..=ATTEMPTS {
            let mut step = SVector::zeros();
            let gain = system.momentum_step(node, self.h, &v, |equation| {
                step = -equation.jacobian.solve(&equation.residual);
                step
            });
            v += step;
            let length = length_squared(&step);
            // A step that is not much shorter than the one before belongs to another root.
            if before.is_some_and(|before| length > before * T::real(0.25)) {
                return None;
            }
            if length <= self.forecast.radius() {
                return Some(Found { v, gain, iterations });
            }
            before = Some(length);
        }
        None
    }

    /// The velocity from the last one, and ρ² from how the steps became shorter; `None` where they do not.
    fn lesson<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> Option<(SVector<T, N>, T)> {
        let Self { h, forecast } = self;
        let newton_step = |v: &SVector<T, N>| {
            let equation = system.momentum_equation(node, *h, v);
            (equation.jacobian.solve(&equation.residual), equation.jacobian)
        };
        let mut v = forecast.newest();
        let (step, _) = newton_step(&v);
        let first = length_squared(&step);
        v -= step;
        let (step, jacobian) = newton_step(&v);
        let second = length_squared(&step);
        let noise = system.magnitudes(node, *h, &v).residual * T::real(T::EPSILON);
        let rounding = length_squared(&jacobian.solve(&noise));
        let radius = Lesson { first, second, rounding }.radius(SHARE);
        if !(radius > T::zero() && second <= first * T::real(0.25)) {
            return None;
        }
        v -= step;
        if second > radius {
            let (step, _) = newton_step(&v);
            v -= step;
            if !(length_squared(&step) <= radius) {
                return None;
            }
        }
        v.iter().all(|entry| entry.is_finite()).then_some((v, radius))
    }

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

    /// The step by one product with the inverse of A, or from the velocity foretold; `None` where it has to be sought.
    #[inline]
    pub(crate) fn foretold<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        inverse: Option<&Inverse<S, N, T>>,
    ) -> Option<Found<N, T>> {
        if S::CONSTANT_JACOBIAN {
            let rest = system.momentum_equation(node, self.h, &SVector::zeros());
            let v = -S::Jacobian::apply(inverse?, &rest.residual);
            return Some(Found { v, gain: system.increment(node, self.h, &v).momentum, iterations: 0 });
        }
        if !S::SMOOTH || self.forecast.is_learning() {
            return None;
        }
        self.attempt(system, node)
    }

    /// Takes a velocity that was foretold.
    #[inline]
    pub(crate) fn take<S: Stepping<N, T>>(&mut self, v: SVector<T, N>) {
        if S::CONSTANT_JACOBIAN { self.forecast.replace(v) } else { self.forecast.push(v) }
    }

    /// The step without the forecast, or by a lesson for it. The forecast takes it.
    ///
    /// # Errors
    /// Those of Newton's iteration and of the continuation.
    pub(crate) fn seek<S: Stepping<N, T>>(
        &mut self,
        system: &S,
        node: &Node<N, T>,
        branch: Branch,
    ) -> Result<Found<N, T>, StepError> {
        let h = self.h;
        let found = |v, iterations| {
            let gain = system.increment(node, h, &v).momentum;
            Found { v, gain, iterations }
        };
        if S::SMOOTH && branch == Branch::Nearest && self.forecast.is_learning() {
            if let Some((v, radius)) = self.lesson(system, node) {
                self.forecast.learn(v, radius);
                return Ok(found(v, 2));
            }
        }
        let Self { forecast, .. } = self;
        let start = forecast.newest();
        // Where a smooth motion was not foretold, what was foretold may be anywhere.
        let guess = if S::SMOOTH { start } else { forecast.guess() };
        let Solution { v, iterations } = match branch {
            Branch::Nearest => continuation::nearest(system, node, h, guess, start)?,
            Branch::Connected => continuation::solve(system, node, h, start, Pace::CLOSE)?,
        };
        forecast.miss(v);
        Ok(found(v, iterations))
    }
}
