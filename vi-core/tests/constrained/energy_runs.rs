//! Options, failures and surroundings of energy-preserving runs with constraints.

use super::systems::{Auto, Mixed, Model, PENDULUM, Pendulum};
use vi_core::method::{Fallback, Switches};
use vi_core::motion::Motion as _;
use vi_core::real::Real;
use vi_core::state::StepKind;
use vi_core::{EnergyPreservingGauss, Gauss, Run, SVector, Starts, State, StepError, Tolerance};

type PendulumRun<const STAGES: usize> = Run<EnergyPreservingGauss<STAGES>, Auto<Pendulum, 1>, 2>;

fn pendulum<const STAGES: usize>(h: f64) -> PendulumRun<STAGES> {
    let start = PENDULUM.at(0.0, [0.6, -0.8], [0.8, 0.6]);
    start.integrate(EnergyPreservingGauss::<STAGES>, h).unwrap_or_else(|error| panic!("{error}"))
}

/// The error that ends a run, and its steps.
fn end<const STAGES: usize>(run: &mut PendulumRun<STAGES>) -> (StepError, u32) {
    (0..100_000).find_map(|count| run.step().err().map(|failure| (failure, count))).expect("an end")
}

#[test]
fn a_run_without_a_shift_ends_where_the_density_vanishes() {
    let mut run = pendulum::<1>(0.01);
    let (failure, count) = end(&mut run);
    println!("{count}: {failure}");
    let StepError::NoForwardGaussStep { t, h, stages: 1, excess, density, shift: 0.0, largest } = failure else {
        panic!("{failure}")
    };
    let last = run.state();
    assert!(t.to_bits() == last.t.to_bits() && h.to_bits() == run.h().to_bits());
    // Between the middles of the last step and of the next one, D changes its sign.
    let density_at = |state: &State<2>| {
        let w2 = state.p.norm_squared();
        (9.81 * state.q[0]).powi(2) + 2.0 * 9.81 * w2 * state.q[1] - w2 * w2
    };
    let beside = |h: f64| {
        let beside = PENDULUM.at_state(last).integrate(Gauss::<4>, h).and_then(|mut run| run.step());
        density_at(&beside.unwrap_or_else(|error| panic!("{error}")))
    };
    let [before, after] = [beside(-0.5 * h), beside(0.5 * h)];
    println!("{before} {} {after} {density} {excess:e} {largest}", density_at(&last));
    // Measured: 5e-16.
    assert!((density - density_at(&last)).abs() < 1e-14 * largest);
    assert!(before * after < 0.0, "{before} {after}");
    // The same error again, and the state stays.
    assert_eq!((run.step(), run.state()), (Err(failure), last));
    // The run continues with the shift that the error names.
    let measured = pendulum::<1>(0.01).with_shift_from(2.1).unwrap_or_else(|error| panic!("{error}"));
    // Twice the largest |D|, at the turning points. Measured: 241.4.
    assert!(measured.shift() > 240.0 && measured.shift() < 243.0, "{}", measured.shift());
    assert_eq!(measured.take(500).flatten().count(), 500);
}

#[test]
fn steps_that_would_turn_the_rod_too_far_do_not_hide_the_end() {
    // Three times the last length does not exist.
    let (failure, count) = end(&mut pendulum::<1>(0.128));
    println!("{count}: {failure}");
    assert!(matches!(failure, StepError::NoForwardGaussStep { .. }), "{failure}");
}

