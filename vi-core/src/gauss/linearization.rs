//! The point at which Newton iteration linearizes the equations of a step, and their stiffness.

use super::points::{AnyDerivatives, ErasedSystem};
use crate::linear;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// The linearization point of a step of length h.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinearizationPoint<const N: usize> {
    pub(crate) h: f64,
    pub(crate) t: f64,
    pub(crate) q: SVector<f64, N>,
    pub(crate) v: SVector<f64, N>,
    /// Iterations of the first step with this linearization; `None` before.
    pub(crate) iterations: Option<u32>,
    /// Whether a separable system is so stiff that only velocities reach rounding.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) by_velocity: bool,
}

impl<const N: usize> LinearizationPoint<N> {
    /// The linearization for the next step, after one of this many iterations; `None` if a new one pays off.
    pub(crate) fn after(self, iterations: u32) -> Option<Self> {
        let first = self.iterations.unwrap_or(iterations);
        (2 * iterations <= 3 * first).then_some(Self { iterations: Some(first), ..self })
    }

    /// Whether the equations are linearized at the same point, for the same length.
    pub(super) fn is_at(&self, other: &Self) -> bool {
        self.h.to_bits() == other.h.to_bits()
            && self.t.to_bits() == other.t.to_bits()
            && self.q == other.q
            && self.v == other.v
    }

    /// Whether all numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        [self.h, self.t].iter().chain(&self.q).chain(&self.v).all(|number| number.is_finite())
    }

    /// An estimate of the largest h ω: the growth of a vector by `h E⁻¹ G`, with `E = [I 0; C M]` and `G = [0 I; K B]`. If L
    /// is linear in the velocities, by `h (C − B)⁻¹ K`.
    pub(crate) fn stiffness(&self, system: &ErasedSystem<'_, N>) -> f64 {
        let derivatives = system.derivatives(self.t, &self.q, &self.v);
        let AnyDerivatives { momentum_dq: c, mass: m, force_dq: k, force_dv: b } = &derivatives;
        let ones = SVector::<f64, N>::repeat(1.0);
        let is_first_order = !system.without_velocity().is_empty();
        let (mut x, mut y) = if is_first_order { (ones, SVector::zeros()) } else { (ones, ones) };
        let mut length = 0.0;
        for _ in 0..POWERS {
            let norm = (x.norm_squared() + y.norm_squared()).sqrt();
            (x, y) = (x / norm, y / norm);
            if is_first_order {
                // Coordinates at rest have the mass 1.
                let Some(rates) = linear::solve(&(c - b + m), &(k * x)) else { return f64::INFINITY };
                (x, y) = (rates, SVector::zeros());
                length += x.norm().ln();
                continue;
            }
            let Some(rates) = linear::solve(m, &(k * x + (b - c) * y)) else { return f64::INFINITY };
            (x, y) = (y, rates);
            length += (x.norm_squared() + y.norm_squared()).sqrt().ln();
        }
        let stiffness = self.h.abs() * (length / f64::from(POWERS)).exp();
        if stiffness.is_nan() { f64::INFINITY } else { stiffness }
    }
}

/// Power iterations of the stiffness estimate.
const POWERS: u32 = 16;
