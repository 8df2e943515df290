//! Couplings of angles with rational ratios, which hold modulo turns.

use vi_core::motion::Motion as _;
use vi_core::{Gauss, Lagrangian as _, Starts, StepError, lagrangian};

lagrangian! {
    /// Two wheels with 20 and 33 teeth, a torque on one and a pendulum on the other.
    struct Gear {
        const ratio = 33 / 20;
        param torque = 2.0, weight = 4.0;
        angle a, b;
        L = 0.2 * dot(a)^2 / 2 + 1.5 * dot(b)^2 / 2 + weight * cos(b);
        constraint gear = a - ratio * b;
        force a = torque;
    }
}

lagrangian! {
    /// The same with one coordinate: the inertia is that of both, the torque acts by the ratio.
    struct Reduced {
        const ratio = 33 / 20;
        param torque = 2.0, weight = 4.0;
        angle b;
        L = (0.2 * ratio^2 + 1.5) * dot(b)^2 / 2 + weight * cos(b);
        force b = ratio * torque;
    }
}

#[test]
fn a_gear_keeps_its_ratio_over_many_turns() {
    let mut run = Gear::default().at(0.0, [0.0; 2], [0.0; 2]).integrate(Gauss::<3>, 0.01).expect("a start");
    let mut one = Reduced::default().at(0.0, [0.0], [0.0]).integrate(Gauss::<3>, 0.01).expect("a start");
    let (mut worst, mut reaction) = ([0.0_f64; 3], 0.0);
    for _ in 0..3000 {
        let state = run.step().unwrap_or_else(|failure| panic!("{failure}"));
        let right = one.step().expect("a step").q[0];
        worst[0] = worst[0].max((state.q[0] - 1.65 * state.q[1]).abs() / state.q[0].abs().max(1.0));
        worst[1] = worst[1].max((state.q[1] - right).abs() / right.abs().max(1.0));
        // 0.2 a'' = torque + Λ, and b'' is that of the other wheel.
        let v = run.velocity().expect("regular");
        let acceleration = run.system().acceleration(state.t, &state.q, &v).map(|a| a[0]);
        reaction = state.reaction(run.system()).expect("regular")[0];
        let balance = 0.2 * acceleration.unwrap_or(f64::NAN) - 2.0 - reaction;
        worst[2] = worst[2].max(balance.abs());
    }
    println!("{worst:?} {reaction} {:?}", run.turns());
    assert!(run.turns()[1] > 100, "{:?}", run.turns());
    assert!(worst[0] < 1e-14 && worst[1] < 1e-12 && worst[2] < 1e-12, "{worst:?}");
}

#[test]
fn a_gear_holds_modulo_turns_alone() {
    let gear = Gear::default();
    let turn = core::f64::consts::TAU;
    // Turns of a and b by whole turns change the coupling by whole multiples of 2π/20.
    for (turns, teeth) in [([1.0, 0.0], 0.0), ([-2.0, 7.0], 0.0), ([0.0, 0.0], 0.25), ([3.0, 1.0], 0.5)] {
        let q = [1.65 * 0.4 + turns[0] * turn + teeth * turn / 20.0, 0.4 + turns[1] * turn];
        let start = gear.at(0.0, q, [0.0; 2]).integrate(Gauss::<2>, 0.01);
        if teeth == 0.0 {
            // A difference quotient of the value: that of a − ratio b.
            let value = |a: f64, b: f64| gear.constraints(0.0, &[q[0] + a, q[1] + b].into())[0];
            let slopes =
                [value(1e-6, 0.0) - value(-1e-6, 0.0), value(0.0, 1e-6) - value(0.0, -1e-6)].map(|of| of / 2e-6);
            println!("{slopes:?}");
            assert!((slopes[0] - 1.0).abs() < 1e-8 && (slopes[1] + 1.65).abs() < 1e-8, "{slopes:?}");
            assert!(start.is_ok(), "{turns:?} {:?}", start.err());
        } else {
            let failure = start.err();
            let Some(StepError::InconsistentStart { constraint: "gear", residual, .. }) = failure else {
                panic!("{failure:?}")
            };
            assert!((residual.abs() - teeth * turn / 20.0).abs() < 1e-13, "{residual}");
        }
    }
}