#[test]
fn fixed_steps_pass_the_places_without_a_density() {
    let mut run = pendulum::<1>(0.01).with_fallback(Fallback::FixedSteps);
    let initial = run.energy().unwrap_or_else(|error| panic!("{error}"));
    let mut kinds = [0_u32; 3];
    let mut worst = 0.0_f64;
    while run.t() < 20.0 {
        let state = run.step().unwrap_or_else(|error| panic!("{error}"));
        kinds[match run.step_kind() {
            StepKind::EnergyPreserving => 0,
            StepKind::FixedStep => 1,
            StepKind::Reseeded { .. } => 2,
        }] += 1;
        worst = worst.max((state.energy(&PENDULUM).unwrap_or_else(|error| panic!("{error}")) - initial).abs());
        assert!(PENDULUM.constraints(0.0, &state.q)[0].abs() < 1e-15);
    }
    let Switches { count, returns, fixed_steps, .. } = run.switches();
    println!("{kinds:?} {count} {returns} {fixed_steps} {worst:e}");
    assert!(count > 10 && returns >= count - 1 && kinds[0] > 100 && kinds[1] > 100, "{kinds:?} {count} {returns}");
    // Measured: 2.0e-3, of the order of h² D/8.
    assert!(worst < 4e-3, "{worst:e}");
}

#[test]
fn bounds_limit_the_lengths() {
    let shifted = || pendulum::<1>(0.02).with_shift(40.0).unwrap_or_else(|error| panic!("{error}"));
    let (failure, count) = end(&mut shifted().with_step_bounds(0.0, 0.03).unwrap_or_else(|error| panic!("{error}")));
    println!("{count}: {failure}");
    let StepError::StepBounds { found, h_max: 0.03, .. } = failure else { panic!("{failure}") };
    assert!(found > 0.03 && found < 0.1, "{failure}");
    assert!(shifted().with_step_bounds(-1.0, 0.03).is_err());
}

#[test]
fn starts_and_shifts_that_cannot_be_are_refused() {
    let begin = |q: [f64; 2], v: [f64; 2], h: f64| {
        PENDULUM.at(0.0, q, v).integrate(EnergyPreservingGauss::<2>, h).map(|_| ()).expect_err("no start")
    };
    assert!(matches!(begin([0.6, -0.801], [0.8, 0.6], 0.1), StepError::InconsistentStart { constraint: "rod", .. }));
    for h in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-100] {
        assert!(matches!(begin([0.6, -0.8], [0.8, 0.6], h), StepError::InvalidInput { .. }), "{h}");
    }
    assert!(matches!(begin([0.6, -0.8], [0.8, f64::NAN], 0.1), StepError::NonFinite { .. }));
    // The rod would turn over.
    assert!(matches!(begin([0.6, -0.8], [8.0, 6.0], 0.5), StepError::NotConverged { .. }));
    assert!(matches!(pendulum::<2>(0.1).with_shift(f64::NAN), Err(StepError::InvalidInput { .. })));
    assert!(matches!(pendulum::<2>(0.1).with_shift_from(-1.0), Err(StepError::InvalidInput { .. })));
    let energy = |energy| {
        let state = pendulum::<1>(0.1).state();
        EnergyPreservingGauss::<1>::from_energy(PENDULUM, state, energy, 0.02).and_then(|mut run| run.step())
    };
    assert!(matches!(energy(f64::NAN), Err(StepError::NonFinite { .. })));
    // At E = H no length is determined.
    let state = pendulum::<1>(0.1).state();
    let h = state.energy(&PENDULUM).unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(energy(h), Err(StepError::DegenerateStep { .. })));
    // The energy of the fixed step of 0.02 gives its length.
    let given = energy(pendulum::<1>(0.02).shifted_energy()).unwrap_or_else(|error| panic!("{error}"));
    println!("{}", given.t - 0.02);
    // Measured: 0.
    assert!((given.t - 0.02).abs() < 1e-15, "{}", given.t);
}

