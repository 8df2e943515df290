//! Steps by Newton correction of an extrapolated guess.
//!
//! Velocities and lengths of the last steps extrapolate to a trial (v, h) (`predictor`). Newton steps lead from there
//! to the root of both equations, each followed by a check:
//!
//! ```text
//! accept     if |r_i| ≤ 4 ε (|p0_i| + |p1_i − p0_i|)  and  |c| ≤ (ε/2) (|E0| + |E1 − E0| + Σ_i |v_i p0_i|),
//!            or the same parts of the sum of the absolute values of the terms of each row, if e = c + v·r is at the first of these too
//! ```
//!
//! `None` if three Newton steps do not converge, the length leaves its range or D changes its sign. The next step
//! carries the residual of the momentum rows, as in `momentum::steps`: without that, the angular momentum of Kepler's
//! problem is off by 8e-14 after a million steps, with it by 3e-15. The energy row, from which h follows, carries
//! nothing: one rounding of it is `4 ε E/(h² D)` of h.

use super::equations::{Elimination, EnergyStep, RowResiduals, energy_residual};
use super::interval::Last;
use crate::method::bounds::RATIO;
use crate::newton::{FLOOR, are_at_floor};
use crate::node::Node;
use crate::predictor::Predictor;
use crate::real::Scalar;
use crate::stepping::{EnergyStepping, ExtendedResidual, Increment};
use crate::vector::{Vector, VelocityStep, length_squared};
use nalgebra::SVector;

/// Most Newton steps after a guess.
const ATTEMPTS: u32 = 3;
/// Accepted residual of a momentum row including its carried remainder, in roundings.
const REMAINING: f64 = 1.0;
/// Accepted residual of the energy row, in roundings.
const ENERGY_FLOOR: f64 = 0.5;
/// Largest relative size of a short change of v and h.
const SHORT: f64 = 1e-6;

/// The predictors of v and of h, and the last remainder. Each has its own degree: h follows from a small difference, so
/// that its rounding errors, which extrapolation amplifies, are larger.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::real::Real + serde::Serialize",
        deserialize = "T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Prediction<const N: usize, T> {
    v: Predictor<N, T>,
    h: Predictor<1, T>,
    /// Remainder of the momentum rows of the last step.
    remainder: SVector<T, N>,
}

/// A solved step.
#[derive(Clone, Copy, Debug)]
pub struct Predicted<const N: usize, T> {
    /// The solution of the equations.
    pub(crate) step: EnergyStep<N, T>,
    /// Increments of momentum and energy.
    pub(crate) increment: Increment<N, T>,
    /// Remainder of its momentum rows.
    remainder: SVector<T, N>,
}

impl<const N: usize, T: Scalar> Prediction<N, T> {
    /// The predictors before the first step, which follows the interval `(v, h)`.
    pub(crate) fn new(v: SVector<T, N>, h: T) -> Self {
        Self { v: Predictor::new(v), h: Predictor::new(SVector::repeat(h)), remainder: SVector::zeros() }
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.v.is_finite() && self.h.is_finite() && Vector::is_finite(&self.remainder)
    }

    /// Whether both guesses have the highest degree.
    #[inline(always)]
    pub(crate) fn is_highest(&self) -> bool {
        self.v.is_highest() && self.h.is_highest()
    }

    /// Records a step from a guess of the highest degree.
    #[inline(always)]
    pub(crate) fn push_common(&mut self, predicted: &Predicted<N, T>) {
        let EnergyStep { v, h, .. } = predicted.step;
        self.v.push_highest(v);
        self.h.push_highest(SVector::repeat(h));
        self.remainder = predicted.remainder;
    }

    /// Records a step from a guess.
    pub(crate) fn push(&mut self, predicted: &Predicted<N, T>) {
        let EnergyStep { v, h, .. } = predicted.step;
        self.v.push(v);
        self.h.push(SVector::repeat(h));
        self.remainder = predicted.remainder;
    }

    /// Records a step from a search.
    pub(crate) fn restart(&mut self, step: &EnergyStep<N, T>) {
        self.v.restart(step.v);
        self.h.restart(SVector::repeat(step.h));
        self.remainder = SVector::zeros();
    }

