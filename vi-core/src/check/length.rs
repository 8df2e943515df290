//! The rounding error of an energy-preserving step's length.
//!
//! The module computes the relative error of the length of a solved step due to the rounding of its equations alone. It
//! is the remaining Newton step,
//!
//! ```text
//! δh = −(c/h − energy_dv·a)/S        a = A⁻¹ r        S = energy_dh − energy_dv·A⁻¹ ∂r/∂h = −D/4
//! ```
//!
//! evaluated in numbers with rounding-error bounds. The rounding error of c is ε times the size S_E of the terms of the
//! energy, so that
//!
//! ```text
//! δh/h ≈ 4 ε S_E/(h² D) = 4 ε (τ/h)²        τ² = S_E/D
//! ```
//!
//! with τ the time scale of turning: the length of a step is a second-order quantity. Each step computes its length
//! anew from the excess `H − E = h² D/8` at its node, so that these errors do not add up along a run. Measured on the
//! systems of `tests/checks_of_many.rs` with steps dominated by rounding: 0.005 to 0.12 of the bound.

use super::bounded::{Bounded, exact};
use super::subject::{EnergyChecked, Place};
use crate::linear;
use crate::node::Node;
use crate::state::State;
use crate::stepping::{EnergyStepping, ExtendedSystem};
use nalgebra::{SMatrix, SVector};

/// Largest relative rounding error of a step length for which the check takes a run.
pub(super) const COARSE: f64 = 1e-2;
/// Beyond this relative error, its second-order effect on v exceeds the rounding of the momentum equation: a run may
/// fail for this reason alone.
pub(super) const FINE: f64 = 1e-6;

/// The step density of a step, and the relative error of its length.
#[derive(Clone, Copy, Debug)]
pub(super) struct SolvedLength {
    pub(super) density: Bounded,
    pub(super) length: f64,
}

/// The solved step `(v, h)` from `node`; `None` if A is singular.
pub(super) fn solved<const N: usize, S: EnergyChecked<N>>(
    system: &S,
    node: &Node<N, Bounded>,
    h: f64,
    v: &SVector<f64, N>,
) -> Option<SolvedLength> {
    let h = Bounded::exact(h);
    let equations = system.steps::<Bounded>().extended_system(node, h, &exact(v));
    let ExtendedSystem { momentum, residual_dh, energy_residual, energy_dv, energy_dh } = equations;
    let both = SMatrix::<Bounded, N, 2>::from_columns(&[momentum.residual, residual_dh]);
    let eliminated = linear::solve(&momentum.jacobian, &both)?;
    let schur = energy_dh - energy_dv.dot(&eliminated.column(1));
    let change = (energy_residual / h - energy_dv.dot(&eliminated.column(0))) / schur;
    let length = change.most() / h.value.abs();
    // Unbounded if S may be zero.
    let length = if length.is_nan() { f64::INFINITY } else { length };
    Some(SolvedLength { density: schur * Bounded::exact(-4.0), length })
}

/// The rounding error of the first interval of length h, with the place as its midpoint.
pub(super) fn at_start<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>, h: f64) -> f64 {
    let Place { t, q, v, .. } = place;
    let node = Node::new(State { t: t - h / 2.0, q: q - v * (h / 2.0), p: SVector::zeros() }, 0.0);
    let equations = system.extended_system(&node, h, v);
    // The momenta and the energy that satisfy the equations: the energy row is c + v·r.
    let p = equations.momentum.residual;
    let node = Node { p, energy: equations.energy_residual + v.dot(&p), ..node };
    solved(system, &node.map(Bounded::exact), h, v).map_or(f64::INFINITY, |solved| solved.length)
}