/// Starts of many speeds and lengths, one in `every`.
fn starts_give_steps_or_typed_errors(every: usize) {
    let mut counts = [0_usize; 2];
    for k in (0..120_usize).step_by(every) {
        let number = f64::from(u8::try_from(k).expect("a small number"));
        let speed = number % 11.0 - 3.0;
        let ((s, c), h) = ((0.37 * number).sin_cos(), 0.003 * 1.06_f64.powf(number));
        let start = State::projected(&PENDULUM, 0.0, [s, -c], [speed * c, speed * s]);
        let start = PENDULUM.at_state(start.unwrap_or_else(|error| panic!("{error}")).state);
        let shift = [0.0, 300.0, -300.0, 3e4][k % 4];
        let outcomes = [
            start.integrate(EnergyPreservingGauss::<1>, h).and_then(|run| run.with_shift(shift)).and_then(last),
            start.integrate(EnergyPreservingGauss::<2>, h).and_then(|run| run.with_shift(shift)).and_then(last),
            start.integrate(EnergyPreservingGauss::<3>, h).and_then(|run| run.with_shift(shift)).and_then(last),
        ];
        for outcome in outcomes {
            match outcome {
                Ok(state) => assert!(PENDULUM.constraints(0.0, &state.q)[0].abs() < 1e-14, "{state:?}"),
                Err(StepError::NonFinite { .. } | StepError::Singular { .. }) => panic!("{outcome:?}"),
                Err(_) => {}
            }
            counts[usize::from(outcome.is_err())] += 1;
        }
    }
    println!("{counts:?}");
    assert!(counts.iter().all(|count| count * every > 20), "{counts:?}");
}

