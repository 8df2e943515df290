//! The measured error of a step: motions that are lost, jumps, events, limits; and steps from a tolerance.

use crate::support::scenes::{self, Scene};
use core::f64::consts::TAU;
use vi_core::motion::Motion;
use vi_core::run::{Event, Length, LocalError, Monitored};
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_core::{
    Composition, EnergyPreserving, FixedStep, Gauss, Method, Run, SVector, Start, Starts, State, StepError, Tolerance,
    lagrangian,
};
use vi_systems::{DoublePendulum, HarmonicOscillator, Kepler, Pendulum};

/// The larger error of q and of h·v, of each coordinate.
fn larger<const N: usize>(error: &LocalError<N>) -> SVector<f64, N> {
    error.q.zip_map(&error.hv, f64::max)
}

/// Kepler's problem with a pericentre of 0.06: steps of 0.1 lose the orbit without an error.
fn falling() -> Start<Kepler, 2> {
    Kepler::default().at(0.0, [0.4, 0.0], [0.0, 0.8])
}

#[test]
fn a_run_that_loses_its_orbit_is_told() {
    let mut run = falling().integrate(Gauss::<8>, 0.1).expect("a start").monitored();
    run.until(6.0).expect("every step has a solution");
    let energies = [falling().state.energy(&Kepler::default()), run.run().energy()].map(|energy| energy.expect("H"));
    assert!(energies[0] < -2.17 && energies[1] > 1.0, "{energies:?}");
    // Measured: 2.9 % of the excursion of y, at t = 0.3.
    let found = run.largest();
    assert!(found.estimate > 0.01 && found.coordinate == 1 && (found.t - 0.3).abs() < 1e-9, "{found:?}");
    // Ten times shorter steps lose nothing: measured 2.5e-13, H off by 4e-11.
    let mut run = falling().integrate(Gauss::<8>, 0.01).expect("a start").monitored();
    run.until(6.0).expect("every step has a solution");
    assert!(run.largest().estimate < 1e-12, "{:?}", run.largest());
}

#[test]
fn many_small_errors_add_up() {
    // A midpoint step turns the phase by 2 atan(ω h/2) instead of ω h: of n steps, by n e too little.
    let oscillator = HarmonicOscillator { m: 1.3, k: 2.0 };
    let (h, steps) = (0.1, 40_000_u32);
    let phase = (2.0_f64 / 1.3).sqrt() * h;
    let lag = f64::from(steps) * (phase - 2.0 * (phase / 2.0).atan());
    let mut run = oscillator.at(0.0, [0.7], [0.0]).integrate(FixedStep, h).expect("a start").monitored();
    for _ in 0..steps {
        run.step().expect("a step");
    }
    let found = run.largest();
    println!("{found:?}, phase {lag}");
    // Each step is right to 1e-4, and the run is off by more than one turn. The scale is twice the amplitude, and q is off
    // by the lag times the amplitude where it passes through zero. Measured: 0.98 of that.
    assert!(found.estimate < 1e-3 && lag > TAU, "{found:?}, {lag}");
    assert!((0.9..1.1).contains(&(found.sum / (lag / 2.0))), "{found:?}, {lag}");
}

#[test]
fn a_step_that_does_not_exist_has_no_error() {
    let run = falling().integrate(Gauss::<8>, 1.0).expect("a start");
    let error = run.local_error().expect_err("no step");
    assert!(matches!(error, StepError::TooLong { longest, .. } if longest > 0.1 && longest < 0.5), "{error}");
    assert_eq!(run.monitored().step(), Err(error));
}

#[test]
fn a_monitor_changes_no_bit_and_measures_few_steps() {
    fn same<M: Method<DoublePendulum, 2>>(start: Start<DoublePendulum, 2>, method: M, h: f64) {
        let mut run = start.integrate(method, h).expect("a start");
        let mut monitored = run.clone().monitored();
        for _ in 0..5000 {
            assert_eq!(run.step(), monitored.step());
        }
        assert_eq!((run.node(), run.iterations()), (monitored.run().node(), monitored.run().iterations()));
        // 73 measurements of two steps each: 3 % of the steps.
        assert!(monitored.measurements() <= 80, "{}", monitored.measurements());
    }
    let scene = scenes::double_pendulum();
    let start = scene.system.at(0.0, scene.q, scene.v);
    same(start, FixedStep, 0.01);
    same(start, Composition::SUZUKI_4, 0.02);
    same(start, Gauss::<4>, 0.05);
    same(start, EnergyPreserving, 0.002);
}

