//! The equations of a step, and steps taken, against the slots.
//!
//! ```text
//! r = −D2 L_d − f_d⁻ − p0        p1 − p0 =  D2 L_d + D4 L_d + f_d⁻ + f_d⁺
//! c = D1 L_d + g_d⁻ − E0 − v·r   E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺
//! ```
//!
//! and of each step taken `p0 = −D2 L_d − f_d⁻`, `p1 = D4 L_d + f_d⁺`, `E1 = −D3 L_d − g_d⁺`.
//!
//! Rounding: as in `derivatives`, that of both sides, carried along. The ends of a step that was taken are known to one
//! rounding each, so that v made of them, `(q1 − q0)/h`, and with it D2 and D4, carry `ε |q|/h`; and the equations that were
//! solved for it may leave [`SOLVED`] roundings of their terms.

use super::bounded::{Bounded, exact, vector_of};
use super::comparison::Comparison;
use super::derivatives::carried;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::slots::between;
use super::{Checked, Place};
use crate::{DiscreteLagrangian, FixedStep, Interval, Node, Rounding, State, Stepping};
use nalgebra::SVector;

/// Steps that are taken.
const TAKEN: u32 = 8;
/// Bounds of its rounding that a solved equation may leave: the steppers promise 4 roundings, and what is carried adds some.
const SOLVED: f64 = 16.0;

/// Residuals and gains of a step, and `p1, E1` of fixed steps taken, against the slot derivatives.
///
/// # Errors
/// The first number that differs; a step that is not taken; [`CheckFailure::Vacuous`] where momenta or energies are zero
/// throughout.
pub fn steps<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "steps");
    for sample in samples(system, place, &check)? {
        equations(&sample, &mut check)?;
    }
    let start = State::at(system, place.t, place.q, place.v);
    let mut run = FixedStep::new(system, start, place.h).map_err(|error| check.step(error))?;
    for _ in 0..TAKEN {
        let before = run.state();
        let after = run.step().map_err(|error| check.step(error))?;
        let slots = Slots::between(system, &before, &after);
        let left = solved(system, &before, place.h, &run.v());
        let known = |p: &SVector<f64, N>| p.zip_map(&left.residual, |p, left| Bounded { value: p, error: left });
        check.vector("p0", &slots.momentum_before, &known(&before.p))?;
        check.vector("p1", &known(&after.p), &slots.momentum_after)?;
        let energy = run.discrete_energy().unwrap_or(f64::NAN);
        let left = left.energy_residual + run.v().abs().dot(&left.residual);
        check.number("E1", Bounded { value: energy, error: left }, slots.energy_after)?;
    }
    check.finish(&["p1", "E1", "residual", "energy residual", "p1 - p0"])
}

fn equations<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (node, bounded) = (sample.node(), system.convert::<Bounded>());
    let (known, step, velocity) = (carried(&node, Bounded::exact), Bounded::exact(*h), exact(v));
    let (found, alone) = (system.extended_system(&node, *h, v), system.momentum_equation(&node, *h, v));
    let (measured, both) = (system.momentum_residual(&node, *h, v), system.extended_residual(&node, *h, v));
    let again = bounded.extended_residual(&known, step, &velocity);

    let q1 = known.q + velocity.map(|v| v * step);
    let interval = Interval { t0: known.t, q0: known.q, t1: known.t + step, q1 };
    let [d2, d4] = [bounded.d2_ld(&interval), bounded.d4_ld(&interval)];
    let [fd_minus, fd_plus] = [bounded.fd_minus(&interval), bounded.fd_plus(&interval)];
    let row = -d2 - fd_minus - known.p;
    check.vector("residual", &vector_of(&found.momentum.residual, &again.residual), &row)?;
    check.vector("residual alone", &vector_of(&alone.residual, &again.residual), &row)?;
    check.vector("residual measured", &vector_of(&measured.residual, &again.residual), &row)?;
    check.vector("residual measured with energy", &vector_of(&both.residual, &again.residual), &row)?;
    let (wanted, bound) = (d2 + d4 + fd_minus + fd_plus, again.increment.momentum);
    check.vector("p1 - p0", &vector_of(&measured.increment, &bound), &wanted)?;
    check.vector("p1 - p0 with energy", &vector_of(&both.increment.momentum, &bound), &wanted)?;

    let [minus, plus] =
        [bounded.d1_ld(&interval) + bounded.gd_minus(&interval), bounded.d3_ld(&interval) + bounded.gd_plus(&interval)];
    let wanted = minus - known.energy - velocity.dot(&row);
    check.number("energy residual", again.energy_residual.of(found.energy_residual), wanted)?;
    check.number("energy residual measured", again.energy_residual.of(both.energy_residual), wanted)?;
    check.number("E1 - E0", again.increment.energy.of(both.increment.energy), -(minus + plus))
}

/// What the equations of a solved step may leave, and its end may miss by, for the rounding of its start.
pub(super) fn solved<const N: usize, S: Checked<N>>(
    system: &S,
    before: &State<N>,
    h: f64,
    v: &SVector<f64, N>,
) -> Rounding<N> {
    let Rounding { residual, energy_residual } = system.rounding(&Node::new(*before, 0.0), h, v);
    let rounding = SOLVED * f64::EPSILON;
    Rounding { residual: residual * rounding, energy_residual: energy_residual * rounding }
}

/// What the slots say of the step between two states.
pub(super) struct Slots<const N: usize> {
    momentum_before: SVector<Bounded, N>,
    momentum_after: SVector<Bounded, N>,
    pub(super) energy_after: Bounded,
}

impl<const N: usize> Slots<N> {
    pub(super) fn between<S: Checked<N>>(system: &S, before: &State<N>, after: &State<N>) -> Self {
        let bounded = system.convert::<Bounded>();
        let ends = Interval { t0: before.t, q0: before.q, t1: after.t, q1: after.q };
        let interval = between(&ends, Bounded::once);
        Self {
            momentum_before: -bounded.d2_ld(&interval) - bounded.fd_minus(&interval),
            momentum_after: bounded.d4_ld(&interval) + bounded.fd_plus(&interval),
            energy_after: -bounded.d3_ld(&interval) - bounded.gd_plus(&interval),
        }
    }
}
