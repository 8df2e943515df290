//! The momentum equation followed from h = 0, where its root is the velocity that belongs to p.
//!
//! In: a node, a step h and a guess of the velocity at h = 0. Out: the root v(h) on the branch that is connected with
//! h = 0: followed in parts of h that double after a success and halve after a failure. Where the branch ends, at a
//! singular derivative of the equation, no part is small enough and the step has no such root.

use crate::error::Residuals;
use crate::momentum::{self, Failure, Solution};
use crate::{Node, Scalar, StepError, Stepping};
use nalgebra::SVector;

/// Smallest part of h by which continuation goes on before it gives up.
const LEAST_PART: f64 = 1.0 / 64.0;

/// The root at `h` on the branch connected with h = 0.
///
/// # Errors
/// [`StepError::NotConverged`] where the branch ends before h; [`StepError::NonFinite`], [`StepError::Singular`].
#[cold]
pub(crate) fn solve<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
) -> Result<Solution<N, T>, StepError> {
    let mut v = momentum::velocity(system, node, [guess, node.p])?;
    let (mut reached, mut part, mut spent) = (0.0, 1.0, 0);
    while reached < 1.0 {
        let target = f64::min(reached + part, 1.0);
        let mut residuals = Residuals::new();
        match momentum::observed(system, node, h * T::real(target), v, |residual| residuals.push(residual)) {
            Ok(solution) => {
                (v, reached, part) = (solution.v, target, 2.0 * part);
                spent += solution.iterations;
            }
            Err(failure) if part <= LEAST_PART => {
                let failure = match failure {
                    // On the way to the last root the Jacobian loses its inverse: there is no root beyond.
                    Failure::Singular => match residual(system, node, h, v) {
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
            Err(_) => part /= 2.0,
        }
    }
    Ok(Solution { v, iterations: spent })
}

/// Residual at the whole step, in roundings.
fn residual<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: SVector<T, N>,
) -> f64 {
    let equation = system.momentum_equation(node, h, &v);
    momentum::worst(&equation.residual, &equation.magnitude)
}