#[test]
fn a_short_pericentre_is_not_missed() {
    // e = 0.95: the velocity is that of the pericentre, 39 times that of the apocentre, for 1 % of a period of 2000 steps.
    let start = Kepler::default().at(0.0, [-1.95, 0.0], [0.0, (0.05_f64 / 1.95).sqrt()]);
    let h = core::f64::consts::TAU / 2000.0;
    for periods in [0.55, 1.0, 3.0] {
        let mut run = start.integrate(FixedStep, h).expect("a start").monitored();
        let (mut largest, mut excursion) = (SVector::<f64, 2>::zeros(), SVector::<f64, 2>::zeros());
        while run.run().t() < periods * core::f64::consts::TAU {
            largest = largest.zip_map(&larger(&run.run().local_error().expect("a step")), f64::max);
            let after = run.step().expect("a step");
            excursion = excursion.zip_map(&(after.q - start.state.q), |most, q| most.max(q.abs()));
        }
        let largest = largest.component_div(&excursion).max();
        let found = run.largest().estimate;
        println!("{periods} periods: {found:e} of {largest:e}, {} measurements", run.measurements());
        // The scale is that of the force at the pericentre, 0.025, an eightieth of the excursion of x.
        assert!(found > 0.5 * largest && found < 160.0 * largest, "{periods} periods: {found:e} of {largest:e}");
    }
}

/// The largest error of 1000 steps of the length that a tolerance finds.
fn by_tolerance<M, S, const N: usize>(start: Start<S, N>, method: M, tolerance: f64) -> f64
where
    M: Method<S, N>,
    S: Motion<N> + Convertible<N>,
{
    let run = start.integrate(method, Tolerance(tolerance)).unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
    let mut run = run.monitored();
    for _ in 0..1000 {
        run.step().expect("a step");
    }
    run.largest().estimate
}

#[test]
fn a_step_from_a_tolerance_has_its_error() {
    fn each<S: Motion<N> + Convertible<N> + EnergyStepping<N>, const N: usize>(scene: Scene<S, N>) {
        let start = scene.system.at(0.0, scene.q, scene.v);
        for tolerance in [1e-4, 1e-6, 1e-9] {
            let errors = [
                by_tolerance(start, FixedStep, tolerance),
                by_tolerance(start, Composition::KAHAN_LI_8, tolerance),
                by_tolerance(start, Gauss::<4>, tolerance),
                by_tolerance(start, EnergyPreserving, tolerance),
            ];
            // Measured: 0.29 to 1.7 of it. The search accepts a length within 15 %, a factor of 3.5 of an error of order
            // 9. After the first stretch the scales may still shrink.
            let are_near = errors.iter().all(|error| *error > 0.2 * tolerance && *error < 2.0 * tolerance);
            assert!(are_near, "{} {tolerance:e}: {errors:?}", S::NAME);
        }
    }
    each(scenes::kepler());
    each(scenes::pendulum());
    each(scenes::charged_particle());
}

