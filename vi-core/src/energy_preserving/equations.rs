//! The n + 1 equations for Newton iteration.
//!
//! In: a trial `(v, h)` and the range of h. Out: the root with momentum and energy equation at the rounding floor. With
//! `a = A⁻¹ r`, `b = A⁻¹ ∂r/∂h`, elimination in the combined and scaled rows of [`ExtendedSystem`] gives one equation
//! for δh,
//!
//! ```text
//! S δh = −((c + ½ a·r)/h − energy_dv·a)        S = energy_dh − energy_dv·b = −D/4
//! δv = −a − b δh
//! ```
//!
//! so that S also gives the step density. The term `½ a·r` goes beyond Newton: it is `½ δv·A δv`, the curvature of the
//! energy along v (to leading order in h, and exact for constant mass). It removes the leading error of δh.

use crate::error::Residuals;
use crate::linear::{self, Matrix};
use crate::newton::{self, Equations, FLOOR, roundings, worst};
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::{EnergyStepping, ExtendedResidual, ExtendedSystem, Rounding};
use crate::vector::{VelocityStep, worse};
use core::cmp::Ordering;
use nalgebra::{SMatrix, SVector};

/// Relative size, in roundings of its terms, below which S counts as zero.
const VANISHING: f64 = 64.0;

/// A step that solves the equations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnergyStep<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) h: T,
    pub(crate) density: T,
    pub(crate) iterations: u32,
    pub(crate) measured: RowResiduals<N, T>,
}

/// The residuals of a step and the scales of its rows, compared on request only (measured: a tenth of a step of the
/// double well).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::real::Real + serde::Serialize",
        deserialize = "T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct RowResiduals<const N: usize, T> {
    pub(crate) rows: SVector<T, N>,
    pub(crate) scales: SVector<T, N>,
    pub(crate) energy: T,
    pub(crate) energy_scale: T,
}

impl<const N: usize, T: Scalar> RowResiduals<N, T> {
    /// A residual given in roundings.
    pub(crate) fn of(roundings: f64) -> Self {
        let rows = SVector::zeros();
        Self {
            rows,
            scales: SVector::repeat(T::one()),
            energy: T::real(roundings * T::EPSILON),
            energy_scale: T::one(),
        }
    }

    /// The largest residual in roundings.
    pub(crate) fn roundings(&self) -> f64 {
        worse(worst(&self.rows, &self.scales), roundings(self.energy, self.energy_scale))
    }
}

/// The reason why there is no step here.
#[derive(Clone, Copy, Debug)]
pub(crate) enum NoStep<T> {
    /// The equations also hold for other lengths.
    Degenerate { h: T, density: T },
    /// The iteration left the range, met a singular matrix or an overflow, or did not reach the floor. Contains its
    /// last residuals.
    NoRoot(Residuals),
}

/// The momentum rows eliminated from the energy row. Everything is multiplied by the determinant of A if A is solved by
/// one quotient, so that the quotients of a step are independent; otherwise by 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Elimination<const N: usize, T> {
    /// `a = A⁻¹ r`.
    pub(crate) residual: SVector<T, N>,
    /// `b = A⁻¹ ∂r/∂h`.
    pub(crate) residual_dh: SVector<T, N>,
    /// `S = energy_dh − energy_dv·b`.
    pub(crate) schur: T,
    /// Sum of the absolute values of the terms of S.
    schur_magnitude: T,
    determinant: T,
    /// 1/determinant.
    reciprocal: T,
}

impl<const N: usize, T: Scalar> Elimination<N, T> {
    /// Eliminates the momentum rows. The result is not finite if A is singular.
    #[inline]
    pub(crate) fn of(equations: &ExtendedSystem<N, T, impl Matrix<N, T>>) -> Self {
        let momentum = &equations.momentum;
        let both = SMatrix::<T, N, 2>::from_columns(&[momentum.residual, equations.residual_dh]);
        Self::from_solved(equations, momentum.jacobian.quotient(&both))
    }

    /// Eliminates the momentum rows with pivoting; `None` if A is singular.
    #[inline]
    pub(crate) fn finite(equations: &ExtendedSystem<N, T, impl Matrix<N, T>>) -> Option<Self> {
        let momentum = &equations.momentum;
        let both = SMatrix::<T, N, 2>::from_columns(&[momentum.residual, equations.residual_dh]);
        let solved = linear::solve(&momentum.jacobian, &both)?;
        Some(Self::from_solved(equations, (solved, T::one())))
    }

    #[inline]
    fn from_solved(
        equations: &ExtendedSystem<N, T, impl Matrix<N, T>>,
        (solved, determinant): (SMatrix<T, N, 2>, T),
    ) -> Self {
        let (residual, residual_dh) = (solved.column(0).into_owned(), solved.column(1).into_owned());
        let mut schur = equations.energy_dh * determinant;
        let mut schur_magnitude = schur.abs();
        for (energy_dv, b) in equations.energy_dv.iter().zip(residual_dh.iter()) {
            let term = *energy_dv * *b;
            schur -= term;
            schur_magnitude += term.abs();
        }
        Self { residual, residual_dh, schur, schur_magnitude, determinant, reciprocal: determinant.recip() }
    }

