//! Every generated derivative against dual numbers.
//!
//! ```text
//! p = ∂L/∂v      E = v·p − L      d/dt ∂L/∂v = L_q + f      D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)
//! A = ∂r/∂v      ∂r/∂h      (∂e/∂v − v·A)/h = (∂c/∂v + r)/h      (∂e/∂h − v·∂r/∂h)/h = (∂c/∂h)/h
//! ```
//!
//! Left: what the system says. Right: L, and the residuals r and c of a step, differentiated operation by operation.

use super::comparison::{Comparison, ROUNDING};
use super::dual::{along, lift, lift_node, unit};
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::{Checked, Dual, Place};
use crate::linear::Matrix;
use crate::{Lagrangian, Node, State, Stepping};
use nalgebra::SVector;

/// Dual numbers for second derivatives.
type Second = Dual<Dual<f64>>;

/// Momentum, energy, acceleration, step density, and the Jacobians of a step, against dual numbers.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] where momentum, energy or a Jacobian is zero throughout.
pub fn derivatives<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "derivatives", ROUNDING);
    for sample in samples(system, place, &check)? {
        continuous(&sample, &mut check)?;
        jacobians(&sample, &mut check)?;
    }
    check.finish(&["momentum", "energy", "residual_dv"])
}

/// `∂L/∂q`, its rate and that of `∂L/∂t` along the motion (1, v, a), by second-order dual numbers.
fn gradient_and_rates<const N: usize>(
    system: &impl Lagrangian<N, Second>,
    (t, q, v, a): (f64, &SVector<f64, N>, &SVector<f64, N>, &SVector<f64, N>),
) -> (SVector<f64, N>, SVector<f64, N>, f64) {
    let number =
        |value: f64, rate: f64, seed: f64| Second { value: Dual { value, slope: rate }, slope: Dual::fixed(seed) };
    let derivative = |seed_t: f64, seed_q: &SVector<f64, N>| {
        let q = SVector::from_fn(|i, _| number(q[i], v[i], seed_q[i]));
        let v = SVector::from_fn(|i, _| number(v[i], a[i], 0.0));
        system.lagrangian(number(t, 1.0, seed_t), &q, &v).slope
    };
    let each: SVector<Dual<f64>, N> = SVector::from_fn(|index, _| derivative(0.0, &unit(index)));
    (each.map(|entry| entry.value), each.map(|entry| entry.slope), derivative(1.0, &SVector::zeros()).slope)
}

fn continuous<const N: usize, S: Checked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, t, q, v, .. } = sample;
    let (t, dual, second) = (*t, system.convert::<Dual<f64>>(), system.convert::<Second>());
    let momentum = SVector::from_fn(|i, _| dual.lagrangian(Dual::fixed(t), &lift(q), &along(v, &unit(i))).slope);
    check.vector("momentum", &system.momentum(t, q, v), &momentum, 0.0)?;
    let lagrangian = system.lagrangian(t, q, v);
    let energy = v.dot(&momentum) - lagrangian;
    check.number("energy", system.energy(t, q, v), energy, v.dot(&momentum).abs() + lagrangian.abs())?;

    let a = system.acceleration(t, q, v).map_err(|error| check.step(error))?;
    let rate = dual.momentum(Dual::variable(t), &along(q, v), &along(v, &a)).map(|entry| entry.slope);
    let (gradient, gradient_rate, time_rate) = gradient_and_rates(&second, (t, q, v, &a));
    let force = system.force(t, q, v);
    // M a is one of the terms of the rate, and may be large where the terms of the rate cancel.
    let inertial = dual.momentum(Dual::fixed(t), &lift(q), &along(v, &a)).map(|entry| entry.slope);
    let scale = gradient.amax() + force.amax() + inertial.amax();
    check.vector("rate of the momentum", &rate, &(gradient + force), scale)?;
    let density = a.dot(&(gradient + force)) - v.dot(&gradient_rate) - time_rate;
    let scale = magnitude(&a, &gradient) + magnitude(&a, &force) + magnitude(v, &gradient_rate) + time_rate.abs();
    let found = system.step_density(t, q, v).map_err(|error| check.step(error))?;
    check.number("step density", found, density, scale)
}

/// Sum of the absolute values of the terms of a·b.
pub(super) fn magnitude<const N: usize>(a: &SVector<f64, N>, b: &SVector<f64, N>) -> f64 {
    a.abs().dot(&b.abs())
}

/// A node from which `(v, h)` is no solution, so that the residuals are not zero.
pub(super) fn node<const N: usize, S: Checked<N>>(sample: &Sample<S, N>) -> Node<N> {
    let Sample { system, t, q, v, .. } = sample;
    let p = system.momentum(*t, q, &(v * 0.75));
    Node::new(State { t: *t, q: *q, p }, system.energy(*t, q, &(v * 0.5)))
}

fn jacobians<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (h, node, dual) = (*h, node(sample), system.convert::<Dual<f64>>());
    let (found, alone) = (system.extended_system(&node, h, v), system.momentum_equation(&node, h, v));
    let (residual, lifted, rounding) = (found.momentum.residual, lift_node(&node), system.rounding(&node, h, v));
    let (matrix, matrix_alone) = (found.momentum.jacobian.dense(), alone.jacobian.dense());
    let size = rounding.residual.amax() + residual.amax();
    for j in 0..N {
        let column = dual.extended_system(&lifted, Dual::fixed(h), &along(v, &unit(j)));
        let slope = column.momentum.residual.map(|entry| entry.slope);
        check.vector("residual_dv", &matrix.column(j).into_owned(), &slope, 0.0)?;
        check.vector("residual_dv alone", &matrix_alone.column(j).into_owned(), &slope, 0.0)?;
        check.number("energy_dv", found.energy_dv[j], (column.energy_residual.slope + residual[j]) / h, size / h)?;
    }
    let column = dual.extended_system(&lifted, Dual::variable(h), &lift(v));
    check.vector("residual_dh", &found.residual_dh, &column.momentum.residual.map(|entry| entry.slope), size / h)?;
    check.number("energy_dh", found.energy_dh, column.energy_residual.slope / h, rounding.energy_residual / h)?;
    // A row is a sum that loses at least half an ulp of itself.
    let pairs = residual.iter().zip(rounding.residual.iter());
    for (residual, rounding) in pairs.chain([(&found.energy_residual, &rounding.energy_residual)]) {
        check.number("rounding", rounding.max(0.5 * residual.abs()), *rounding, 0.0)?;
    }
    Ok(())
}
