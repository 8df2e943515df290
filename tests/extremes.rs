//! States and parameters at the limits of double precision: each gives a step, or an error that names the cause.

use vi_core::motion::Motion;
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_core::{
    EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, Lagrangian, Run, SVector, Starts, State,
    StepError, lagrangian, run::Checkpoint,
};
use vi_systems::{HarmonicOscillator, Pendulum};

#[test]
fn a_step_that_is_subnormal_is_refused() {
    let system = HarmonicOscillator::default();
    let start = State::at(&system, 0.0, [1.0], [0.5]);
    for h in [1e-310, -1e-310, f64::from_bits(1), 0.0, f64::NAN, f64::INFINITY] {
        let refused = system.at_state(start).integrate(FixedStep, h).map(|run| run.v());
        assert!(matches!(refused, Err(StepError::InvalidInput { input: "the step h", .. })), "{h:e}: {refused:?}");
    }
    let mut run = system.at_state(start).integrate(FixedStep, f64::MIN_POSITIVE).expect("the smallest step");
    let state = run.step().expect("a step");
    assert_eq!((state.t, state.q[0], run.v()[0]), (f64::MIN_POSITIVE, 1.0, 0.5));
}

#[test]
fn an_angle_without_digits_is_no_step() {
    for g in [1e17, 1e20, 1e50, 1e100, 1e200, 1e300] {
        // Cold stages, and those of a slow pendulum. The squares of the linearization overflow above 1e154.
        let strong = Pendulum { g, ..Pendulum::default() };
        let cold = strong.at(0.0, [1.0], [0.0]).integrate(Gauss::<8>, 0.05).expect("a start").step();
        let mut run = Pendulum::default().at(0.0, [1.0], [0.0]).integrate(Gauss::<8>, 0.05).expect("a start");
        run.step().expect("a step");
        run.set_parameters(|system| system.g = g).expect("parameters");
        let (state, warm) = (run.state(), run.step());
        for outcome in [cold, warm] {
            assert!(matches!(outcome, Err(StepError::StagesNotConverged { .. })), "g = {g:e}: {outcome:?}");
        }
        assert_eq!(run.state(), state);
    }
}

#[test]
fn without_a_mass_there_is_no_step() {
    // A pendulum of zero length has a singular mass matrix, moving or at rest.
    let system = Pendulum { l: 0.0, ..Pendulum::default() };
    for v in [0.0, 1.0] {
        let start = State { t: 0.0, q: SVector::from([0.3]), p: SVector::from([0.0]) };
        assert!(matches!(start.velocity(&system), Err(StepError::Singular { .. })), "{v}");
        let fixed = system.at(0.0, [0.3], [v]).integrate(FixedStep, 0.01).map(|run| run.state());
        assert!(matches!(fixed, Err(StepError::Singular { .. })), "{fixed:?}");
        let both = EnergyPreserving::from_midpoint(system, 0.0, [0.3], [v], 0.01).map(|run| run.state());
        assert!(matches!(both, Err(StepError::Singular { .. })), "{both:?}");
    }
}

/// Systems whose mass matrix is the unit matrix, and whose potential has no finite slope at the origin.
macro_rules! slopeless {
    ($($name:ident($($coordinate:ident),+): $potential:expr;)+) => {
        $(lagrangian! {
            struct $name { coord $($coordinate),+; L = ($(dot($coordinate)^2 +)+ 0) / 2 - $potential; discretize midpoint; }
        })+

        #[test]
        fn a_nonfinite_slope_is_not_reported_as_a_singular_mass_matrix() {
            $(loses_its_slope($name::default());)+
        }
    };
}

slopeless! {
    Inverse(x): 1 / x;
    Root(x): sqrt(x);
    Logarithm(x): ln(x);
    Distance(x, y): hypot(x, y);
    Angle(x, y): atan2(x, y);
}

/// Asserts that every function is not finite at the origin, so that no shorter step helps.
fn loses_its_slope<S, const N: usize>(system: S)
where
    S: Motion<N> + Convertible<N> + EnergyStepping<N> + core::fmt::Debug,
{
    let zero = SVector::zeros();
    let start = State { t: 0.0, q: zero, p: zero };
    let outcomes = [
        system.acceleration(0.0, &zero, &zero).err(),
        system.step_density(0.0, &zero, &zero).err(),
        system.at_state(start).integrate(Gauss::<4>, 0.01).and_then(|mut run| run.step()).err(),
        system.at_state(start).integrate(EnergyPreservingGauss::<2>, 0.01).and_then(|mut run| run.step()).err(),
    ];
    let are_lost = outcomes.iter().all(|error| matches!(error, Some(StepError::NonFinite { .. })));
    assert!(are_lost, "{system:?}: {outcomes:?}");
}

