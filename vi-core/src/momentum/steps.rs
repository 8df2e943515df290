//! Sequences of momentum steps of one length.
//!
//! In: a node, the step h and the velocities of the last steps. Out: the velocity v that solves the momentum equation
//! `r(v) = −D2 L_d − f_d⁻ − p0 = 0`, and the momentum increment. A step is extrapolated, corrected and checked:
//!
//! ```text
//! guess      v0 extrapolated over the last steps (`predictor`)
//! correct    v = v0 − A⁻¹ r(v0)                A = ∂r/∂v at v0; if A is constant, its inverse is computed once per run
//! evaluate   r(v) and p1 − p0, by one evaluation at v
//! accept     if each row has |r_i| ≤ 4 ε (|p0_i| + |p1_i − p0_i|), or 4 ε times the sum of the absolute values of its terms
//! otherwise  one more correction with the same A and one with a new one, each checked; then Newton iteration to the rounding floor (`newton`)
//! ```
//!
//! The acceptance test is off the critical path: the next step needs v only, so that both overlap.
//!
//! The residual of an accepted step is a few roundings, but it may have a constant sign and add up. The next step
//! therefore solves `r(v) + remainder = 0`, to half of those roundings. Over many steps the remainders cancel, as in a
//! compensated sum.

use super::closed_form::ClosedForm;
use super::continuation::{self, BranchPoint};
use crate::branch::Branch;
use crate::error::StepError;
use crate::linear::Matrix;
use crate::newton::{are_at_floor, worst};
use crate::node::Node;
use crate::predictor::Predictor;
use crate::real::{Real, Scalar};
use crate::stepping::{FixedStepping, MomentumEquation, MomentumResidual};
use crate::vector::Vector;
use core::hint::black_box;
use nalgebra::SVector;

/// Most corrections of a guess.
const CORRECTIONS: u32 = 3;
/// Corrections with A at the guess. Later ones use A at the velocity after these.
const WITH_FIRST: u32 = 2;
/// Accepted residual of a row including its carried remainder, in roundings.
const REMAINING: f64 = 2.0;

/// The corrector of a step. It depends on the system, its parameters and h alone.
#[derive(Clone, Copy, Debug)]
pub enum Corrector<J: Matrix<N, T>, const N: usize, T: Real> {
    /// The whole step is one matrix product; A is constant.
    ClosedForm(ClosedForm<T>, J::Inverse),
    /// The inverse of a constant A.
    Inverse(J::Inverse),
    /// A at the guess.
    Newton,
}

impl<J: Matrix<N, T>, const N: usize, T: Scalar> Corrector<J, N, T> {
    /// The corrector of steps of length h.
    pub(crate) fn of<S: FixedStepping<N, T, Jacobian = J>>(system: &S, h: T) -> Self {
        if !system.has_constant_jacobian() {
            return Self::Newton;
        }
        let inverse = system.momentum_equation(&Node::zeros(), h, &SVector::zeros()).jacobian.inverse();
        if system.has_closed_form() {
            Self::ClosedForm(ClosedForm::of(system, h, &inverse), inverse)
        } else {
            Self::Inverse(inverse)
        }
    }

    /// Solves `A x = residual`.
    #[inline(always)]
    fn correction(&self, jacobian: &J, residual: &SVector<T, N>) -> SVector<T, N> {
        match self {
            Self::ClosedForm(_, inverse) | Self::Inverse(inverse) => J::apply(inverse, residual),
            Self::Newton => jacobian.solve_unchecked(residual),
        }
    }
}

/// The residual of a step with its scale and its remainder.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct StepResidual<const N: usize, T> {
    /// r(v).
    residual: SVector<T, N>,
    /// Scale of each row: one rounding is ε times this.
    scale: SVector<T, N>,
}

impl<const N: usize, T: Scalar> StepResidual<N, T> {
    /// The residual before the first step: zero.
    fn none() -> Self {
        Self { residual: SVector::zeros(), scale: SVector::zeros() }
    }

    /// Whether each row is within [`FLOOR`](crate::newton::FLOOR) roundings, and within half as many including its
    /// remainder.
    #[inline(always)]
    fn is_at_floor(&self, carried: &SVector<T, N>) -> bool {
        are_at_floor(&self.residual, carried, &self.scale, REMAINING)
    }

    /// The largest residual in roundings.
    pub(crate) fn roundings(&self) -> f64 {
        worst(&self.residual, &self.scale)
    }
}

/// A solved momentum step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MomentumStep<const N: usize, T> {
    /// The velocity.
    pub(crate) v: SVector<T, N>,
    /// The momentum increment.
    pub(crate) increment: SVector<T, N>,
    /// Number of corrections.
    pub(crate) iterations: u32,
    measured: StepResidual<N, T>,
    /// Remainder for the next step.
    remainder: SVector<T, N>,
    /// Whether the guess was usable.
    predicted: bool,
}