#[test]
fn every_start_gives_steps_or_a_typed_error() {
    starts_give_steps_or_typed_errors(7);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn each_of_all_starts_gives_steps_or_a_typed_error() {
    starts_give_steps_or_typed_errors(1);
}

/// The state after twenty steps.
fn last<const STAGES: usize>(mut run: PendulumRun<STAGES>) -> Result<State<2>, StepError> {
    for _ in 0..20 {
        run.step()?;
    }
    Ok(run.state())
}

#[test]
fn a_tolerance_finds_a_step() {
    let start = PENDULUM.at(0.0, [0.6, -0.8], [0.8, 0.6]);
    let run = start.integrate(EnergyPreservingGauss::<2>, Tolerance(1e-8));
    let run = run.unwrap_or_else(|error| panic!("{error}"));
    println!("{}", run.h());
    assert!(run.h() > 1e-3 && run.h() < 0.2, "{}", run.h());
}

#[test]
fn changes_of_the_system_and_the_state_change_the_energy() {
    let mut run = pendulum::<1>(0.02).with_shift(300.0).unwrap_or_else(|error| panic!("{error}"));
    run.step().unwrap_or_else(|error| panic!("{error}"));
    let (before, energy) = (run.shifted_energy(), run.energy().unwrap_or_else(|error| panic!("{error}")));
    assert!(run.impulses().is_some());
    let failure = run.set_parameters(|system| system.0.length = 1.1).expect_err("another circle");
    assert!(matches!(failure, StepError::InconsistentStart { constraint: "rod", .. }), "{failure}");
    assert_eq!(run.shifted_energy().to_bits(), before.to_bits());
    run.set_parameters(|system| system.0.g = 9.0).unwrap_or_else(|error| panic!("{error}"));
    let gained = run.energy().unwrap_or_else(|error| panic!("{error}")) - energy;
    assert!(gained > 0.1 && (run.shifted_energy() - before - gained).abs() < 1e-14, "{gained}");
    assert!(run.impulses().is_none());
    run.step().unwrap_or_else(|error| panic!("{error}"));
    let before = run.clone();
    let off = State { t: 0.0, q: SVector::from([1.0, 1.0]), p: SVector::zeros() };
    assert!(matches!(run.set_state(off), Err(StepError::InconsistentStart { .. })));
    assert_eq!((run.state(), run.shifted_energy().to_bits()), (before.state(), before.shifted_energy().to_bits()));
    // An impact that turns the velocity around keeps H, and so E'.
    let State { t, q, p } = run.state();
    run.set_state(State { t, q, p: -p }).unwrap_or_else(|error| panic!("{error}"));
    assert!((run.shifted_energy() - before.shifted_energy()).abs() < 1e-14);
    run.step().unwrap_or_else(|error| panic!("{error}"));
}

/// A blade on a belt that moves along x: autonomous, but the constraint does work.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Belt;

impl Model<3, 1> for Belt {
    const NAME: &'static str = "Belt";
    const COORDINATES: [&'static str; 3] = ["x", "y", "θ"];
    const CONSTRAINTS: &'static [&'static str] = &["blade"];
    const HOLONOMIC: usize = 0;
    fn lagrangian<T: Real>(&self, _: T, _: &SVector<T, 3>, v: &SVector<T, 3>) -> T {
        v.dot(v) * T::real(0.5)
    }
    fn constraints<T: Real>(&self, _: T, q: &SVector<T, 3>, v: &SVector<T, 3>) -> [T; 1] {
        let (sine, cosine) = q[2].sin_cos();
        [sine * (v[0] - T::real(0.5)) - cosine * v[1]]
    }
}

#[test]
fn the_work_of_a_moving_constraint_is_counted() {
    // In the frame of the belt the blade runs in a circle with constant speed: H changes with it.
    let run = |h: f64| {
        let start = Auto(Belt).at(0.0, [0.0; 3], [1.5, 0.0, 2.0]);
        let run = start.integrate(EnergyPreservingGauss::<1>, h).and_then(|run| run.with_shift(30.0));
        let mut run = run.unwrap_or_else(|error| panic!("{error}"));
        let mut worst = [0.0_f64; 2];
        while run.t() < 3.0 {
            let state = run.step().unwrap_or_else(|error| panic!("{error}"));
            let energy = state.energy(&Auto(Belt)).unwrap_or_else(|error| panic!("{error}"));
            // v = (1/2 + cos 2t, sin 2t): H = (1/4 + 1 + cos 2t + 4)/2, with the turning rate 2.
            let exact = 2.625 + 0.5 * (2.0 * state.t).cos();
            let discrete = run.discrete_energy().expect("a step");
            worst = [worst[0].max((energy - exact).abs()), worst[1].max((discrete - exact).abs())];
        }
        worst
    };
    let (coarse, fine) = (run(0.02), run(0.01));
    println!("{coarse:?} {fine:?}");
    // A circle is exact. Measured: 4.4e-16.
    assert!(coarse[0] < 2e-15 && fine[0] < 2e-15, "{coarse:?} {fine:?}");
    // O(h²), while H changes by 1.
    assert!(coarse[1] < 1e-3 && (coarse[1] / fine[1] - 4.0).abs() < 0.1, "{coarse:?} {fine:?}");
}

#[test]
fn momenta_are_balanced_by_impulses() {
    let start = Auto(Mixed).at(0.0, [0.0, 0.6, -0.8, 0.0], [1.5, 0.0, 0.0, 0.7]);
    let run = start.integrate(EnergyPreservingGauss::<1>, 0.02).and_then(|run| run.with_shift(100.0));
    let mut run = run.unwrap_or_else(|error| panic!("{error}"));
    assert!(run.impulses().is_none());
    for _ in 0..7 {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let before = run.state();
    let after = run.step().unwrap_or_else(|error| panic!("{error}"));
    let impulses = run.impulses().expect("a step");
    let of = |state: &State<4>, multipliers: [f64; 2]| {
        let (rows, _) = Auto(Mixed).constraint_gradients(state.t, &state.q);
        rows[0] * multipliers[0] + rows[1] * multipliers[1]
    };
    let weight = SVector::from([0.0, 0.0, -2.0 * run.h(), 0.0]);
    let rest = after.p - before.p - weight - of(&before, impulses.lambda[0]) - of(&after, impulses.mu);
    println!("{:e}", rest.amax());
    // Measured: 0.
    assert!(rest.amax() < 1e-15 && impulses.mu[1].abs() > 1e-3, "{rest} {impulses:?}");
}
