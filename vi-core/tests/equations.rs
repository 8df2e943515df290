//! The systems written by hand: their equations against the slot derivatives, their derivatives against differences.

use crate::systems::{DampedOscillator, ForcedDuffing, Kepler, PumpedPendulum, Steppable, UnitMass};
use vi_core::node::Node;
use vi_core::stepping::EnergyStepping;
use vi_core::{DiscreteLagrangian, Interval, SVector, State};

/// Largest difference between the derivatives of `system` and central differences, and between its equations and the slot
/// derivatives, at one point.
fn largest_difference<const N: usize, P: Steppable<N>>(
    system: &UnitMass<P>,
    q: [f64; N],
    v: [f64; N],
    p: [f64; N],
) -> f64 {
    let (h, energy, small) = (0.3, -0.2, 1e-5);
    let node = Node::new(State { t: 0.4, q: q.into(), p: p.into() }, energy);
    let v = SVector::from(v);
    let at = |h: f64, v: SVector<f64, N>| system.extended_system(&node, h, &v);
    // The energy row, un-combined.
    let e = |h: f64, v: SVector<f64, N>| at(h, v).energy_residual + v.dot(&at(h, v).momentum.residual);
    let r = |h: f64, v: SVector<f64, N>| at(h, v).momentum.residual;
    let here = at(h, v);

    let mut worst = 0.0_f64;
    let mut compare = |found: f64, expected: f64| worst = worst.max((found - expected).abs());
    for j in 0..N {
        let mut step = SVector::<f64, N>::zeros();
        step[j] = small;
        let column = (r(h, v + step) - r(h, v - step)) / (2.0 * small);
        let e_dv = (e(h, v + step) - e(h, v - step)) / (2.0 * small);
        for i in 0..N {
            compare(here.momentum.jacobian[(i, j)], column[i]);
        }
        compare(here.energy_dv[j], (e_dv - v.dot(&column)) / h);
    }
    let r_dh = (r(h + small, v) - r(h - small, v)) / (2.0 * small);
    let e_dh = (e(h + small, v) - e(h - small, v)) / (2.0 * small);
    for i in 0..N {
        compare(here.residual_dh[i], r_dh[i]);
    }
    compare(here.energy_dh, (e_dh - v.dot(&r_dh)) / h);

    let interval = Interval { t0: node.t, q0: node.q, t1: node.t + h, q1: node.q + v * h };
    let slots = -system.d2_ld(&interval) - system.fd_minus(&interval) - node.p;
    let gain = system.extended_residual(&node, h, &v).increment;
    let p1 = system.d4_ld(&interval) + system.fd_plus(&interval);
    for i in 0..N {
        compare(here.momentum.residual[i], slots[i]);
        compare(gain.momentum[i], p1[i] - node.p[i] - slots[i]);
    }
    let e_slots = system.d1_ld(&interval) + system.gd_minus(&interval) - energy;
    compare(e(h, v), e_slots);
    compare(gain.energy, -system.d3_ld(&interval) - system.gd_plus(&interval) - energy - e_slots);
    worst
}

#[test]
fn hand_written_equations_are_those_of_the_rule() {
    // Measured: at most 9.2e-11, the rounding of central differences.
    for (name, difference) in [
        ("oscillator", largest_difference(&UnitMass(DampedOscillator { k: 4.0, c: 0.3 }), [0.7], [-0.4], [0.3])),
        ("duffing", largest_difference(&UnitMass(ForcedDuffing), [0.7], [-0.4], [0.3])),
        ("pumped pendulum", largest_difference(&UnitMass(PumpedPendulum), [0.7], [-0.4], [0.3])),
        ("kepler", largest_difference(&UnitMass(Kepler { mu: 1.0 }), [0.7, -0.5], [-0.4, 0.9], [0.3, 0.2])),
    ] {
        assert!(difference < 2e-10, "{name}: {difference:e}");
    }
}

#[test]
fn the_schur_complement_is_the_step_density() {
    // In the limit h → 0, at the momentum that belongs to v: D = −4 (energy_dh − energy_dv·∂r/∂h).
    let (system, t, q, v) = (UnitMass(Kepler { mu: 1.0 }), 0.0, SVector::from([0.7, -0.5]), SVector::from([-0.4, 0.9]));
    let node = Node::new(State::at(&system, t, q, v), 0.0);
    let equations = system.extended_system(&node, 0.0, &v);
    let density = -4.0 * (equations.energy_dh - equations.energy_dv.dot(&equations.residual_dh));
    // Measured: 0.
    assert!((density - system.step_density(t, &q, &v).unwrap_or(f64::NAN)).abs() < 1e-15);
}
