//! The equations of a step, and steps taken, against the slots.
//!
//! ```text
//! r = −D2 L_d − f_d⁻ − p0        p1 − p0 =  D2 L_d + D4 L_d + f_d⁻ + f_d⁺
//! c = D1 L_d + g_d⁻ − E0 − v·r   E1 − E0 = −D1 L_d − D3 L_d − g_d⁻ − g_d⁺
//! ```
//!
//! and of each step taken `p0 = −D2 L_d − f_d⁻`, `p1 = D4 L_d + f_d⁺`, `E1 = −D3 L_d − g_d⁺`.

use super::comparison::{Comparison, ROUNDING, Scale};
use super::derivatives::{magnitude, node};
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::slots::lost_velocity;
use super::{Checked, Place};
use crate::linear::Matrix;
use crate::{FixedStep, Interval, State};
use nalgebra::SVector;

/// Steps that are taken.
const TAKEN: u32 = 8;

/// Residuals and gains of a step, and `p1, E1` of fixed steps taken, against the slot derivatives.
///
/// # Errors
/// The first number that differs; a step that is not taken; [`CheckFailure::Vacuous`] where momenta or energies are zero
/// throughout.
pub fn steps<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "steps", ROUNDING);
    for sample in samples(system, place, &check)? {
        equations(&sample, &mut check)?;
    }
    let start = State::at(system, place.t, place.q, place.v);
    let mut run = FixedStep::new(system, start, place.h).map_err(|error| check.step(error))?;
    for _ in 0..TAKEN {
        let before = run.state();
        let after = run.step().map_err(|error| check.step(error))?;
        let between = Between::new(system, &before, &after);
        check.vector("p0", &between.momentum_before, &before.p, between.momentum_scale)?;
        check.vector("p1", &after.p, &between.momentum_after, between.momentum_scale)?;
        let energy = run.discrete_energy().unwrap_or(f64::NAN);
        check.number("E1", energy, between.energy_after, between.energy_scale)?;
    }
    check.finish(&["p1", "E1", "residual", "energy residual", "p1 - p0"])
}

fn equations<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (h, node) = (*h, node(sample));
    let interval = Interval { t0: node.t, q0: node.q, t1: node.t + h, q1: node.q + v * h };
    let (found, alone) = (system.extended_system(&node, h, v), system.momentum_equation(&node, h, v));
    let (measured, both) = (system.momentum_residual(&node, h, v), system.extended_residual(&node, h, v));

    let [d2, d4] = [system.d2_ld(&interval), system.d4_ld(&interval)];
    let [fd_minus, fd_plus] = [system.fd_minus(&interval), system.fd_plus(&interval)];
    let row = -d2 - fd_minus - node.p;
    let slack = lost_velocity(&node.q, v, node.t, h) * found.momentum.jacobian.dense().amax();
    let scale = Scale { size: d2.amax() + fd_minus.amax() + node.p.amax(), slack };
    check.vector("residual", &found.momentum.residual, &row, scale)?;
    check.vector("residual alone", &alone.residual, &row, scale)?;
    check.vector("residual measured", &measured.residual, &row, scale)?;
    check.vector("residual measured in both", &both.residual, &row, scale)?;
    let increment = d2 + d4 + fd_minus + fd_plus;
    check.vector("p1 - p0", &measured.increment, &increment, scale)?;
    check.vector("p1 - p0 of both", &both.increment.momentum, &increment, scale)?;

    let energy = system.d1_ld(&interval) + system.gd_minus(&interval) - node.energy;
    let size = sample.scale().size + node.energy.abs() + scale.size * v.abs().sum();
    let scale = Scale { size, slack: sample.scale().slack + slack * v.abs().sum() };
    check.number("energy residual", found.energy_residual, energy - v.dot(&row), scale)?;
    check.number("energy residual measured", both.energy_residual, energy - v.dot(&row), scale)?;
    let wanted = energy + node.energy + system.d3_ld(&interval) + system.gd_plus(&interval);
    check.number("E1 - E0", both.increment.energy, -wanted, scale)
}

/// What the slots say of the step between two states.
pub(super) struct Between<const N: usize> {
    momentum_before: SVector<f64, N>,
    momentum_after: SVector<f64, N>,
    pub(super) energy_after: f64,
    momentum_scale: Scale,
    pub(super) energy_scale: Scale,
}

impl<const N: usize> Between<N> {
    pub(super) fn new<S: Checked<N>>(system: &S, before: &State<N>, after: &State<N>) -> Self {
        let interval = Interval { t0: before.t, q0: before.q, t1: after.t, q1: after.q };
        let h = after.t - before.t;
        let v = (after.q - before.q) / h;
        let slope = system.momentum_equation(&crate::Node::new(*before, 0.0), h, &v).jacobian.dense().amax();
        let slack = lost_velocity(&after.q, &v, after.t, h) * slope;
        let energy_after = -system.d3_ld(&interval) - system.gd_plus(&interval);
        Self {
            momentum_before: -system.d2_ld(&interval) - system.fd_minus(&interval),
            momentum_after: system.d4_ld(&interval) + system.fd_plus(&interval),
            energy_after,
            momentum_scale: Scale { size: before.p.amax() + after.p.amax(), slack },
            energy_scale: Scale { size: magnitude(&after.p, &v) + energy_after.abs(), slack: slack * v.abs().sum() },
        }
    }
}
