//! States and parameters at the ends of what numbers can tell: each gives a step, or an error that names what is wrong.

use vi_core::{EnergyPreserving, FixedStep, SVector, State, StepError, lagrangian};
use vi_systems::{HarmonicOscillator, Pendulum};

#[test]
fn a_step_that_is_subnormal_is_refused() {
    let system = HarmonicOscillator::default();
    let start = State::at(&system, 0.0, [1.0], [0.5]);
    for h in [1e-310, -1e-310, f64::from_bits(1), 0.0, f64::NAN, f64::INFINITY] {
        let refused = FixedStep::new(system, start, h).map(|run| run.v());
        assert!(matches!(refused, Err(StepError::InvalidInput { input: "the step h", .. })), "{h:e}: {refused:?}");
    }
    let mut run = FixedStep::new(system, start, f64::MIN_POSITIVE).expect("the smallest step");
    let state = run.step().expect("a step");
    assert_eq!((state.t, state.q[0], run.v()[0]), (f64::MIN_POSITIVE, 1.0, 0.5));
}

#[test]
fn without_a_mass_there_is_no_step() {
    // A pendulum of no length has no mass matrix, whether it moves or rests.
    let system = Pendulum { l: 0.0, ..Pendulum::default() };
    for v in [0.0, 1.0] {
        let start = State { t: 0.0, q: SVector::from([0.3]), p: SVector::from([0.0]) };
        assert!(matches!(start.velocity(&system), Err(StepError::Singular { .. })), "{v}");
        let fixed = FixedStep::new(system, State::at(&system, 0.0, [0.3], [v]), 0.01).map(|run| run.state());
        assert!(matches!(fixed, Err(StepError::Singular { .. })), "{fixed:?}");
        let both = EnergyPreserving::from_midpoint(system, 0.0, [0.3], [v], 0.01).map(|run| run.state());
        assert!(matches!(both, Err(StepError::Singular { .. })), "{both:?}");
    }
}

#[test]
fn what_is_below_an_ulp_is_not_lost() {
    // An ulp of q is 16384: for ten million steps the particle stands still, and then it has moved.
    let system = Free { m: 1.5 };
    let (q, v, h) = (1e20_f64, 1.0_f64, 0.01_f64);
    let mut run = FixedStep::new(system, State::at(&system, 0.0, [q], [v]), h).expect("a start");
    run.step().expect("a step");
    let node = *run.node();
    assert_eq!((node.q[0], node.q_low[0]), (q, v * h));
    for _ in 1..1000 {
        run.step().expect("a step");
    }
    assert_eq!(run.state().q[0], q);
    // A thousand products were rounded, and as many sums of them.
    let low = run.node().q_low[0];
    assert!((low - 10.0_f64).abs() < 1e-11, "{low}");
}

lagrangian! {
    /// Nothing acts.
    struct Free {
        param m = 1.0;
        coord x;
        L = m * dot(x)^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two masses that pull at each other: in the units √m x and √n y the motion is the same for all of them.
    struct Unequal {
        param m = 1.0, n = 1.0, k = 1.3;
        coord x, y;
        let u = sqrt(m) * x, w = sqrt(n) * y;
        L = m * dot(x)^2 / 2 + n * dot(y)^2 / 2 + 0.3 * sqrt(m * n) * dot(x) * dot(y) - k * (u - w)^2 / 2 - (u^4 + w^4) / 4;
        discretize midpoint;
    }
}

lagrangian! {
    /// A mass that is nearly nothing where x is small.
    struct Thin {
        coord x;
        L = exp(-30 / x) * dot(x)^2 / 2 - exp(-30 / x) * x;
        discretize midpoint;
    }
}

/// Where fixed steps from the same place in these units lead, in these units.
fn reached(m: f64, n: f64) -> SVector<f64, 2> {
    let system = Unequal { m, n, ..Unequal::default() };
    let units = SVector::from([m.sqrt(), n.sqrt()]);
    let [q, v] = [[0.7, 0.4], [0.1, -0.3]].map(|start| SVector::from(start).component_div(&units));
    let mut run = FixedStep::new(system, State::at(&system, 0.0, q, v), 0.01).expect("a regular system");
    for _ in 0..1000 {
        run.step().expect("a step");
    }
    run.state().q.component_mul(&units)
}

#[test]
fn masses_of_any_units_make_a_regular_system() {
    let wanted = reached(1.0, 1.0);
    for (m, n) in [(1.0, 1e-12), (1e30, 1e-30), (1e-30, 1e30), (1e-100, 1.0)] {
        let off = (reached(m, n) - wanted).amax();
        // Measured: 2.2e-16.
        assert!(off < 1e-14, "{m:e}, {n:e}: {off:e}");
    }
    // The mass of e^(−30/x) drops out but for its slope: a = −1 − 30/x − 15 v²/x², whatever it is; from x = 1/20 it is e^−600.
    for x in [1.0, 0.05] {
        let system = Thin::default();
        let mut run = FixedStep::new(system, State::at(&system, 0.0, [x], [0.0]), 1e-7).expect("a regular system");
        for _ in 0..100 {
            run.step().expect("a step");
        }
        let (t, v) = (run.state().t, run.v()[0]);
        let wanted = -(1.0 + 30.0 / x) * (t - 0.5e-7);
        // Measured: 1.2e-4, where v²/x² adds its part.
        assert!((v / wanted - 1.0).abs() < 2e-4, "{v:e}, {wanted:e}");
    }
}
