//! The equations of a step, and actual steps, against the slots.
//!
//! ```text
//! r = −D2 L_d − f_d⁻ − p0        p1 − p0 = D2 L_d + D4 L_d + f_d⁻ + f_d⁺        E1 = −D3 L_d − g_d⁺
//! ```
//!
//! and for each actual step `p0 = −D2 L_d − f_d⁻`, `p1 = D4 L_d + f_d⁺`, `E1 = −D3 L_d − g_d⁺`.
//!
//! Tolerance: as in `derivatives`, the rounding-error bounds of both sides. The ends of an actual step have one
//! rounding each, so that v = `(q1 − q0)/h`, and with it D2 and D4, have the error `ε |q|/h`. The solved equations have
//! residuals of up to [`SOLVED`] roundings.

use super::bounded::{Bounded, exact, vector_of};
use super::comparison::Comparison;
use super::derivatives::{First, columns, enough, matrix};
use super::report::{CheckFailure, Report};
use super::sample::{Sample, step_samples};
use super::slots::between;
use super::subject::{Checked, Place};
use crate::discrete::DiscreteLagrangian;
use crate::method::FixedStep;
use crate::node::Node;
use crate::real::dual::{Dual, along, lift, unit};
use crate::run::Starts;
use crate::state::{Interval, State};
use crate::stepping::FixedStepping;
use core::array;
use nalgebra::SVector;

/// Number of actual steps.
const TAKEN: u32 = 8;
/// Allowed residual of a solved equation, in roundings: the steppers guarantee 4, and carried remainders add some.
pub(super) const SOLVED: f64 = 16.0;

/// Tests residual and increments of a step, and `p1, E1` of actual fixed steps, against the slot derivatives.
///
/// # Errors
/// The first number that differs; a failed step; [`CheckFailure::Vacuous`] if momenta or energies are zero throughout.
pub fn steps<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "steps");
    for sample in step_samples(system, place, &check)? {
        equations(&sample, &mut check)?;
        derivatives(&sample, &mut check)?;
    }
    let start = State::at(system, place.t, place.q, place.v);
    let mut run = system.at_state(start).integrate(FixedStep, place.h).map_err(|error| check.step(error))?;
    for _ in 0..TAKEN {
        let before = run.state();
        let after = run.step().map_err(|error| check.step(error))?;
        let slots = SlotValues::between(system, &before, &after);
        let (node, v) = (Node::new(before, 0.0), run.v());
        let left = system.momentum_rounding(&node, place.h, &v) * (SOLVED * f64::EPSILON);
        let known = |p: &SVector<f64, N>| p.zip_map(&left, |p, left| Bounded { value: p, error: left });
        check.vector("p0", &slots.momentum_before, &known(&before.p))?;
        check.vector("p1", &known(&after.p), &slots.momentum_after)?;
        let known = node.map(Bounded::nearest);
        let energy = system.steps::<Bounded>().discrete_energy(&known, Bounded::exact(place.h), &exact(&v));
        check.number("E1", energy.of(run.discrete_energy().unwrap_or(f64::NAN)), slots.energy_after)?;
    }
    check.finish(&["p1", "E1", "residual", "discrete energy", "p1 - p0", "jacobian"])
}

fn equations<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (node, bounded) = (sample.node(), system.steps::<Bounded>());
    let (known, step, velocity) = (node.map(Bounded::exact), Bounded::exact(*h), exact(v));
    let (found, measured) = (system.momentum_equation(&node, *h, v), system.momentum_residual(&node, *h, v));
    let again = bounded.momentum_residual(&known, step, &velocity);
    let interval = ends(&known, step, &velocity);
    let [d2, d4] = [bounded.d2_ld(&interval), bounded.d4_ld(&interval)];
    let [fd_minus, fd_plus] = [bounded.fd_minus(&interval), bounded.fd_plus(&interval)];
    let row = -d2 - fd_minus - known.p;
    check.vector("residual", &vector_of(&found.residual, &again.residual), &row)?;
    check.vector("residual measured", &vector_of(&measured.residual, &again.residual), &row)?;
    let wanted = d2 + d4 + fd_minus + fd_plus;
    check.vector("p1 - p0", &vector_of(&measured.increment, &again.increment), &wanted)?;
    let energy = bounded.discrete_energy(&known, step, &velocity).of(system.discrete_energy(&node, *h, v));
    check.number("discrete energy", energy, -bounded.d3_ld(&interval) - bounded.gd_plus(&interval))
}