lagrangian! {
    /// A force whose slope is not finite at x = 0.
    struct Kinked {
        coord x;
        L = dot(x)^2 / 2 - x^(3/2);
        discretize midpoint;
    }
}

#[test]
fn a_lost_step_density_is_reported() {
    // The acceleration is finite, and its slope is not.
    let (zero, slow) = (SVector::from([0.0]), SVector::from([1.0]));
    let density = Kinked::default().step_density(0.0, &zero, &slow);
    assert!(matches!(density, Err(StepError::NonFinite { quantity: "step density", .. })), "{density:?}");
    assert_eq!(Kinked::default().acceleration(0.0, &zero, &slow), Ok(zero));
}

#[test]
fn increments_below_an_ulp_are_carried() {
    // An ulp of q is 16384: the particle stays for ten million steps, and then moves.
    let system = Free { m: 1.5 };
    let (q, v, h) = (1e20_f64, 1.0_f64, 0.01_f64);
    let mut run = system.at(0.0, [q], [v]).integrate(FixedStep, h).expect("a start");
    run.step().expect("a step");
    let node = *run.node();
    assert_eq!((node.q[0], node.q_low[0]), (q, v * h));
    for _ in 1..1000 {
        run.step().expect("a step");
    }
    assert_eq!(run.state().q[0].to_bits(), q.to_bits());
    // The rounding of a thousand products and sums.
    let low = run.node().q_low[0];
    assert!((low - 10.0_f64).abs() < 1e-11, "{low}");
}

