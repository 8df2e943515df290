//! The momentum equation followed from h = 0, where its root is the velocity that belongs to p.
//!
//! In: a node, a step h and a guess of the velocity at h = 0. Out: the root v(h) on the branch that is connected with
//! h = 0: followed in parts of h that double after a success and halve after a failure. Where the branch ends, at a
//! singular derivative of the equation, no part is small enough and the step has no such root. On the way there the
//! determinant of the derivative keeps its sign, and beyond the turn it has the other one.

use super::{FLOOR, Failure, Solution, newton};
use crate::error::Residuals;
use crate::error::StepError;
use crate::linear::{self, Matrix};
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// How the branch is followed: by which parts of h, and how close to the last root the next one must be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    largest_part: f64,
    /// Smallest part of h by which continuation goes on before it gives up.
    least_part: f64,
    /// Newton iterations above the rounding floor from one root to the next; more, and it may belong to another branch.
    iterations: u32,
    /// Whether the determinant of the derivative must keep its sign.
    signed: bool,
}

impl Pace {
    /// To find a root where Newton's iteration from the guess found none: the branch is left where the iteration leaps.
    const RESCUE: Self = Self { largest_part: 1.0, least_part: 1.0 / 64.0, iterations: u32::MAX, signed: false };
    /// To stay on the branch.
    pub(crate) const CLOSE: Self =
        Self { largest_part: 1.0 / 16.0, least_part: 1.0 / 65536.0, iterations: 3, signed: true };
}

/// The root that Newton's iteration reaches from `guess`; where it fails, the root at `h` on the branch connected with
/// h = 0, where v is near `start`.
///
/// # Errors
/// As [`solve`].
#[cold]
pub(crate) fn nearest<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
    start: SVector<T, N>,
) -> Result<Solution<N, T>, StepError> {
    newton::solve(system, node, h, guess).or_else(|_| solve(system, node, h, start, Pace::RESCUE))
}

/// The root at `h` on the branch connected with h = 0.
///
/// # Errors
/// [`StepError::NotConverged`] where the branch ends before h; [`StepError::NonFinite`], [`StepError::Singular`].
#[cold]
pub(crate) fn solve<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
    pace: Pace,
) -> Result<Solution<N, T>, StepError> {
    let mut v = newton::velocity(system, node, [guess, node.p])?;
    let sign = |h: T, v: &SVector<T, N>| {
        if pace.signed { linear::determinant_sign(&system.momentum_equation(node, h, v).jacobian.dense()) } else { 1 }
    };
    let forward = sign(T::zero(), &v);
    let (mut reached, mut part, mut spent) = (0.0, pace.largest_part, 0);
    while reached < 1.0 {
        let target = f64::min(reached + part, 1.0);
        let (mut residuals, mut iterations) = (Residuals::new(), 0);
        let mut observe = |residual| {
            residuals.push(residual);
            iterations += u32::from(residual > FLOOR);
        };
        let at = h * T::real(target);
        let solution = newton::observed(system, node, at, v, &mut observe);
        match solution {
            Ok(solution) if iterations <= pace.iterations && sign(at, &solution.v) == forward => {
                (v, reached, part) = (solution.v, target, pace.largest_part.min(2.0 * part));
                spent += solution.iterations;
            }
            Ok(_) if part <= pace.least_part => {
                let residual = newton::residual(system, node, h, &v);
                let failure = Failure::Stalled { iterations: spent, residual };
                return Err(failure.at(node.t.to_f64(), h.to_f64(), "derivative of the momentum equation", residuals));
            }
            Err(failure) if part <= pace.least_part => {
                let failure = match failure {
                    // On the way to the last root the Jacobian loses its inverse: there is no root beyond.
                    Failure::Singular => match newton::residual(system, node, h, &v) {
                        residual if residual.is_finite() => Failure::Stalled { iterations: spent, residual },
                        _ => Failure::NonFinite,
                    },
                    Failure::Stalled { iterations, residual } => {
                        Failure::Stalled { iterations: spent + iterations, residual }
                    }
                    Failure::NonFinite => failure,
                };
                return Err(failure.at(node.t.to_f64(), h.to_f64(), "derivative of the momentum equation", residuals));
            }
            _ => part /= 2.0,
        }
    }
    Ok(Solution { v, iterations: spent })
}