/// A sequence of momentum steps of one length; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub struct Steps<const N: usize, T> {
    pub(crate) h: T,
    predictor: Predictor<N, T>,
    remainder: SVector<T, N>,
    measured: StepResidual<N, T>,
    /// Whether a step has been taken.
    begun: bool,
    /// Whether the parameters have changed since. Merging the two flags into one enum slows a step of Kepler's problem
    /// by a tenth.
    changed: bool,
}

impl<const N: usize, T: Scalar> Steps<N, T> {
    /// Starts from a guess of the first velocity.
    pub(crate) fn new(h: T, guess: SVector<T, N>) -> Self {
        let (predictor, measured) = (Predictor::new(guess), StepResidual::none());
        Self { h, predictor, remainder: SVector::zeros(), measured, begun: false, changed: false }
    }

    /// A copy number by number, as [`Node::apart`].
    #[inline(always)]
    pub(crate) fn apart(&self) -> Self {
        let copy = |u| Vector::map(u, black_box);
        let StepResidual { residual, scale } = &self.measured;
        Self {
            h: black_box(self.h),
            predictor: self.predictor.apart(),
            remainder: copy(&self.remainder),
            measured: StepResidual { residual: copy(residual), scale: copy(scale) },
            begun: black_box(self.begun),
            changed: black_box(self.changed),
        }
    }

    /// The sequence for another length. The last velocity is the first guess, and the last residual stays.
    pub(crate) fn with_length(&self, h: T) -> Self {
        Self { measured: self.measured, ..Self::new(h, self.v()) }
    }

    /// The sequence for the same system with other parameters.
    pub(crate) fn with_other_parameters(self) -> Self {
        Self { changed: true, ..self }
    }

    /// Whether no step has been taken yet.
    pub(crate) fn is_new(&self) -> bool {
        !self.begun
    }

    /// Whether the parameters are those of the last step.
    pub(crate) fn has_parameters_of_last(&self) -> bool {
        self.begun && !self.changed
    }

    /// Velocity of the last step; before the first one its guess.
    pub(crate) fn v(&self) -> SVector<T, N> {
        self.predictor.newest()
    }

    /// Residual of the last step.
    pub(crate) fn measured(&self) -> &StepResidual<N, T> {
        &self.measured
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        let StepResidual { residual, scale } = &self.measured;
        let vectors = [&self.remainder, residual, scale];
        self.predictor.is_finite() && vectors.into_iter().flat_map(|u| u.iter()).all(|entry| entry.is_finite())
    }

    /// Whether the next step is common: by one matrix product, or from a guess of the highest order.
    #[inline(always)]
    pub(crate) fn is_common<S: FixedStepping<N, T>>(&self, system: &S) -> bool {
        system.has_closed_form() || self.predictor.is_highest()
    }

