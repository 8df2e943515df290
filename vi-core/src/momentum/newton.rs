//! The momentum equation of a given step h, for Newton iteration.
//!
//! In: a node, h and a guess. Out: the v with `−D2 L_d − f_d⁻ = p0` to the rounding floor
//! ([`FixedStepping::momentum_rounding`]), at which the matrix A is regular.

use crate::error::StepError;
use crate::linear::{self, Matrix};
use crate::newton::{self, Equations, Failure, Root, worst};
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::{FixedStepping, MomentumEquation};
use nalgebra::{SMatrix, SVector};

/// The momentum equation of a step.
struct Momentum<'a, const N: usize, T, S> {
    system: &'a S,
    node: &'a Node<N, T>,
    h: T,
}

/// The equation at some velocity, with its rounding-error bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluated<const N: usize, T, J> {
    equation: MomentumEquation<N, T, J>,
    scale: SVector<T, N>,
}

/// A root of the momentum equation.
pub(crate) type Solution<const N: usize, T, J> = Root<SVector<T, N>, Evaluated<N, T, J>>;

impl<const N: usize, T: Scalar, S: FixedStepping<N, T>> Equations<T> for Momentum<'_, N, T, S> {
    type Unknowns = SVector<T, N>;
    type Evaluation = Evaluated<N, T, S::Jacobian>;

    fn at(&self, v: &SVector<T, N>) -> Self::Evaluation {
        let equation = self.system.momentum_equation(self.node, self.h, v);
        Evaluated { equation, scale: self.system.momentum_rounding(self.node, self.h, v) }
    }

    fn roundings(&self, of: &Self::Evaluation, scales: &Self::Evaluation) -> [f64; 2] {
        [worst(&of.equation.residual, &scales.scale), 0.0]
    }

    fn correction(&self, jacobian: &Self::Evaluation, residual: &Self::Evaluation) -> Result<SVector<T, N>, Failure> {
        let jacobian = &jacobian.equation.jacobian;
        linear::solve(jacobian, &residual.equation.residual).ok_or_else(|| {
            let is_finite = jacobian.dense().iter().all(|entry| entry.is_finite());
            if is_finite { Failure::Singular } else { Failure::InfiniteJacobian }
        })
    }

    #[cold]
    fn pivoted(&self, at: &Self::Evaluation) -> Option<SVector<T, N>> {
        let MomentumEquation { residual, jacobian } = &at.equation;
        linear::solve::<_, N, 1>(&jacobian.dense() as &SMatrix<T, N, N>, residual)
    }
}

/// The largest residual of the momentum equation at `(v, h)`, over its rounding-error bound.
pub(crate) fn residual<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> f64 {
    let at = Momentum { system, node, h }.at(v);
    worst(&at.equation.residual, &at.scale)
}

/// Solves the momentum equation at `h` for the velocity, from a guess.
pub(crate) fn solve<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
) -> Result<Solution<N, T, S::Jacobian>, Failure> {
    newton::solve(&Momentum { system, node, h }, guess)
}

/// The velocity of the momenta of a node: the root at h = 0.
///
/// # Errors
/// [`StepError::Singular`], [`StepError::NonFinite`] or [`StepError::NotConverged`] from the last guess.
pub(crate) fn velocity<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    guesses: [SVector<T, N>; 2],
) -> Result<SVector<T, N>, StepError> {
    let [first, second] = guesses;
    let root = solve(system, node, T::zero(), first).or_else(|_| solve(system, node, T::zero(), second));
    root.map(|root| root.u).map_err(|failure| {
        // At h = 0 the derivative is the mass matrix, unless a derivative of L or f is infinite.
        let is_infinite = matches!(failure, Failure::InfiniteJacobian);
        let matrix = if is_infinite { "derivative of the momentum equation" } else { "mass matrix" };
        failure.at(node.t.to_f64(), 0.0, matrix)
    })
}
