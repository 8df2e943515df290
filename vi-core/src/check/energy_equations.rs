//! The equations of an energy-preserving step, in the rows that a fixed step does not have.
//!
//! ```text
//! c = D1 L_d + g_d⁻ − E0 − v·r   E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺
//! ∂r/∂h      (∂e/∂v − v·A)/h = (∂c/∂v + r)/h      (∂e/∂h − v·∂r/∂h)/h = (∂c/∂h)/h
//! ```
//!
//! and the derivatives of both rows, p1 − p0 and E1 − E0 with respect to q0, v and h. Left sides: generated code. Right
//! sides: the slots, and automatic differentiation of r and c. The generated r, A and p1 − p0 must agree with those of
//! a fixed step. Tolerance: as in `derivatives`, the rounding-error bounds of both sides.

use super::bounded::{Bounded, exact, vector_of};
use super::comparison::Comparison;
use super::derivatives::{First, columns, density, enough, matrix};
use super::report::{CheckFailure, Report};
use super::sample::{Sample, step_samples};
use super::steps::ends;
use super::subject::{EnergyChecked, Place};
use crate::discrete::DiscreteLagrangian;
use crate::node::Node;
use crate::real::dual::{Dual, along, lift, slopes, unit};
use crate::stepping::{EnergyStepping, ExtendedResidual, FixedStepping};
use core::array;
use nalgebra::SVector;

/// Tests the step density and the derivatives of the energy row against dual numbers. Tests the energy row and its
/// increments against the slots, and the momentum rows against those of a fixed step.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] if the energy row is zero throughout.
pub fn energy_equations<const N: usize, S: EnergyChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "energy equations");
    for sample in step_samples(system, place, &check)? {
        rows(&sample, &mut check)?;
        derivatives(&sample, &mut check)?;
        step_density(&sample, &mut check)?;
    }
    check.finish(&["energy residual", "momentum rows"])
}

/// Tests the step density against that of L and the acceleration.
fn step_density<const N: usize, S: EnergyChecked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, t, q, v, .. } = sample;
    let (found, bounded) = (system.step_density(*t, q, v), system.steps::<Bounded>());
    let bound = bounded.step_density(Bounded::exact(*t), &exact(q), &exact(v));
    let [found, bound] = [found.map(Bounded::exact), bound].map(|number| number.map_err(|error| check.step(error)));
    let wanted = density(sample, check)?;
    check.number("step density", bound?.of(found?.value), wanted)
}

fn rows<const N: usize, S: EnergyChecked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (node, bounded) = (sample.node(), system.steps::<Bounded>());
    let (known, step, velocity) = (node.map(Bounded::exact), Bounded::exact(*h), exact(v));
    let (found, measured) = (system.extended_system(&node, *h, v), system.extended_residual(&node, *h, v));
    let again = bounded.extended_residual(&known, step, &velocity);
    let (row, increment) = (vector_of(&found.momentum.residual, &again.residual), again.increment.momentum);
    let alone = bounded.momentum_residual(&known, step, &velocity);
    check.vector("momentum rows", &row, &alone.residual)?;
    check.vector("momentum rows measured", &vector_of(&measured.residual, &again.residual), &alone.residual)?;
    check.vector("p1 - p0", &vector_of(&measured.increment.momentum, &increment), &alone.increment)?;

    let interval = ends(&known, step, &velocity);
    let row = -bounded.d2_ld(&interval) - bounded.fd_minus(&interval) - known.p;
    let minus = bounded.d1_ld(&interval) + bounded.gd_minus(&interval);
    let plus = bounded.d3_ld(&interval) + bounded.gd_plus(&interval);
    let wanted = minus - known.energy - velocity.dot(&row);
    check.number("energy residual", again.energy_residual.of(found.energy_residual), wanted)?;
    check.number("energy residual measured", again.energy_residual.of(measured.energy_residual), wanted)?;
    check.number("E1 - E0", again.increment.energy.of(measured.increment.energy), -(minus + plus))?;
    let rounding = system.extended_rounding(&node, *h, v);
    let pairs = found.momentum.residual.iter().zip(rounding.residual.iter());
    let all = pairs.chain([(&found.energy_residual, &rounding.energy_residual)]);
    all.into_iter().try_for_each(|(residual, rounding)| enough(*residual, *rounding, check))
}