    /// The common step from `node`: by one matrix product, or by corrections of a guess of the highest order. `None` if
    /// these do not converge.
    #[inline(always)]
    pub(crate) fn common<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        corrector: &Corrector<S::Jacobian, N, T>,
    ) -> Option<MomentumStep<N, T>> {
        match corrector {
            Corrector::ClosedForm(form, _) if system.has_closed_form() => self.by_matrix(system, node, form),
            _ => self.corrected(system, node, corrector, self.predictor.guess_highest()),
        }
    }

    /// The extrapolated velocity.
    pub(crate) fn guess(&self) -> SVector<T, N> {
        self.predictor.guess()
    }

    /// The step from `node` by corrections of v; `None` after three without convergence.
    #[inline(always)]
    pub(crate) fn corrected<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        corrector: &Corrector<S::Jacobian, N, T>,
        mut v: SVector<T, N>,
    ) -> Option<MomentumStep<N, T>> {
        // A known variant, for the optimizer.
        let corrector = if system.has_constant_jacobian() { corrector } else { &Corrector::Newton };
        let mut equation = self.equation(system, node, &v);
        let carried = if system.is_inlined() { self.remainder - node.p_low } else { self.remainder };
        let mut left = equation.residual + carried;
        for iterations in 1..=CORRECTIONS {
            v -= corrector.correction(&equation.jacobian, &left);
            let at = system.momentum_residual(node, self.h, &v);
            let solved = self.accepted(system, node, &v, &at, iterations);
            if solved.is_some() {
                return solved;
            }
            left = at.residual + self.remainder;
            if iterations == WITH_FIRST && !system.has_constant_jacobian() {
                equation = self.equation(system, node, &v);
            }
        }
        None
    }

    /// The equation at a trial velocity; of short functions without the low part of p, which is subtracted from the
    /// remainder, and without that of q.
    #[inline(always)]
    fn equation<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        v: &SVector<T, N>,
    ) -> MomentumEquation<N, T, S::Jacobian> {
        if !system.is_inlined() {
            return system.momentum_equation(node, self.h, v);
        }
        // The low parts of the node are known last, and the equation would wait for them. Only the guess lacks the low
        // part of q: the residual at the corrected v has it. The optimizer drops -0 from a sum and 0 from a difference.
        let rounded = Node { q_low: SVector::repeat(-T::zero()), p_low: SVector::zeros(), ..*node };
        system.momentum_equation(&rounded, self.h, v)
    }

    /// The step with this v, if its residual is at the floor.
    #[inline(always)]
    fn accepted<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        v: &SVector<T, N>,
        at: &MomentumResidual<N, T>,
        iterations: u32,
    ) -> Option<MomentumStep<N, T>> {
        let MomentumResidual { residual, scale, increment } = *at;
        // Long functions have computed the scales of their terms. Short ones are inlined and compute them on request,
        // if momenta vanish but their terms do not.
        let first = if system.is_inlined() { momentum_scale(node, &increment) } else { scale };
        let mut measured = StepResidual { residual, scale: first };
        if !measured.is_at_floor(&self.remainder) {
            measured.scale = scale;
            if !(system.is_inlined() && measured.is_at_floor(&self.remainder)) {
                return None;
            }
        }
        let remainder = residual + self.remainder;
        Some(MomentumStep { v: *v, increment, iterations, measured, remainder, predicted: true })
    }

    /// The step by one matrix product, if that solves it to rounding.
    #[inline(always)]
    fn by_matrix<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        form: &ClosedForm<T>,
    ) -> Option<MomentumStep<N, T>> {
        let (v, increment) = form.step(node);
        let at = system.momentum_residual(node, self.h, &v);
        let measured = StepResidual { residual: at.residual, scale: momentum_scale(node, &increment) };
        let lost = StepResidual { residual: increment - at.increment, ..measured };
        let remainder = SVector::zeros();
        let solved = measured.is_at_floor(&remainder) && lost.is_at_floor(&remainder);
        solved.then_some(MomentumStep { v, increment, iterations: 0, measured, remainder, predicted: true })
    }

    /// The step from `node` by Newton iteration, or by continuation.
    ///
    /// # Errors
    /// The errors of Newton iteration and of the continuation.
    #[cold]
    pub(crate) fn searched<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        branch: Branch,
    ) -> Result<MomentumStep<N, T>, StepError> {
        let (h, start) = (self.h, self.v());
        match branch {
            Branch::Nearest => {
                let found = continuation::nearest(system, node, h, start, start)?;
                self.connected(system, node, self.step_of(system, node, found))
            }
            Branch::Connected => {
                let found = continuation::solve(system, node, h, start, continuation::Pace::CLOSE)?;
                Ok(self.step_of(system, node, found))
            }
        }
    }

    /// The step if its root is connected with h = 0; otherwise the step of the connected root.
    ///
    /// # Errors
    /// [`StepError::TooLong`] if there is none.
    #[cold]
    pub(crate) fn connected<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        solved: MomentumStep<N, T>,
    ) -> Result<MomentumStep<N, T>, StepError> {
        // If few corrections lead from the guess to the root, both are on the branch of short steps.
        let is_close = solved.predicted && solved.iterations < CORRECTIONS;
        if is_close {
            return Ok(solved);
        }
        let other = continuation::connected(system, node, self.h, &solved.v)?;
        Ok(other.map_or(solved, |found| self.step_of(system, node, found)))
    }

    /// The step of a root.
    fn step_of<S: FixedStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        BranchPoint { v, iterations }: BranchPoint<N, T>,
    ) -> MomentumStep<N, T> {
        let h = self.h;
        let MomentumResidual { residual, increment, .. } = system.momentum_residual(node, h, &v);
        let measured = StepResidual { residual, scale: system.momentum_rounding(node, h, &v) };
        MomentumStep { v, increment, iterations, measured, remainder: SVector::zeros(), predicted: false }
    }

    /// Records a common step.
    #[inline(always)]
    pub(crate) fn push_common(&mut self, solved: &MomentumStep<N, T>) {
        self.predictor.push_highest(solved.v);
        self.keep(solved);
    }

    /// Records any step.
    pub(crate) fn push(&mut self, solved: &MomentumStep<N, T>) {
        if solved.predicted {
            self.predictor.push(solved.v);
        } else {
            self.predictor.restart(solved.v);
        }
        self.keep(solved);
    }

    #[inline(always)]
    fn keep(&mut self, solved: &MomentumStep<N, T>) {
        self.remainder = solved.remainder;
        self.measured = solved.measured;
        self.begun = true;
        self.changed = false;
    }
}

/// Lower bound of the scale of each row.
#[inline(always)]
fn momentum_scale<const N: usize, T: Scalar>(node: &Node<N, T>, increment: &SVector<T, N>) -> SVector<T, N> {
    let mut scale = *increment;
    for i in 0..N {
        scale[i] = node.p[i].abs() + increment[i].abs();
    }
    scale
}