    /// The correction `(δv, δh)` of the trial.
    #[inline]
    pub(crate) fn change(
        &self,
        equations: &ExtendedSystem<N, T, impl Matrix<N, T>>,
        trial: &VelocityStep<N, T>,
    ) -> VelocityStep<N, T> {
        let mut known = T::zero();
        for i in 0..N {
            known +=
                (equations.energy_dv[i] * trial.h - equations.momentum.residual[i] * T::real(0.5)) * self.residual[i];
        }
        // Numerator and denominator are both multiplied by h: one quotient instead of two in sequence.
        let energy = equations.energy_residual * self.determinant - known;
        let dh = -(energy / (self.schur * trial.h));
        VelocityStep { v: -(self.residual + self.residual_dh * dh) * self.reciprocal, h: dh }
    }

    /// −4 S, the step density D of the interval.
    #[inline]
    pub(crate) fn density_or_infinite(&self) -> T {
        self.schur * self.reciprocal * T::real(-4.0)
    }

    /// Step density D of the interval; `None` if one of its terms is not finite.
    #[inline]
    pub(crate) fn density(&self) -> Option<T> {
        (self.schur_magnitude * T::real(4.0)).is_finite().then(|| self.density_or_infinite())
    }

    /// Whether S is zero to rounding.
    #[inline]
    pub(crate) fn is_degenerate(&self) -> bool {
        // Also true for NaN.
        let rounding = self.schur_magnitude * T::real(VANISHING * T::EPSILON);
        self.schur.abs().partial_cmp(&rounding) != Some(Ordering::Greater)
    }
}

/// The energy residual `e = c + v·r` of evaluated rows. In stiff steps the term v·(h/2) L_q, accurate only to the
/// digits of L_q, is the same number in both and cancels.
#[inline(always)]
pub(crate) fn energy_residual<const N: usize, T: Scalar>(measured: &ExtendedResidual<N, T>, v: &SVector<T, N>) -> T {
    measured.energy_residual + v.dot(&measured.residual)
}

/// Both equations of a step with h in a range.
struct MomentumAndEnergy<'a, const N: usize, T, S> {
    system: &'a S,
    node: &'a Node<N, T>,
    range: (T, T),
}

/// The equations at a trial, with their rounding-error bounds.
struct RowEvaluation<const N: usize, T, J> {
    trial: VelocityStep<N, T>,
    system: ExtendedSystem<N, T, J>,
    measured: ExtendedResidual<N, T>,
    scale: Rounding<N, T>,
}

impl<const N: usize, T: Scalar, S: EnergyStepping<N, T>> Equations<T> for MomentumAndEnergy<'_, N, T, S> {
    type Unknowns = VelocityStep<N, T>;
    type Evaluation = RowEvaluation<N, T, S::Jacobian>;

    fn at(&self, trial: &VelocityStep<N, T>) -> Self::Evaluation {
        let (node, VelocityStep { v, h }) = (self.node, trial);
        RowEvaluation {
            trial: *trial,
            system: self.system.extended_system(node, *h, v),
            measured: self.system.extended_residual(node, *h, v),
            scale: self.system.extended_rounding(node, *h, v),
        }
    }

    fn roundings(&self, of: &Self::Evaluation, scales: &Self::Evaluation) -> [f64; 2] {
        let RowEvaluation { trial, measured, .. } = of;
        let scale = &scales.scale;
        let combined = roundings(measured.energy_residual, scale.energy_residual);
        let energy = roundings(energy_residual(measured, &trial.v), scale.energy);
        // The energy residual follows from the rows: below the floor it needs no further iteration.
        let energy = if energy <= FLOOR { 0.0 } else { energy };
        [worst(&measured.residual, &scale.residual), worse(combined, energy)]
    }

    fn correction(
        &self,
        jacobian: &Self::Evaluation,
        residual: &Self::Evaluation,
    ) -> Result<VelocityStep<N, T>, newton::Failure> {
        let mut system = jacobian.system;
        system.momentum.residual = residual.system.momentum.residual;
        system.energy_residual = residual.system.energy_residual;
        let elimination = Elimination::finite(&system).ok_or(newton::Failure::Singular)?;
        let change = elimination.change(&system, &jacobian.trial);
        // The correction is subtracted.
        Ok(VelocityStep { v: -change.v, h: -change.h })
    }

    fn admits(&self, trial: &VelocityStep<N, T>) -> bool {
        let (shortest, longest) = self.range;
        trial.h >= shortest && trial.h <= longest
    }
}

/// The step that Newton iteration reaches from `trial` with h inside `range`.
pub(crate) fn solve<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    trial: VelocityStep<N, T>,
    range: (T, T),
) -> Result<EnergyStep<N, T>, NoStep<T>> {
    let extended = MomentumAndEnergy { system, node, range };
    let root = newton::solve(&extended, trial).map_err(|failure| match failure {
        newton::Failure::Stalled { residuals, .. } => NoStep::NoRoot(residuals),
        _ => NoStep::NoRoot(Residuals::new()),
    })?;
    let VelocityStep { v, h } = root.u;
    let no_root = NoStep::NoRoot(root.residuals);
    let elimination = Elimination::finite(&root.at.system).ok_or(no_root)?;
    let density = elimination.density().ok_or(no_root)?;
    if elimination.is_degenerate() {
        return Err(NoStep::Degenerate { h, density });
    }
    let [momentum, energy] = extended.roundings(&root.at, &root.at);
    Ok(EnergyStep { v, h, density, iterations: root.iterations, measured: RowResiduals::of(worse(momentum, energy)) })
}