fn derivatives<const N: usize, S: EnergyChecked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (node, bounded, dual) = (sample.node(), system.steps::<Bounded>(), system.steps::<First>());
    let known = node.map(Bounded::exact);
    let lifted = known.map(Dual::fixed);
    let (step, velocity) = (Bounded::exact(*h), exact(v));
    let after =
        |q: SVector<First, N>, h: First, v: &SVector<First, N>| dual.extended_residual(&Node { q, ..lifted }, h, v);
    let by_q = array::from_fn(|j| after(along(&known.q, &unit(j)), Dual::fixed(step), &lift(&velocity)));
    let by_v = array::from_fn(|j| after(lifted.q, Dual::fixed(step), &along(&velocity, &unit(j))));
    let by_h = after(lifted.q, Dual::variable(step), &lift(&velocity));
    let [residual_dq, residual_dv] = [&by_q, &by_v].map(|by| columns(by, |rows| rows.residual));
    let [increment_dq, increment_dv] = [&by_q, &by_v].map(|by| columns(by, |rows| rows.increment.momentum));
    let residual_dh = slopes(&by_h.residual);
    let row = bounded.extended_residual(&known, step, &velocity).residual;
    let energy = |by: &[ExtendedResidual<N, First>; N]| SVector::from_fn(|j, _| by[j].energy_residual.slope);
    let energy_dq = energy(&by_q);
    let energy_dv = (energy(&by_v) + row).map(|entry| entry / step);
    let energy_dh = by_h.energy_residual.slope / step;
    let gain = |by: &[ExtendedResidual<N, First>; N]| SVector::from_fn(|j, _| by[j].increment.energy.slope);

    let found = system.extended_system(&node, *h, v);
    let again = bounded.extended_system(&known, step, &velocity);
    matrix(check, "jacobian", (&found.momentum.jacobian, &again.momentum.jacobian), &residual_dv)?;
    check.vector("residual_dh", &vector_of(&found.residual_dh, &again.residual_dh), &residual_dh)?;
    check.vector("energy_dv", &vector_of(&found.energy_dv, &again.energy_dv), &energy_dv)?;
    check.number("energy_dh", again.energy_dh.of(found.energy_dh), energy_dh)?;

    let found = system.extended_derivatives(&node, *h, v);
    let again = bounded.extended_derivatives(&known, step, &velocity);
    let (of, bounds) = (&found.momentum, &again.momentum);
    matrix(check, "residual_dq", (&of.residual_dq, &bounds.residual_dq), &residual_dq)?;
    matrix(check, "residual_dv", (&of.residual_dv, &bounds.residual_dv), &residual_dv)?;
    matrix(check, "increment_dq", (&of.increment_dq, &bounds.increment_dq), &increment_dq)?;
    matrix(check, "increment_dv", (&of.increment_dv, &bounds.increment_dv), &increment_dv)?;
    check.vector("residual_dh", &vector_of(&found.residual_dh, &again.residual_dh), &residual_dh)?;
    let increment_dh = vector_of(&found.increment_dh, &again.increment_dh);
    check.vector("increment_dh", &increment_dh, &slopes(&by_h.increment.momentum))?;
    check.vector("energy_dq", &vector_of(&found.energy_dq, &again.energy_dq), &energy_dq)?;
    check.vector("energy_dv", &vector_of(&found.energy_dv, &again.energy_dv), &energy_dv)?;
    check.number("energy_dh", again.energy_dh.of(found.energy_dh), energy_dh)?;
    let of_energy = vector_of(&found.energy_increment_dq, &again.energy_increment_dq);
    check.vector("energy_increment_dq", &of_energy, &gain(&by_q))?;
    let of_energy = vector_of(&found.energy_increment_dv, &again.energy_increment_dv);
    check.vector("energy_increment_dv", &of_energy, &gain(&by_v))?;
    let of_energy = again.energy_increment_dh.of(found.energy_increment_dh);
    check.number("energy_increment_dh", of_energy, by_h.increment.energy.slope)
}