#[test]
fn a_length_is_a_number_or_a_tolerance_of_any_precision() {
    fn h<M: Method<S, 1, T>, S: vi_core::Lagrangian<1, T> + Copy, T: vi_core::real::Scalar>(
        start: Start<S, 1, T>,
        method: M,
        length: impl Length<T>,
    ) -> Result<f64, StepError> {
        start.integrate(method, length).map(|run| run.h().to_f64())
    }
    let single = HarmonicOscillator { m: 1.0_f32, k: 1.0 }.at(0.0, [1.0], [0.0]);
    let double = HarmonicOscillator { m: 1.0, k: 1.0 }.at(0.0, [1.0], [0.0]);
    assert_eq!(single.integrate(FixedStep, 0.5).expect("a start").h().to_bits(), 0.5_f32.to_bits());
    assert_eq!(h(double, FixedStep, 0.5), Ok(0.5));
    let found = [h(single, FixedStep, Tolerance(1e-4)), h(double, FixedStep, Tolerance(1e-4))];
    let [single_h, double_h] = found.map(|h| h.expect("a length"));
    // h³/24 of the amplitude, which is half of the excursion.
    assert!((single_h / double_h - 1.0).abs() < 0.05 && (0.08..0.25).contains(&double_h), "{found:?}");
    for tolerance in [0.0, 1e-17, -1.0, 1.0, f64::NAN] {
        assert!(matches!(h(double, FixedStep, Tolerance(tolerance)), Err(StepError::InvalidInput { .. })));
    }
    assert!(matches!(h(single, FixedStep, Tolerance(1e-9)), Err(StepError::InvalidInput { .. })));
    // At rest there is no error to compare.
    let rest = h(HarmonicOscillator::default().at(0.0, [0.0], [0.0]), FixedStep, Tolerance(1e-9));
    assert!(matches!(rest, Err(StepError::Tolerance { estimate: 0.0, .. })), "{rest:?}");
}

lagrangian! {
    /// An oscillator, pushed once at t = `at` for a time of width s.
    struct Pushed {
        param s = 0.05, at = 30.37;
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        force x = exp(-((t - at) / s)^2) / s;
        discretize midpoint;
    }
}

#[test]
fn neither_shortened_steps_nor_repeated_times_hide_an_error() {
    let monitored = || Pushed::default().at(0.0, [1.0], [0.0]).integrate(FixedStep, 0.02).expect("a start").monitored();
    let mut whole = monitored();
    whole.until(40.0).expect("steps");
    let expected = whole.largest();
    // Before the push the steps have an error of 3.3e-7.
    assert!(expected.estimate > 1e-5 && (expected.t - 30.37).abs() < 0.1, "{expected:?}");
    for grid in [0.021, 0.025, 0.2, 0.205] {
        let mut run = monitored();
        for t in (1..).map(|k| f64::from(k) * grid).take_while(|t| *t < 40.0) {
            run.until(t).expect("steps");
            run.until(t).expect("a run that is there");
        }
        // Measured: 0.91 to 1.04 of it.
        let found = run.largest();
        let ratio = found.estimate / expected.estimate;
        assert!((found.t - 30.37).abs() < 0.1 && (0.85..1.15).contains(&ratio), "{grid}: {found:?} for {expected:?}");
    }
}

#[test]
fn a_jump_is_no_excursion() {
    let start = Pendulum::default().at(0.0, [1.0], [0.0]);
    let largest = |turns: f64| {
        let mut run = start.integrate(FixedStep, 0.1).expect("a start").monitored();
        run.step().expect("a step");
        let jump = |run: &mut Run<FixedStep, Pendulum, 1>| {
            let state = run.state();
            run.set_state(State { q: state.q.add_scalar(turns * core::f64::consts::TAU), ..state })
        };
        run.change(jump).expect("a state");
        run.until(20.0).expect("steps");
        run.largest()
    };
    let [stays, jumps] = [0.0, 1e4].map(largest);
    assert!(stays.estimate > 1e-5 && (jumps.estimate / stays.estimate - 1.0).abs() < 1e-3, "{stays:?} {jumps:?}");
}

#[test]
fn steps_to_an_event_are_measured() {
    let monitored =
        || Pendulum::default().at(0.0, [1.0], [0.0]).integrate(FixedStep, 0.1).expect("a start").monitored();
    let (mut plain, mut stopped) = (monitored(), monitored());
    plain.until(20.0).expect("steps");
    let mut crossings = 0;
    while stopped.next_event(Event::falling(|m| m.q[0]), 20.0).expect("steps").is_some() {
        crossings += 1;
    }
    // The period is 6.7: it falls through zero at 1.7, 8.4 and 15.1.
    let [plain, found] = [plain.largest(), stopped.largest()];
    assert_eq!((crossings, stopped.t()), (3, 20.0));
    // Measured: the same to 2 %.
    assert!((found.estimate / plain.estimate - 1.0).abs() < 0.05, "{found:?} {plain:?}");
    let mut limited = monitored().with_limit(0.1 * plain.estimate);
    let error = limited.next_event(Event::rising(|m| m.q[0] - 5.0), 1e9).expect_err("a limit");
    assert!(matches!(error, StepError::Tolerance { .. }) && limited.t() < 20.0, "{error}");
}