    /// The extrapolated unknowns.
    pub(crate) fn guess(&self) -> VelocityStep<N, T> {
        VelocityStep { v: self.v.guess(), h: self.h.guess()[0] }
    }

    /// The extrapolated unknowns at the highest degree.
    #[inline(always)]
    pub(crate) fn guess_highest(&self) -> VelocityStep<N, T> {
        VelocityStep { v: self.v.guess_highest(), h: self.h.guess_highest()[0] }
    }

    /// The step from `node` after the interval `last`, from a trial.
    #[inline(always)]
    pub(crate) fn step<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        last: &Last<N, T>,
        mut trial: VelocityStep<N, T>,
    ) -> Option<Predicted<N, T>> {
        for iterations in 1..=ATTEMPTS {
            let mut equations = system.extended_system(node, trial.h, &trial.v);
            equations.momentum.residual += self.remainder;
            let elimination = Elimination::of(&equations);
            let change = elimination.change(&equations, &trial);
            trial = VelocityStep { v: trial.v + change.v, h: trial.h + change.h };
            // D belongs to the previous trial, which must be close to the root.
            if !is_short(&change, &trial) {
                continue;
            }
            let at = system.extended_residual(node, trial.h, &trial.v);
            let Some((remainder, measured)) = self.measured(node, &trial, &at) else {
                continue;
            };
            let VelocityStep { v, h } = trial;
            let density = elimination.density_or_infinite();
            let in_range = h * T::real(RATIO) >= last.h && h <= last.h * T::real(RATIO);
            // At the smallest root D has the same sign as before.
            let forward = density * last.density > T::zero() && !elimination.is_degenerate();
            let step = EnergyStep { v, h, density, iterations, measured };
            return (in_range && forward).then_some(Predicted { step, increment: at.increment, remainder });
        }
        None
    }

    /// The remainders of the momentum rows including carried ones, and all residuals with their scales, if every row is
    /// at the floor.
    #[inline(always)]
    fn measured(
        &self,
        node: &Node<N, T>,
        trial: &VelocityStep<N, T>,
        at: &ExtendedResidual<N, T>,
    ) -> Option<(SVector<T, N>, RowResiduals<N, T>)> {
        let remainder = at.residual + self.remainder;
        let is_at_floor = |rows: &SVector<T, N>, energy: T| {
            let rounding = energy * T::real(T::EPSILON);
            // A scale that overflows proves nothing.
            let energy = at.energy_residual.abs() <= rounding * T::real(ENERGY_FLOOR) && rounding.is_finite();
            energy & are_at_floor(&at.residual, &self.remainder, rows, REMAINING)
        };
        let own = node.energy.abs() + at.increment.energy.abs();
        let mut rows = node.p.zip_map(&at.increment.momentum, |p, increment| p.abs() + increment.abs());
        let mut energy = node.p.iter().zip(trial.v.iter()).fold(own, |sum, (p, v)| sum + (*p * *v).abs());
        // Rows at this floor preserve the energy itself: e = c + v·r.
        if !is_at_floor(&rows, energy) {
            let terms = rows.iter().zip(trial.v.iter()).fold(own, |sum, (row, v)| sum + (*row * *v).abs());
            let left = energy_residual(at, &trial.v).abs();
            // Momenta or energy may vanish although their terms do not.
            (rows, energy) = (at.scale, at.energy_scale);
            let is_kept = left <= terms * T::real(FLOOR * T::EPSILON);
            if !(is_at_floor(&rows, energy) && is_kept) {
                return None;
            }
        }
        let measured =
            RowResiduals { rows: at.residual, scales: rows, energy: at.energy_residual, energy_scale: energy };
        Some((remainder, measured))
    }
}

/// Whether a change is less than a millionth of the resulting trial.
#[inline(always)]
fn is_short<const N: usize, T: Scalar>(change: &VelocityStep<N, T>, trial: &VelocityStep<N, T>) -> bool {
    let part = T::real(SHORT);
    let (length, whole) = (length_squared(&change.v), length_squared(&trial.v));
    change.h.abs() <= trial.h.abs() * part && length <= whole * (part * part)
}
