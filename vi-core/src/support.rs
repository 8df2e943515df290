//! Internals for the other crates of this project, without any stability promise.

pub use crate::angles::{Reduced, Turns, are_far, has_angles, reduced as reduced_angles, state as state_with_turns};
pub use crate::compensated::two_sum;
#[cfg(feature = "alloc")]
pub use crate::constrained::{constrained_acceleration, constrained_flow};
pub use crate::first_order::first_order_flow;
pub use crate::legendre::{acceleration, step_density, velocity, velocity_by_mass};
pub use crate::method::check_step;
pub use crate::predictor::weights;
pub use crate::stepping::{extended_rounding, momentum_rounding};

use crate::branch::Branch;
use crate::called::Called;
use crate::error::StepError;
use crate::momentum::steps::Steps;
use crate::node::Node;
use crate::real::Scalar;
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// The node and the velocity after one step of length h from `node`, by Newton iteration from `last`, the velocity of
/// the previous step.
///
/// # Errors
/// As [`Run::step`](crate::Run::step).
#[cold]
pub fn step_alone<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    last: SVector<T, N>,
) -> Result<(Node<N, T>, SVector<T, N>), StepError> {
    let explained = |failure: StepError| failure.explained(system, node, h, &last);
    let solved = Steps::new(h, last).searched(&Called(*system), node, Branch::Nearest).map_err(explained)?;
    let mut next = *node;
    next.advance(h, &solved.v, &solved.increment);
    next.check_finite(node.t).map_err(explained)?;
    Ok((next, solved.v))
}
