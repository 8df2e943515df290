//! The slots of a Gauss step: they give the state at its ends, and are the derivatives of its discrete Lagrangian.

use crate::gauss::{Everything, System};
use vi_core::gauss::Slots;
use vi_core::nalgebra::SMatrix;
use vi_core::{Gauss, SVector, Starts, State, lagrangian};
use vi_systems::{DampedOscillator, DoublePendulum, Kepler};

lagrangian! {
    /// `Everything` without a force.
    struct Unforced {
        param a = 1.4, w = 1.3;
        coord x, y;
        L = (1 + x^2 / 3) * dot(x)^2 / 2 + a * dot(y)^2 / 2 + x * dot(x) * dot(y) / 5 - cos(w * t) * x * y / 4 - x^2 - y^4 / 4;
        discretize midpoint;
    }
}

/// How far the slots of a step are from the momenta at its nodes.
pub(crate) fn momenta_off<const N: usize>(slots: &Slots<N>, [before, after]: [&State<N>; 2]) -> f64 {
    let momenta = [-slots.d2_ld - slots.fd_minus - before.p, slots.d4_ld + slots.fd_plus - after.p];
    momenta.iter().map(SVector::amax).fold(0.0, f64::max)
}

/// Compares the slots of each step with its nodes, and the sum of the time slots with the power along the step.
fn end_at_the_nodes<const N: usize, const S: usize>(name: &str, system: impl System<N>, q: [f64; N], v: [f64; N]) {
    let start = State::at(&system, 0.3, q, v);
    let mut run = system.at_state(start).integrate(Gauss::<S>, 0.05).expect("a valid start");
    assert_eq!(run.slots(), None, "no step was taken");
    let mut worst = [0.0_f64; 2];
    for _ in 0..20 {
        let before = run.state();
        let after = run.step().expect("a step");
        let slots = run.slots().expect("a step was taken");
        worst[0] = worst[0].max(momenta_off(&slots, [&before, &after]));
        let energy = run.discrete_energy().expect("a step was taken");
        worst[1] = worst[1].max((-slots.d3_ld - slots.gd_plus - energy).abs());
        // E0 of the interval equals H at its start up to the error of the method.
        let excess = slots.d1_ld + slots.gd_minus - before.energy(&system).expect("an energy");
        assert!(excess.abs() < 0.05, "{name}: E0 − H = {excess:e}");
    }
    println!("{name}, {S} stages: momenta off by {:.1e}, energies by {:.1e}", worst[0], worst[1]);
    // Measured: 8.9e-16 and 4.4e-16.
    assert!(worst[0] < 2e-15 && worst[1] < 2e-15, "{name}, {S} stages: {worst:?}");
}

#[test]
fn slots_say_what_the_nodes_are() {
    let everything = Everything::default();
    end_at_the_nodes::<2, 1>("everything", everything, [0.4, -0.3], [0.2, 0.7]);
    end_at_the_nodes::<2, 2>("everything", everything, [0.4, -0.3], [0.2, 0.7]);
    end_at_the_nodes::<2, 5>("everything", everything, [0.4, -0.3], [0.2, 0.7]);
    end_at_the_nodes::<1, 3>("damped oscillator", DampedOscillator::default(), [0.5], [2.0]);
    end_at_the_nodes::<2, 4>("Kepler", Kepler::default(), [0.4, 0.0], [0.0, 2.0]);
    end_at_the_nodes::<2, 4>("double pendulum", DoublePendulum::default(), [1.2, 0.5], [0.0, 0.3]);
}

/// The slots of the step from (t0, q0) to (t1, q1), with its momentum p0 from Newton iteration.
fn between<const S: usize>(system: impl System<2>, ends: &[[f64; 3]; 2], near: SVector<f64, 2>) -> Slots<2> {
    let [[t, x, y], [end, x1, y1]] = *ends;
    let step = |p: SVector<f64, 2>| {
        let mut run =
            system.at_state(State { t, q: [x, y].into(), p }).integrate(Gauss::<S>, end - t).expect("a valid start");
        let reached = run.step().expect("a step");
        (reached.q - SVector::from([x1, y1]), run.slots().expect("a step was taken"))
    };
    let mut p = near;
    for _ in 0..8 {
        let (missed, _) = step(p);
        let slopes = SMatrix::<f64, 2, 2>::from_columns(&[0, 1].map(|k| {
            let mut moved = p;
            moved[k] += 1e-6;
            (step(moved).0 - missed) / 1e-6
        }));
        p -= slopes.try_inverse().expect("a regular step") * missed;
    }
    let (missed, slots) = step(p);
    assert!(missed.amax() < 1e-15, "the step ends elsewhere: {missed}");
    slots
}

/// The slots against central differences of L_d with respect to each argument, of fourth order.
fn are_derivatives<const S: usize>(system: impl System<2>) {
    let start = State::at(&system, 0.3, [0.4, -0.3], [0.2, 0.7]);
    let h = 0.4;
    let reached = system.at_state(start).integrate(Gauss::<S>, h).expect("a valid start").step().expect("a step");
    let ends = [[start.t, start.q[0], start.q[1]], [reached.t, reached.q[0], reached.q[1]]];
    let at = between::<S>(system, &ends, start.p);
    let slots = [[at.d1_ld, at.d2_ld[0], at.d2_ld[1]], [at.d3_ld, at.d4_ld[0], at.d4_ld[1]]];
    let mut worst = 0.0_f64;
    for end in 0..2 {
        for argument in 0..3 {
            let moved = |by: f64| {
                let mut ends = ends;
                ends[end][argument] += by;
                between::<S>(system, &ends, start.p).ld
            };
            let d = 5e-4;
            let difference = (8.0 * (moved(d) - moved(-d)) - (moved(2.0 * d) - moved(-2.0 * d))) / (12.0 * d);
            assert!(slots[end][argument].abs() > 0.01, "a slot that is zero proves nothing");
            worst = worst.max((difference - slots[end][argument]).abs());
        }
    }
    println!("{S} stages: slots and differences of L_d differ by {worst:.1e}");
    // Measured: 3.5e-12.
    assert!(worst < 1e-11, "{S} stages: {worst:e}");
}

#[test]
fn slots_are_the_derivatives_of_the_discrete_lagrangian() {
    let unforced = Unforced::default();
    are_derivatives::<1>(unforced);
    are_derivatives::<2>(unforced);
    are_derivatives::<4>(unforced);
}