#[test]
fn a_tolerance_holds_on_a_motion_that_never_turns() {
    // A hyperbolic orbit from far away: its steps are short enough for the pericentre, which comes after 50 units of time.
    let start = Kepler::default().at(0.0, [103.0, 1.0], [-2.0, 0.0]);
    let run = start.integrate(Gauss::<8>, Tolerance(1e-9)).expect("a length");
    assert!(run.h() > 0.0 && run.h().is_finite());
    // A motion past whose end the energy-preserving method has no step, of any length.
    let start = Pendulum::default().at(0.0, [0.0], [7.0]);
    let mut run = start.integrate(EnergyPreserving, Tolerance(1e-5)).expect("a length").monitored();
    let error = run.until(10.0).expect_err("no step over the top");
    assert!(matches!(error, StepError::NoForwardStep { .. }), "{error}");
    let found = run.largest().estimate;
    assert!(found > 1e-6 && found < 2e-5, "{found:e}");
}

#[test]
fn a_limit_judges_an_orbit_that_is_lost() {
    let mut run = falling().integrate(Gauss::<8>, 0.1).expect("a start").monitored().with_limit(1e-8);
    let error = run.until(6.0).expect_err("a step beyond the limit");
    let StepError::Tolerance { t, .. } = error else { panic!("{error}") };
    assert!(t < 0.35 && (run.energy().expect("H") + 2.18).abs() < 1e-6, "{error}");
}

#[test]
fn beyond_a_limit_the_run_ends_with_a_typed_error() {
    fn ends<M: Method<S, N>, S: vi_core::Lagrangian<N> + Copy, const N: usize>(
        mut run: Monitored<M, S, N>,
    ) -> StepError {
        let error = loop {
            if let Err(error) = run.step() {
                break error;
            }
        };
        let state = run.run().state();
        assert_eq!((run.step(), run.run().state()), (Err(error), state), "the error repeats");
        error
    }
    // Steps of a damped oscillator that keep the energy become longer and longer.
    let scene = scenes::damped_oscillator();
    let run = scene.system.at(0.0, scene.q, scene.v).integrate(EnergyPreserving, Tolerance(1e-6)).expect("a start");
    let error = ends(run.monitored().with_limit(1e-5));
    let StepError::Tolerance { t, estimate, tolerance } = error else { panic!("{error}") };
    assert!(t > 5.0 && estimate > tolerance && estimate < 1e-4 && tolerance.to_bits() == 1e-5_f64.to_bits(), "{error}");
    assert!(error.to_string().ends_with("; take shorter steps, a method of higher order, or allow a larger error"));
}

lagrangian! {
    /// A ball that falls onto a steep wall.
    struct Dropped {
        param c = 0.3, d = 0.002;
        coord y;
        L = dot(y)^2 / 2 - y - 0.01 * exp(-y / d);
        force y = -c * dot(y) * exp(-y / d);
    }
}

#[test]
fn a_tolerance_holds_after_a_free_flight() {
    // Until the ball meets the wall, its force is constant but for rounding.
    let start = Dropped::default().at(0.0, [1.0], [0.0]);
    for tolerance in [1e-8, 1e-9, 1e-10] {
        let mut run = start.integrate(Gauss::<4>, Tolerance(tolerance)).expect("a length").monitored();
        run.until(3.0).expect("a motion");
        let found = run.largest();
        // Once 1.8e-8 for the two smaller ones.
        assert!(found.estimate < tolerance && found.estimate > 0.2 * tolerance, "{tolerance:e}: {found:?}");
    }
}