/// Tests the derivatives of residual and increment against dual numbers.
fn derivatives<const N: usize, S: Checked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (node, bounded, dual) = (sample.node(), system.steps::<Bounded>(), system.steps::<First>());
    let known = node.map(Bounded::exact);
    let lifted = known.map(Dual::fixed);
    let (step, velocity) = (Bounded::exact(*h), exact(v));
    let after = |q: SVector<First, N>, v: &SVector<First, N>| {
        dual.momentum_residual(&Node { q, ..lifted }, Dual::fixed(step), v)
    };
    let by_q = array::from_fn(|j| after(along(&known.q, &unit(j)), &lift(&velocity)));
    let by_v = array::from_fn(|j| after(lifted.q, &along(&velocity, &unit(j))));
    let [residual_dq, residual_dv] = [&by_q, &by_v].map(|by| columns(by, |row| row.residual));
    let [increment_dq, increment_dv] = [&by_q, &by_v].map(|by| columns(by, |row| row.increment));

    let equation = system.momentum_equation(&node, *h, v);
    let again = bounded.momentum_equation(&known, step, &velocity);
    matrix(check, "jacobian", (&equation.jacobian, &again.jacobian), &residual_dv)?;
    let rounding = system.momentum_rounding(&node, *h, v);
    let mut rows = equation.residual.iter().zip(rounding.iter());
    rows.try_for_each(|(residual, rounding)| enough(*residual, *rounding, check))?;

    let found = system.momentum_derivatives(&node, *h, v);
    let again = bounded.momentum_derivatives(&known, step, &velocity);
    matrix(check, "residual_dq", (&found.residual_dq, &again.residual_dq), &residual_dq)?;
    matrix(check, "residual_dv", (&found.residual_dv, &again.residual_dv), &residual_dv)?;
    matrix(check, "increment_dq", (&found.increment_dq, &again.increment_dq), &increment_dq)?;
    matrix(check, "increment_dv", (&found.increment_dv, &again.increment_dv), &increment_dv)
}

/// The interval of the step `(v, h)` from a node.
pub(super) fn ends<const N: usize>(
    node: &Node<N, Bounded>,
    h: Bounded,
    v: &SVector<Bounded, N>,
) -> Interval<N, Bounded> {
    Interval { t0: node.t, q0: node.q, t1: node.t + h, q1: node.q + v * h }
}

/// Slot values of the step between two states.
pub(super) struct SlotValues<const N: usize> {
    momentum_before: SVector<Bounded, N>,
    momentum_after: SVector<Bounded, N>,
    pub(super) energy_after: Bounded,
}

impl<const N: usize> SlotValues<N> {
    pub(super) fn between<S: Checked<N>>(system: &S, before: &State<N>, after: &State<N>) -> Self {
        let bounded = system.steps::<Bounded>();
        let ends = Interval { t0: before.t, q0: before.q, t1: after.t, q1: after.q };
        let interval = between(&ends, Bounded::nearest);
        Self {
            momentum_before: -bounded.d2_ld(&interval) - bounded.fd_minus(&interval),
            momentum_after: bounded.d4_ld(&interval) + bounded.fd_plus(&interval),
            energy_after: -bounded.d3_ld(&interval) - bounded.gd_plus(&interval),
        }
    }
}