lagrangian! {
    /// A free particle.
    struct Free {
        param m = 1.0;
        coord x;
        L = m * dot(x)^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two attracting masses: in the units √m x and √n y all such systems have the same motion.
    struct Unequal {
        param m = 1.0, n = 1.0, k = 1.3;
        coord x, y;
        let u = sqrt(m) * x, w = sqrt(n) * y;
        L = m * dot(x)^2 / 2 + n * dot(y)^2 / 2 + 0.3 * sqrt(m * n) * dot(x) * dot(y) - k * (u - w)^2 / 2 - (u^4 + w^4) / 4;
        discretize midpoint;
    }
}

lagrangian! {
    /// A mass that nearly vanishes for small x.
    struct Thin {
        coord x;
        L = exp(-30 / x) * dot(x)^2 / 2 - exp(-30 / x) * x;
        discretize midpoint;
    }
}

/// The end of fixed steps from the same state in these units, in these units.
fn reached(m: f64, n: f64) -> SVector<f64, 2> {
    let system = Unequal { m, n, ..Unequal::default() };
    let units = SVector::from([m.sqrt(), n.sqrt()]);
    let [q, v] = [[0.7, 0.4], [0.1, -0.3]].map(|start| SVector::from(start).component_div(&units));
    let mut run = system.at(0.0, q, v).integrate(FixedStep, 0.01).expect("a regular system");
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
    // The mass e^(−30/x) cancels except for its slope: a = −1 − 30/x − 15 v²/x². At x = 1/20 it is e^−600.
    for x in [1.0, 0.05] {
        let system = Thin::default();
        let mut run = system.at(0.0, [x], [0.0]).integrate(FixedStep, 1e-7).expect("a regular system");
        for _ in 0..100 {
            run.step().expect("a step");
        }
        let (t, v) = (run.state().t, run.v()[0]);
        let wanted = -(1.0 + 30.0 / x) * (t - 0.5e-7);
        // Measured: 1.2e-4, from the term v²/x².
        assert!((v / wanted - 1.0).abs() < 2e-4, "{v:e}, {wanted:e}");
    }
}

lagrangian! {
    /// A ball on an elastic floor (Hertz): in free flight the root has the argument zero.
    struct Hertz {
        param m = 1.0, g = 1.0, k = 1e4;
        coord x;
        let depth = (abs(x) - x) / 2;
        L = m * dot(x)^2 / 2 - m * g * x - k * depth^(5/2);
        discretize midpoint;
    }
}

#[test]
fn the_root_of_zero_is_no_obstacle() {
    let system = Hertz::default();
    let start = State::at(&system, 0.0, [0.3], [0.0]);
    let energy = start.energy(&system).expect("a velocity");
    let mut run = system.at_state(start).integrate(FixedStep, 1e-3).expect("a velocity");
    let (mut contacts, mut worst) = (0, 0.0_f64);
    for _ in 0..20_000 {
        let state = run.step().expect("a step");
        contacts += usize::from(state.q[0] < 0.0);
        worst = worst.max((state.energy(&system).expect("a velocity") - energy).abs());
    }
    // It bounces, and the steps resolve a contact. Measured: 1.7e-3 of 0.3.
    assert!((500..2000).contains(&contacts) && worst < 3e-3, "{contacts} contacts, {worst:e}");
}

lagrangian! {
    /// Between two logarithmic walls: their forces are finite beyond them.
    struct Walls {
        coord x;
        L = dot(x)^2 / 2 + 1e-3 * ln(x) + 1e-3 * ln(1 - x);
        discretize midpoint;
    }
}

#[test]
fn finite_forces_with_an_infinite_energy_give_no_energy() {
    let system = Walls::default();
    let beyond = State::at(&system, 0.0, [1.5], [0.0]).energy(&system);
    assert!(matches!(beyond, Err(StepError::NonFinite { quantity: "energy", expression: Some(_), .. })), "{beyond:?}");

    let run = EnergyPreserving::from_midpoint(system, 0.0, [0.5], [1.0], 0.05).expect("a start");
    let mut run = run.with_fallback(Fallback::FixedSteps);
    let mut last = run.state();
    let error = loop {
        match run.detailed_step() {
            Ok(step) => {
                assert!(step.energy.is_finite() && run.discrete_energy().is_some_and(f64::is_finite), "{step:?}");
                last = run.state();
            }
            Err(error) => break error,
        }
    };
    assert!(matches!(error, StepError::NonFinite { quantity: "energy", .. }), "{error:?}");
    assert_eq!(run.state(), last);
    let text = serde_json::to_string(&run.checkpoint()).expect("numbers");
    let stored: Checkpoint<_, 1> = serde_json::from_str(&text).expect("finite numbers");
    assert!(Run::restart(system, EnergyPreserving, stored).is_ok());

    // Fixed steps need forces only; beyond the wall their energy is undefined.
    let mut run = system.at(0.0, [1.5], [1.0]).integrate(FixedStep, 0.05).expect("a start");
    run.step().expect("a step");
    assert!(run.state().q[0] > 1.5 && run.discrete_energy().is_none());
}

lagrangian! {
    /// A drag whose slope is infinite at rest.
    struct Drag {
        param c = 0.3;
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        force x = -c * abs(dot(x))^(1/2) * sign(dot(x));
        discretize midpoint;
    }
}

#[test]
fn a_slope_that_is_no_number_is_not_a_singular_mass() {
    let system = Drag::default();
    assert!(system.at(0.0, [1.0], [0.1]).integrate(FixedStep, 0.01).is_ok());
    // At rest a velocity exists, but no step.
    let mut at_rest = system.at(0.0, [1.0], [0.0]).integrate(FixedStep, 0.01).expect("a velocity");
    let step = at_rest.step();
    assert!(matches!(step, Err(StepError::NonFinite { .. })), "{step:?}");
}

lagrangian! {
    /// A mass in a frame that turns about the vertical, in a steep potential.
    struct Turning {
        param w = 1.0;
        coord x, y;
        let X = x * cos(w * t) - y * sin(w * t), Y = x * sin(w * t) + y * cos(w * t);
        L = (dot(X)^2 + dot(Y)^2) / 2 - 1e6 * (x - 1)^8;
        discretize midpoint;
    }
}

#[test]
fn a_time_that_cancels_costs_no_digits() {
    const { assert!(<Turning as Lagrangian<2>>::AUTONOMOUS) };
    let state = Turning::default().at(0.0, [1.001, 0.0], [0.0, -1.0]).state;
    // (x' − w y)² + (y' + w x)² of the kinetic energy has the Hamiltonian (x'² + y'² − w² (x² + y²))/2: 1e-3 by hand.
    let wanted = (1.0 - 1.001_f64.powi(2)) / 2.0 + 1e6 * 0.001_f64.powi(8);
    let energy = state.energy(&Turning::default()).expect("an energy");
    // Multiplied out, the potential is off by 4e-9.
    assert!((energy - wanted).abs() < 1e-14, "{energy:e} {wanted:e}");
}
