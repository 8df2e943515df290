//! Dense output: q and p between the two nodes of a step, as polynomials. Velocities are their derivatives.
//!
//! A step of one stage uses the Hermite cubics through its ends,
//!
//! ```text
//! q(t0 + θh) = q0 + θ (Δq + (1 − θ) ((1 − θ) (h v0 − Δq) − θ (h v1 − Δq)))        Δq = q1 − q0
//! ```
//!
//! and the same for p with `dp/dt = L_q + f`. Their order 3 exceeds that of the step. A Gauss step uses its collocation
//! polynomials, of order S + 1 (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, II.1.2). At both ends the
//! polynomials agree with the nodes to rounding.

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::real::{Real, Scalar};
use crate::state::State;
use nalgebra::SVector;

/// Dense output of a step.
pub trait DenseOutput<const N: usize, T = f64> {
    /// The state at the time `t`. The polynomials extrapolate beyond the step.
    fn state(&self, t: T) -> State<N, T>;
    /// The time derivative of the coordinates at the time `t`.
    fn velocity(&self, t: T) -> SVector<T, N>;
    /// The same dense output as a function of the time since the start of the step. Far from zero, t itself has too few
    /// digits.
    #[doc(hidden)]
    #[must_use]
    fn since_start(self) -> Self
    where
        Self: Sized;
    /// The same dense output with `by` added to the coordinates.
    #[doc(hidden)]
    #[must_use]
    fn moved(self, by: &SVector<T, N>) -> Self
    where
        Self: Sized;
}

/// Hermite cubics through the ends of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hermite<const N: usize, T = f64> {
    t: T,
    h: T,
    q: Cubic<N, T>,
    p: Cubic<N, T>,
}

/// A cubic over the step, from its values and slopes at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cubic<const N: usize, T> {
    start: SVector<T, N>,
    change: SVector<T, N>,
    /// Slope at either end times h, minus the change over the step.
    first: SVector<T, N>,
    last: SVector<T, N>,
}

impl<const N: usize, T: Scalar> Hermite<N, T> {
    /// The cubics of `system` from one state to another. The step length is `h` if it agrees with the difference of the
    /// times to rounding, otherwise that difference.
    ///
    /// # Errors
    /// As [`State::velocity`] at both ends.
    pub(crate) fn between<S: Lagrangian<N, T>>(
        system: &S,
        before: &State<N, T>,
        after: &State<N, T>,
        h: T,
    ) -> Result<Self, StepError> {
        let difference = after.t - before.t;
        let [from, to] = [before.t.to_f64(), after.t.to_f64()];
        let rounding = T::EPSILON * from.abs().max(to.abs());
        let h = if (difference - h).to_f64().abs() <= rounding { h } else { difference };
        let start = before.flow(system)?;
        let end = after.flow(system)?;
        let q = Cubic::new([before.q, after.q], [start.v, end.v], h);
        let p = Cubic::new([before.p, after.p], [start.force, end.force], h);
        Ok(Self { t: before.t, h, q, p })
    }
}

impl<const N: usize, T: Scalar> DenseOutput<N, T> for Hermite<N, T> {
    fn since_start(self) -> Self {
        Self { t: T::zero(), ..self }
    }

    fn moved(self, by: &SVector<T, N>) -> Self {
        Self { q: Cubic { start: self.q.start + by, ..self.q }, ..self }
    }

    fn state(&self, t: T) -> State<N, T> {
        let part = (t - self.t) / self.h;
        State { t, q: self.q.at(part), p: self.p.at(part) }
    }

    fn velocity(&self, t: T) -> SVector<T, N> {
        let slope = self.q.slope((t - self.t) / self.h);
        slope.map(|entry| entry / self.h)
    }
}

impl<const N: usize, T: Real> Cubic<N, T> {
    fn new(values: [SVector<T, N>; 2], slopes: [SVector<T, N>; 2], h: T) -> Self {
        let [start, end] = values;
        let change = end - start;
        let [first, last] = slopes.map(|slope| slope * h - change);
        Self { start, change, first, last }
    }

    /// The value at a fraction of the step.
    fn at(&self, part: T) -> SVector<T, N> {
        let rest = T::one() - part;
        let bend = self.first * rest - self.last * part;
        self.start + (self.change + bend * rest) * part
    }

    /// The derivative with respect to that fraction.
    fn slope(&self, part: T) -> SVector<T, N> {
        let two = T::real(2.0);
        let rest = T::one() - part;
        self.change + self.first * (rest * (rest - two * part)) - self.last * (part * (two * rest - part))
    }
}
