//! The momentum equation followed from h = 0, where its root is the velocity that belongs to p.
//!
//! In: a node, a step h and a guess of the velocity at h = 0. Out: the root v(h) on the branch that is connected with
//! h = 0: followed in parts of h that double after a success and halve after a failure. Where the branch ends, at a
//! singular derivative of the equation, no part is small enough and the step has no such root. On the way there the
//! determinant of the derivative keeps its sign, and beyond the turn it has the other one.

use super::newton;
use crate::error::{Residuals, StepError};
use crate::linear::{self, Matrix};
use crate::newton::Failure;
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

/// A velocity, and the iterations that it took.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reached<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) iterations: u32,
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
) -> Result<Reached<N, T>, StepError> {
    match newton::solve(system, node, h, guess) {
        Ok(root) => Ok(Reached { v: root.u, iterations: root.iterations }),
        Err(_) => solve(system, node, h, start, Pace::RESCUE),
    }
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
) -> Result<Reached<N, T>, StepError> {
    let mut v = newton::velocity(system, node, [guess, node.p])?;
    let sign = |h: T, v: &SVector<T, N>| {
        if pace.signed { linear::determinant_sign(&system.momentum_equation(node, h, v).jacobian.dense()) } else { 1 }
    };
    let forward = sign(T::zero(), &v);
    let (mut reached, mut part, mut spent) = (0.0, pace.largest_part, 0);
    while reached < 1.0 {
        let target = f64::min(reached + part, 1.0);
        let at = h * T::real(target);
        let root = newton::solve(system, node, at, v);
        match root {
            Ok(root) if root.above_floor <= pace.iterations && sign(at, &root.u) == forward => {
                (v, reached, part) = (root.u, target, pace.largest_part.min(2.0 * part));
                spent += root.iterations;
            }
            _ if part > pace.least_part => part /= 2.0,
            _ => {
                // What the last root leaves of the whole step. Where the iteration stalled on the way, what it left there.
                let residual = newton::residual(system, node, h, &v);
                let failure = match root {
                    Ok(root) => Failure::Stalled { iterations: spent, residual, residuals: root.residuals },
                    // On the way to the last root the Jacobian loses its inverse: there is no root beyond.
                    Err(Failure::Singular) if residual.is_finite() => {
                        Failure::Stalled { iterations: spent, residual, residuals: Residuals::new() }
                    }
                    Err(Failure::Stalled { iterations, residual, residuals }) => {
                        Failure::Stalled { iterations: spent + iterations, residual, residuals }
                    }
                    Err(Failure::InfiniteJacobian) if residual.is_finite() => Failure::InfiniteJacobian,
                    Err(_) => Failure::NonFinite,
                };
                return Err(failure.at(node.t.to_f64(), h.to_f64(), "derivative of the momentum equation"));
            }
        }
    }
    Ok(Reached { v, iterations: spent })
}
