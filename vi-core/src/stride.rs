//! Momentum steps of one length, one after the other.
//!
//! In: a node, the step h, and the velocities of the strides before. Out: the velocity v that solves the momentum equation, what
//! the momenta gain, and the stride that follows. Three ways, the first that does:
//!
//! ```text
//! A constant    v = −A⁻¹ r(0), the inverse computed once per run
//! foretold      v extrapolated, then Newton steps until one is shorter than the trusted ρ (`forecast`)
//! sought        Newton's iteration to the rounding floor, every residual measured; else the continuation in h
//! ```
//!
//! Every 64th stride is a lesson: it starts from the last velocity, to learn what may be trusted.
//!
//! One stride waits for the other, so what a foretold one does after it knows its Newton step δ is little. The next trial and the
//! place where L is evaluated are there before δ, but for a multiple of it; the gain of the momenta is carried to the solution
//! by its derivative (`Stepping::momentum_step`); and the one quotient of a small A is foretold too (`reciprocal`).

use crate::continuation::{self, Pace};
use crate::fixed_step::Branch;
use crate::forecast::{Forecast, Lesson, length_squared};
use crate::linear::Matrix;
use crate::momentum::{self, Solution};
use crate::reciprocal::Reciprocal;
use crate::{Node, Real, Scalar, StepError, Stepping};
use core::hint::black_box;
use nalgebra::SVector;

/// Newton steps that may follow a guess before every residual is measured.
const ATTEMPTS: u32 = 3;

/// Part of a rounding that Newton's iteration may leave. It has a sign, and adds up over the steps: with a whole one a sensitive
/// motion of the double well is off by 3.3e-13 after 1000 steps, with this by 2.0e-14.
const SHARE: f64 = 1.0 / 64.0;

/// The inverse of a constant A.
pub(crate) type Inverse<S, const N: usize, T> = <<S as Stepping<N, T>>::Jacobian as Matrix<N, T>>::Inverse;

/// The velocity where A does not change, `v = −A⁻¹ r(0)`.
#[inline]
pub(crate) fn linear_velocity<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    inverse: &Inverse<S, N, T>,
) -> SVector<T, N> {
    -S::Jacobian::apply(inverse, &system.momentum_equation(node, h, &SVector::zeros()).residual)
}

/// A momentum step that was found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<const N: usize, T> {
    /// The velocity before the last Newton step,
    pub(crate) trial: SVector<T, N>,
    /// and that step.
    pub(crate) step: SVector<T, N>,
    /// What the momenta gain.
    pub(crate) gain: SVector<T, N>,
    /// 1/determinant of A there.
    pub(crate) reciprocal: T,
    /// Newton iterations that it took.
    pub(crate) iterations: u32,
}

impl<const N: usize, T: Real> Found<N, T> {
    /// The velocity.
    #[inline]
    pub(crate) fn v(&self) -> SVector<T, N> {
        self.trial + self.step
    }
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
    reciprocal: Reciprocal<T>,
    /// |δ|² of a Newton step that is all rounding.
    rounding: T,
}

impl<const N: usize, T: Scalar> Stride<N, T> {
    /// The first stride, with a guess of its velocity.
    pub(crate) fn new(h: T, guess: SVector<T, N>) -> Self {
        Self { h, forecast: Forecast::new(guess), reciprocal: Reciprocal::new(), rounding: T::zero() }
    }

    /// The same, each number stored for itself: see the rare path of [`FixedStep::step`](crate::FixedStep::step).
    pub(crate) fn apart(self) -> Self {
        Self {
            h: self.h,
            forecast: self.forecast.apart(),
            reciprocal: self.reciprocal.apart(),
            rounding: black_box(self.rounding),
        }
    }

    /// Goes on as another stride of the same length has: a loop over steps sees that h stays.
    #[inline]
    pub(crate) fn resume(&mut self, other: Self) {
        Self { forecast: self.forecast, reciprocal: self.reciprocal, rounding: self.rounding, .. } = other;
    }

