//! Continuation of the momentum equation from h = 0, where its root is the velocity of p.
//!
//! From a node, a step h and a guess of the velocity at h = 0 follows the root v(h) on the branch that is connected
//! with h = 0. The parts of h double after a success and halve after a failure. The branch ends at a singular Jacobian:
//! then no part is small enough and the step has no such root. The determinant keeps its sign up to the turning point
//! and has the other sign beyond.

use super::newton;
use crate::error::{Residuals, StepError};
use crate::linear::{self, Matrix};
use crate::newton::Failure;
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// Parameters of the continuation: the parts of h, and the allowed distance between two roots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    largest_part: f64,
    /// Smallest part of h before the continuation fails.
    least_part: f64,
    /// Newton iterations above the rounding floor from one root to the next; more may lead to another branch.
    iterations: u32,
    /// Whether the determinant must keep its sign.
    signed: bool,
}

impl Pace {
    /// Finds a root after Newton iteration from the guess has failed. May change the branch.
    const RESCUE: Self = Self { largest_part: 1.0, least_part: 1.0 / 64.0, iterations: u32::MAX, signed: false };
    /// Stays on the branch.
    pub(crate) const CLOSE: Self =
        Self { largest_part: 1.0 / 16.0, least_part: 1.0 / 65536.0, iterations: 3, signed: true };
}

/// A velocity, and the number of iterations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BranchPoint<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) iterations: u32,
}

/// The root that Newton iteration reaches from `guess`; if it fails, the root at `h` on the branch connected with h =
/// 0, where v is near `start`.
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
) -> Result<BranchPoint<N, T>, StepError> {
    match newton::solve(system, node, h, guess) {
        Ok(root) => Ok(BranchPoint { v: root.u, iterations: root.iterations }),
        Err(_) => solve(system, node, h, start, Pace::RESCUE),
    }
}

/// The root at `h` on the branch connected with h = 0.
///
/// # Errors
/// [`StepError::NotConverged`] if the branch ends before h; [`StepError::NonFinite`], [`StepError::Singular`].
#[cold]
pub(crate) fn solve<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
    pace: Pace,
) -> Result<BranchPoint<N, T>, StepError> {
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
                // The residual of the last root in the whole step, or the residual of the stalled iteration.
                let residual = newton::residual(system, node, h, &v);
                let failure = match root {
                    Ok(root) => Failure::Stalled { iterations: spent, residual, residuals: root.residuals },
                    // Toward the last root the Jacobian becomes singular, so that no root exists beyond.
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
    Ok(BranchPoint { v, iterations: spent })
}
