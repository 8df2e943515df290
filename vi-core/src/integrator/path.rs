//! The motion between the two nodes of a step.
//!
//! In: a step that was taken. Out: q and p at any time of it, as polynomials; velocities are their derivatives. A step of one stage has the cubics
//! of Hermite through its ends,
//!
//! ```text
//! q(t0 + θh) = q0 + θ (Δq + (1 − θ) ((1 − θ) (h v0 − Δq) − θ (h v1 − Δq)))        Δq = q1 − q0
//! ```
//!
//! and the same of p with `dp/dt = L_q + f`: to order 3, which is more than the step has. A Gauss step has its collocation polynomials, of order S + 1
//! (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, II.1.2). AT BOTH ENDS the path is at the nodes, to rounding.

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::state::State;
use nalgebra::SVector;

/// A motion in time.
pub trait Path<const N: usize> {
    /// Time, coordinates and momenta at the time `t`; beyond the step what the polynomials say.
    fn state(&self, t: f64) -> State<N>;
    /// The derivative of the coordinates by time at the time `t`.
    fn velocity(&self, t: f64) -> SVector<f64, N>;
    /// The same motion by the time since the start of the step: far from zero the time itself is too coarse.
    #[doc(hidden)]
    #[must_use]
    fn since_start(self) -> Self
    where
        Self: Sized;
}

/// Cubics through the ends of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hermite<const N: usize> {
    t: f64,
    h: f64,
    q: Cubic<N>,
    p: Cubic<N>,
}

/// A cubic over the step, by its values and slopes at both ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cubic<const N: usize> {
    start: SVector<f64, N>,
    change: SVector<f64, N>,
    /// What the slope at either end has beyond the change, times h.
    first: SVector<f64, N>,
    last: SVector<f64, N>,
}

impl<const N: usize> Hermite<N> {
    /// The path from one state of a motion of `system` to another. The step between them has the length `h` if the times can be told to differ by it, else
    /// that by which they differ.
    ///
    /// # Errors
    /// Those of [`State::velocity`] at both.
    pub(crate) fn between<S: Lagrangian<N>>(
        system: &S,
        before: &State<N>,
        after: &State<N>,
        h: f64,
    ) -> Result<Self, StepError> {
        let told = after.t - before.t;
        let rounding = f64::EPSILON * before.t.abs().max(after.t.abs());
        let h = if (told - h).abs() <= rounding { h } else { told };
        let start = before.flow(system)?;
        let end = after.flow(system)?;
        let q = Cubic::new([before.q, after.q], [start.v, end.v], h);
        let p = Cubic::new([before.p, after.p], [start.force, end.force], h);
        Ok(Self { t: before.t, h, q, p })
    }
}

impl<const N: usize> Path<N> for Hermite<N> {
    fn since_start(self) -> Self {
        Self { t: 0.0, ..self }
    }

    fn state(&self, t: f64) -> State<N> {
        let part = (t - self.t) / self.h;
        State { t, q: self.q.at(part), p: self.p.at(part) }
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        self.q.slope((t - self.t) / self.h) / self.h
    }
}

impl<const N: usize> Cubic<N> {
    fn new(values: [SVector<f64, N>; 2], slopes: [SVector<f64, N>; 2], h: f64) -> Self {
        let [start, end] = values;
        let change = end - start;
        let [first, last] = slopes.map(|slope| slope * h - change);
        Self { start, change, first, last }
    }

    /// The value at a part of the step.
    fn at(&self, part: f64) -> SVector<f64, N> {
        let rest = 1.0 - part;
        let bend = self.first * rest - self.last * part;
        self.start + (self.change + bend * rest) * part
    }

    /// The derivative by the part.
    fn slope(&self, part: f64) -> SVector<f64, N> {
        let rest = 1.0 - part;
        self.change + self.first * (rest * (rest - 2.0 * part)) - self.last * (part * (2.0 * rest - part))
    }
}
