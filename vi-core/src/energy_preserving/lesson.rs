//! How far one Newton step may be trusted, learnt at a root.
//!
//! In: a root (v, h) and a displacement δv. Out: how long δv, δh and their product may be, squared, in a Newton step that is the last:
//! it leaves a share of one rounding at most, in v, in h and in what is gained over the step that it gives.
//!
//! To leading order what a step leaves is a quadratic form in what its trial was off by,
//!
//! ```text
//! e(δv, δh) = e(δv, 0) + e(0, δh) + e_both        e_both = e(δv, δh) − e(δv, 0) − e(0, δh)
//! ```
//!
//! so that three steps show all of it, and each part is given a third of what is allowed.

use super::newton::{Elimination, Root, Trial};
use crate::forecast::length_squared;
use crate::{Increment, Node, Scalar, Stepping, momentum};
use nalgebra::SVector;

/// Part of a rounding that the iteration may leave in v and in h. It has a sign, and a million of them add up: with a quarter
/// the angular momentum of Kepler's problem drifts by 1.3e-12 in a million steps, with this by less than 1e-13.
const SHARE: f64 = 1.0 / 256.0;
/// The same of what is left out of a gain.
const SHARE_OF_GAIN: f64 = 1.0 / 16.0;
/// Displacement of h, as a part of it: far above rounding, and small beside what bends the equations.
const DISPLACEMENT: f64 = 1.0 / 256.0;

/// Squares of how far a trial may be off; zero where nothing is trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Radii<T> {
    /// In v,
    pub(super) v: T,
    /// in h,
    pub(super) h: T,
    /// and of the product of both.
    pub(super) product: T,
}

impl<T: Scalar> Radii<T> {
    /// No trust.
    pub(super) fn zero() -> Self {
        Self { v: T::zero(), h: T::zero(), product: T::zero() }
    }

    /// What the step `root` from `node` shows.
    pub(super) fn learnt<const N: usize, S: Stepping<N, T>>(
        system: &S,
        node: &Node<N, T>,
        root: &Root<N, T>,
        dv: SVector<T, N>,
    ) -> Self {
        let dh = root.h * T::real(DISPLACEMENT);
        let left = |dv, dh| Remainder::of(system, node, root, &dv, dh);
        let (by_v, by_h) = (left(dv, T::zero()), left(SVector::zeros(), dh));
        let by_both = left(dv, dh).less(&by_v).less(&by_h);
        let Some(rounding) = Remainder::rounding(system, node, root) else { return Self::zero() };
        // A third of what is allowed, as a part of what was left.
        let third = |part: &Remainder<N, T>| T::real(1.0 / (3.0 * part.over(&rounding)));
        let (v, h, product) = (third(&by_v), third(&by_h), third(&by_both));
        let (dv, dh) = (length_squared(&dv), dh * dh);
        let radii = Self { v: v * dv, h: h * dh, product: product * product * dv * dh };
        if radii.is_finite() { radii } else { Self::zero() }
    }

    /// Whether these are numbers.
    pub(super) fn is_finite(&self) -> bool {
        [self.v, self.h, self.product].iter().all(|number| number.is_finite())
    }

    /// Whether a Newton step with these squares of lengths is the last one.
    #[inline]
    pub(super) fn admit(&self, (v, h): (T, T)) -> bool {
        v <= self.v && h <= self.h && v * h <= self.product
    }
}

/// What a Newton step leaves in the unknowns, and in what is gained over the step that it gives.
#[derive(Clone, Copy, Debug)]
struct Remainder<const N: usize, T> {
    v: SVector<T, N>,
    h: T,
    gain: Increment<N, T>,
}

impl<const N: usize, T: Scalar> Remainder<N, T> {
    /// Of the step from the trial that is off by `(dv, dh)`.
    fn of<S: Stepping<N, T>>(system: &S, node: &Node<N, T>, root: &Root<N, T>, dv: &SVector<T, N>, dh: T) -> Self {
        let trial = Trial { v: root.v + dv, h: root.h + dh };
        let mut reached = trial;
        let place = node.place::<S>(trial.h, &trial.v);
        let carried = system.extended_step(node, &place, trial.h, &trial.v, |equations| {
            let step = Elimination::of(equations).step(equations, &trial);
            reached = Trial { v: trial.v + step.v, h: trial.h + step.h };
            (step.v, step.h)
        });
        let gain = system.increment(node, reached.h, &reached.v);
        let (momentum, energy) = (carried.momentum - gain.momentum, carried.energy - gain.energy);
        Self { v: reached.v - root.v, h: reached.h - root.h, gain: Increment { momentum, energy } }
    }

    /// What rounding leaves.
    fn rounding<S: Stepping<N, T>>(system: &S, node: &Node<N, T>, root: &Root<N, T>) -> Option<Self> {
        let Root { v, h, .. } = *root;
        let (equations, magnitudes) = (system.extended_system(node, h, &v), system.magnitudes(node, h, &v));
        let (momentum, energy) =
            (magnitudes.residual * T::real(T::EPSILON), magnitudes.energy_residual * T::real(T::EPSILON));
        let mut noisy = equations;
        noisy.momentum.residual = momentum;
        let elimination = Elimination::finite(&noisy)?;
        // The terms of δh may cancel: rounding does not know their signs.
        let terms = equations.energy_dv.iter().zip(elimination.residual.iter()).map(|(dv, a)| (*dv * *a).abs());
        let rounding_h = (terms.fold(energy / h, |sum, term| sum + term) / elimination.schur).abs();
        let rounding_v = elimination.residual.map(T::abs) + elimination.residual_dh.map(T::abs) * rounding_h;
        Some(Self { v: rounding_v, h: rounding_h, gain: Increment { momentum, energy } })
    }

    fn less(&self, other: &Self) -> Self {
        let gain = Increment {
            momentum: self.gain.momentum - other.gain.momentum,
            energy: self.gain.energy - other.gain.energy,
        };
        Self { v: self.v - other.v, h: self.h - other.h, gain }
    }

    /// How many times what is allowed, with what rounding leaves at least.
    fn over(&self, rounding: &Self) -> f64 {
        let over = |left: T, rounding: T, share: f64| momentum::worse((left.abs() / rounding).to_f64(), 1.0) / share;
        let length = |vector: &SVector<T, N>| length_squared(vector).sqrt();
        let unknowns =
            momentum::worse(over(length(&self.v), length(&rounding.v), SHARE), over(self.h, rounding.h, SHARE));
        let gains = momentum::worse(
            over(length(&self.gain.momentum), length(&rounding.gain.momentum), SHARE_OF_GAIN),
            over(self.gain.energy, rounding.gain.energy, SHARE_OF_GAIN),
        );
        momentum::worse(unknowns, gains)
    }
}
