//! Starts of a run: from a state, or from a first interval.
//!
//! Both return the node with its energy, and the interval that precedes the next step.

use super::equations::Elimination;
use super::interval::Last;
use super::lengths::{After, Lengths};
use crate::called::Called;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::momentum::continuation::{self, BranchPoint};
use crate::newton::FLOOR;
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::stepping::EnergyStepping;
use nalgebra::SVector;

/// The memory of a run that starts at a node with a first step of the length h. Sets the energy of the node to the
/// discrete energy `D1 L_d + g_d⁻` of that step.
///
/// # Errors
/// The errors of a fixed step of that length; [`StepError::TooLong`] if it does not continue short ones.
pub(crate) fn from_state<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &mut Node<N, T>,
    h: T,
) -> Result<Lengths<N, T>, StepError> {
    check_density(system)?;
    let state = node.state();
    let rest = state.velocity(system)?;
    let called = &Called(*system);
    let explained = |failure: StepError| failure.explained(system, node, h, &rest);
    let first = continuation::nearest(called, node, h, rest, rest).map_err(explained)?;
    let BranchPoint { v, .. } = continuation::connected(called, node, h, &first.v)?.unwrap_or(first);
    let bare = Node::new(state, T::zero());
    let equations = called.extended_system(&bare, h, &v);
    let t = state.t.to_f64();
    let singular = StepError::Singular { t, matrix: "derivative of the momentum equation" };
    let infinite = |quantity| StepError::NonFinite { t, quantity, expression: None };
    let elimination = Elimination::finite(&equations).ok_or(singular)?;
    let density = elimination.density().ok_or(infinite("step density")).map_err(explained)?;
    // The energy row is e = c + v·r.
    let energy = equations.energy_residual + v.dot(&equations.momentum.residual);
    if !energy.is_finite() {
        return Err(explained(infinite("energy")));
    }
    node.energy = energy;
    // There is no interval before this step: an equal one replaces it.
    Ok(Lengths::new(Last::first(v, h, density, SVector::zeros())))
}

/// Smallest `h² |D|` that determines a length, in roundings of the energy of a step. One rounding of `H − E = h² D/8`
/// changes h by an eighth; the accepted error of [`FLOOR`] roundings changes it by half. The paper's double well with
/// h0 = 1e-6 is above.
const LEAST: f64 = 8.0 * FLOOR;

/// Checks that the energy determines the length of the first step after `last`.
///
/// # Errors
/// [`StepError::DegenerateStep`].
pub(crate) fn check_length<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    last: &Last<N, T>,
) -> Result<(), StepError> {
    let [h, density] = [last.h, last.density].map(T::to_f64);
    let rounding = T::EPSILON * system.extended_rounding(node, last.h, &last.v).energy.to_f64();
    // False for NaN, which later checks name.
    let is_lost = h * h * density.abs() <= LEAST * rounding;
    if is_lost { Err(StepError::DegenerateStep { t: node.t.to_f64(), h, density }) } else { Ok(()) }
}

/// The run at the end of the step `(v, h)` from `start`.
pub(crate) fn first_interval<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    start: Node<N, T>,
    h: T,
    v: SVector<T, N>,
) -> Result<After<N, T>, StepError> {
    let t = if start.t.to_f64().is_finite() { start.t } else { T::zero() };
    start.check_finite(t)?;
    let start = start.leaving(system, h, &v);
    let node = start.advanced(system, h, &v, &system.extended_residual(&start, h, &v).increment);
    node.check_finite(t)?;
    let singular = StepError::Singular { t: t.to_f64(), matrix: "derivative of the momentum equation" };
    let infinite = StepError::NonFinite { t: t.to_f64(), quantity: "step density", expression: None };
    let elimination = Elimination::finite(&system.extended_system(&start, h, &v)).ok_or(singular)?;
    let density = elimination.density().ok_or(infinite)?;
    let (t_mid, q_mid) = start.midpoint(h, &v);
    // Only the first guess depends on the acceleration; without one v is constant.
    let acceleration = system.acceleration(t_mid, &q_mid, &v).unwrap_or_else(|_| SVector::zeros());
    Ok(After { node, lengths: Lengths::new(Last::first(v, h, density, acceleration * h)) })
}

/// Checks that the step density is continuous.
///
/// # Errors
/// [`StepError::NoStepDensity`].
pub(crate) fn check_density<const N: usize, T: Real>(system: &impl Lagrangian<N, T>) -> Result<(), StepError> {
    system.monotone_table().map_or(Ok(()), |table| Err(StepError::NoStepDensity { table }))
}