    /// Where [`Stepping::momentum_step`] evaluates L in the stride from this node, as it is foretold.
    #[inline]
    pub(crate) fn place<S: Stepping<N, T>>(&self, node: &Node<N, T>) -> SVector<T, N> {
        node.place::<S>(self.h, &self.forecast.guess())
    }

    /// The same for the stride after the step `found` from this node, where it is told at all.
    #[inline]
    pub(crate) fn place_after<S: Stepping<N, T>>(
        &self,
        node: &Node<N, T>,
        found: &Found<N, T>,
    ) -> Option<SVector<T, N>> {
        let (h, part) = (self.h, T::real(S::PLACE?));
        let change = h * (T::one() + part * self.forecast.weight());
        let mut place = node.q;
        for i in 0..N {
            let trial = found.trial[i];
            let way = trial + self.forecast.after(i, trial) * part;
            place[i] = node.q[i] + (node.q_low[i] + h * way) + found.step[i] * change;
        }
        Some(place)
    }

    /// The step from the velocity foretold and its `place`; `None` where it cannot be trusted. One loop, in line: a call that
    /// is lent the node would keep a loop over steps from holding it in registers.
    #[inline(always)]
    fn attempt<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        mut place: SVector<T, N>,
    ) -> Option<Found<N, T>> {
        let (mut trial, mut before) = (self.forecast.guess(), None);
        let quarter = T::real(0.25);
        for iterations in 1..=ATTEMPTS {
            let (mut step, mut reciprocal, mut certain) = (SVector::zeros(), T::one(), true);
            let gain = system.momentum_step(
                node,
                &place,
                self.h,
                &trial,
                #[inline(always)]
                |equation| {
                    let (numerators, determinant) = equation.jacobian.quotient(&equation.residual);
                    if S::Jacobian::QUOTIENT && iterations == 1 && self.reciprocal.is_foretold() {
                        let foretold = self.reciprocal.next();
                        step = numerators * -foretold;
                        certain = Reciprocal::is_good(foretold * determinant, length_squared(&step), self.rounding);
                    } else {
                        // A quotient, lest this and the product be one way that waits for both.
                        step = numerators.map(|numerator| -(numerator / determinant));
                    }
                    reciprocal = determinant.recip();
                    step
                },
            );
            let length = length_squared(&step);
            if let Some(before) = before {
                // A step that is not much shorter than the one before belongs to another root.
                if length > before * quarter {
                    return None;
                }
                // What these two show of the convergence counts more than what was learnt elsewhere.
                let ratio = length / before;
                certain = length * ratio * ratio <= self.rounding * T::real(SHARE * SHARE) || length <= self.rounding;
            }
            if length <= self.forecast.radius() && certain {
                return Some(Found { trial, step, gain, reciprocal, iterations });
            }
            before = Some(length);
            trial += step;
            place = node.place::<S>(self.h, &trial);
        }
        None
    }

    /// The velocity from the last one, and ρ² from how the steps became shorter; `None` where they do not.
    fn lesson<S: Stepping<N, T>>(&mut self, system: &S, node: &Node<N, T>) -> Option<(SVector<T, N>, T)> {
        let h = self.h;
        let newton_step = |v: &SVector<T, N>| {
            let equation = system.momentum_equation(node, h, v);
            (-equation.jacobian.solve(&equation.residual), equation.jacobian)
        };
        let start = self.forecast.newest();
        let (mut step, place) = (start, node.place::<S>(h, &start));
        let carried = system.momentum_step(node, &place, h, &start, |equation| {
            step = -equation.jacobian.solve(&equation.residual);
            step
        });
        let (first, mut v) = (length_squared(&step), start + step);
        // What the gain is off by that was carried to the first order only: of the second order too, but not always by A.
        let beyond = length_squared(&(carried - system.increment(node, h, &v).momentum));
        let (step, jacobian) = newton_step(&v);
        let second = length_squared(&step);
        let noise = system.magnitudes(node, h, &v).residual * T::real(T::EPSILON);
        let rounding = length_squared(&jacobian.solve(&noise));
        let by_v = Lesson { first, second, rounding }.radius(SHARE);
        let by_gain = Lesson { first, second: beyond, rounding: length_squared(&noise) }.radius(SHARE);
        let radius = if by_v < by_gain { by_v } else { by_gain };
        if !(radius > T::zero() && second <= first * T::real(0.25)) {
            return None;
        }
        v += step;
        if second > radius {
            let (step, _) = newton_step(&v);
            v += step;
            if length_squared(&step) > radius {
                return None;
            }
        }
        self.rounding = rounding;
        self.reciprocal.hope();
        v.iter().all(|entry| entry.is_finite()).then_some((v, radius))
    }

    /// The inverse of A where it is constant and solves the equation to rounding.
    pub(crate) fn inverse<S: Stepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> Option<Inverse<S, N, T>> {
        if !S::CONSTANT_JACOBIAN {
            return None;
        }
        let inverse = system.momentum_equation(node, self.h, &SVector::zeros()).jacobian.inverse();
        let v = linear_velocity(system, node, self.h, &inverse);
        (momentum::residual(system, node, self.h, &v) <= momentum::FLOOR).then_some(inverse)
    }

    /// The step by one product with the inverse of A, or from the velocity foretold and its place; `None` where it has to be
    /// sought.
    #[inline]
    pub(crate) fn foretold<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        place: SVector<T, N>,
        inverse: Option<&Inverse<S, N, T>>,
    ) -> Option<Found<N, T>> {
        if S::CONSTANT_JACOBIAN {
            let v = linear_velocity(system, node, self.h, inverse?);
            let gain = system.increment(node, self.h, &v).momentum;
            return Some(Found { trial: v, step: SVector::zeros(), gain, reciprocal: T::one(), iterations: 0 });
        }
        if !S::SMOOTH || self.forecast.is_learning() {
            return None;
        }
        self.attempt(system, node, place)
    }

    /// Takes a step that was foretold.
    #[inline]
    pub(crate) fn take<S: Stepping<N, T>>(&mut self, found: &Found<N, T>) {
        if S::CONSTANT_JACOBIAN {
            self.forecast.replace(found.trial);
        } else {
            self.forecast.push(&found.trial, &found.step);
            if S::Jacobian::QUOTIENT {
                self.reciprocal.push(found.reciprocal, found.iterations == 1);
            }
        }
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
        let lesson = S::SMOOTH && branch == Branch::Nearest && self.forecast.is_learning();
        let (v, iterations) = if let Some((v, radius)) = lesson.then(|| self.lesson(system, node)).flatten() {
            self.forecast.learn(v, radius);
            (v, 2)
        } else {
            let Solution { v, iterations } = self.searched(system, node, branch)?;
            self.forecast.miss(v);
            (v, iterations)
        };
        let mut reciprocal = T::one();
        if S::Jacobian::QUOTIENT {
            let (_, determinant) = system.momentum_equation(node, self.h, &v).jacobian.quotient(&v);
            reciprocal = determinant.recip();
            self.reciprocal.push(reciprocal, true);
        }
        let gain = system.increment(node, self.h, &v).momentum;
        Ok(Found { trial: v, step: SVector::zeros(), gain, reciprocal, iterations })
    }

    fn searched<S: Stepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        branch: Branch,
    ) -> Result<Solution<N, T>, StepError> {
        let Self { h, forecast, .. } = self;
        let start = forecast.newest();
        // Where a smooth motion was not foretold, what was foretold may be anywhere.
        let guess = if S::SMOOTH { start } else { forecast.guess() };
        match branch {
            Branch::Nearest => continuation::nearest(system, node, *h, guess, start),
            Branch::Connected => continuation::solve(system, node, *h, start, Pace::CLOSE),
        }
    }
}
