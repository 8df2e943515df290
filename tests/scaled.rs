//! Gauss steps in transformed time: against references, order, preserved quantities, failures.

use crate::support::assert_order_of;
use crate::support::reference::{file, number, steps, vector};
use serde_json::Value;
use std::f64::consts::PI;
use vi_core::motion::{Motion, TimeScale};
use vi_core::real::Dual;
use vi_core::run::DenseOutput;
use vi_core::stepping::{Convertible, FixedStepping};
use vi_core::{Called, Gauss, InTransformedTime, Lagrangian, Run, SVector, Starts, State, StepError, lagrangian};
use vi_systems::Kepler;

lagrangian! {
    /// Kepler's problem with the distance as time scale.
    struct ByDistance {
        coord x, y;
        let r = sqrt(x^2 + y^2);
        L = (dot(x)^2 + dot(y)^2) / 2 + 1 / r;
        time_scale = r;
        discretize midpoint;
    }
}

lagrangian! {
    /// Force, time dependence, varying mass and damping together, and a time scale that depends on time and position.
    struct Everything {
        param a = 1.0, c = 0.1, w = 1.0, b = 0.5;
        coord x, y;
        L = (1 + x^2 / 3) * dot(x)^2 / 2 + a * dot(y)^2 / 2 + x * dot(x) * dot(y) / 5 - cos(w * t) * x * y / 4 - x^2 - y^4 / 4;
        force x = -c * dot(x) + sin(t) / 5;
        force y = -c * dot(x) * dot(y);
        time_scale = 1 + b * x^2 / 2 + sin(t) * y / 3;
        discretize midpoint;
    }
}

lagrangian! {
    /// A free particle whose time scale vanishes at x = 1: with k = 0 abruptly.
    struct Wall {
        param k = 1;
        coord x;
        L = dot(x)^2 / 2;
        time_scale = 1 - k * x - (1 - k) * x^8;
        discretize midpoint;
    }
}

lagrangian! {
    /// A spring too stiff for fixed-point iteration, and a soft one.
    struct Stiff {
        param k = 1e6;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - k * x^2 / 2 - y^2 / 2;
        time_scale = 1 / (1 + y^2);
        discretize midpoint;
    }
}

/// Parameters other than the defaults.
const EVERYTHING: Everything = Everything { a: 1.4, c: 0.15, w: 1.3, b: 0.7 };

/// The requirements of a step in transformed time on a system.
trait System<const N: usize>: TimeScale<N> + Convertible<N> + FixedStepping<N> + Copy {}
impl<const N: usize, S: TimeScale<N> + Convertible<N> + FixedStepping<N> + Copy> System<N> for S {}

/// The runs of the reference, with Hamilton's equations of K = g (H − E).
fn follows<const S: usize>(case: &Value) {
    let state = State::at(&EVERYTHING, number(&case["t0"]), vector(&case["q0"]), vector(&case["v0"]));
    let mut run = EVERYTHING
        .at_state(state)
        .integrate(Gauss::<S>.in_transformed_time(), number(&case["dtau"]))
        .expect("a valid start");
    let entries = steps(&case[&format!("s{S}")]);
    assert_eq!(entries.iter().map(|(step, _)| *step).collect::<Vec<_>>(), [1, 5]);
    let mut taken = 0;
    for (step, entry) in entries {
        let mut before = run.state().t;
        while taken < step {
            before = run.state().t;
            run.step().expect("a step");
            taken += 1;
        }
        let State { t, q, p } = run.state();
        let scalars = (t - number(&entry["t"])).abs().max((run.node().energy - number(&entry["E"])).abs());
        let vectors = [q - SVector::from(vector(&entry["q"])), p - SVector::from(vector(&entry["p"]))];
        let off = vectors.iter().map(SVector::amax).fold(scalars, f64::max);
        println!("{S} stages, step {step}: off by {off:.1e}, the last residual {:.1e}", run.residual());
        // Measured: 2.2e-16.
        assert!(off <= 1e-15, "{S} stages, step {step}: off by {off:e}");
        assert!((run.h() - (t - before)).abs() < 1e-15 && run.iterations() > 0);
    }
}

#[test]
fn steps_are_those_of_the_extended_hamiltonian() {
    let case = &file("scaled_time.json")["everything"];
    follows::<1>(case);
    follows::<2>(case);
    follows::<3>(case);
    follows::<4>(case);
}

#[test]
fn a_scaled_point_is_the_point_and_its_derivatives() {
    let t = 0.7;
    let q = SVector::from([0.4, -0.3]);
    let v = SVector::from([0.2, 0.7]);
    let at = EVERYTHING.scaled_point(t, &q, &v);
    assert!((at.energy - EVERYTHING.energy(t, &q, &v)).abs() + (at.power - EVERYTHING.power(t, &q, &v)).abs() < 1e-15);
    let point = EVERYTHING.point(t, &q, &v);
    assert!((at.point.force - point.force).amax() + (at.point.momentum - point.momentum).amax() < 1e-15);
    assert!((at.g - (1.0 + 0.7 * 0.4 * 0.4 / 2.0 - 0.7_f64.sin() * 0.1)).abs() < 1e-15, "{}", at.g);
    let dual = Convertible::<2>::convert::<Dual<f64>>(&EVERYTHING);
    let lifted = v.map(Dual::fixed);
    let by_time = dual.scaled_point(Dual::variable(t), &q.map(Dual::fixed), &lifted).g.slope;
    assert!((at.g_dt - by_time).abs() < 1e-15 && by_time != 0.0, "{} and {by_time}", at.g_dt);
    for k in 0..2 {
        let mut moved = q.map(Dual::fixed);
        moved[k].slope = 1.0;
        let by_place = dual.scaled_point(Dual::fixed(t), &moved, &lifted).g.slope;
        assert!((at.g_dq[k] - by_place).abs() < 1e-15 && by_place != 0.0, "{} and {by_place}", at.g_dq[k]);
    }
    let plain = vi_systems::Pendulum::default().scaled_point(t, &SVector::from([0.3]), &SVector::from([0.1]));
    assert_eq!((plain.g, plain.g_dq[0], plain.g_dt), (1.0, 0.0, 0.0));
}

/// The error at the times of the nodes of a ladder, against plain steps of 16 stages to the same times.
fn order<const S: usize>(longest: f64, tolerance: f64) {
    let state = State::at(&EVERYTHING, 0.2, [0.4, -0.3], [0.2, 0.7]);
    let points: Vec<(f64, f64)> = [4_u32, 6, 8, 12, 16]
        .into_iter()
        .map(|count| {
            let dtau = 4.0 * longest / f64::from(count);
            let mut run =
                EVERYTHING.at_state(state).integrate(Gauss::<S>.in_transformed_time(), dtau).expect("a valid start");
            let reached = run.by_ref().take(count as usize).last().expect("steps").expect("a step");
            let mut plain =
                EVERYTHING.at_state(state).integrate(Gauss::<16>, (reached.t - state.t) / 16.0).expect("a valid start");
            let exact = plain.by_ref().take(16).last().expect("steps").expect("a step");
            (dtau, (reached.q - exact.q).amax().max((reached.p - exact.p).amax()))
        })
        .collect();
    assert_order_of(S, "transformed time", &points, tolerance);
}

#[test]
fn the_order_is_twice_the_number_of_stages() {
    // Slopes measured: 2.00, 4.00, 5.83, 8.02.
    order::<1>(0.05, 0.03);
    order::<2>(0.2, 0.03);
    order::<3>(0.2, 0.03);
    order::<4>(0.4, 0.05);
}

/// The pericentre of an orbit with a = 1 and e = 0.9.
fn eccentric(system: &impl System<2>) -> State<2> {
    State::at(system, 0.0, [0.1, 0.0], [0.0, 19.0_f64.sqrt()])
}

/// The period in transformed time of an orbit with a = 1 and g = r^power: dt = r du, with the eccentric anomaly u.
fn scaled_period(power: f64) -> f64 {
    let count = 4096;
    let anomalies = (0..count).map(|k| 2.0 * PI * f64::from(k) / f64::from(count));
    anomalies.map(|u| (1.0 - 0.9 * u.cos()).powf(1.0 - power)).sum::<f64>() * 2.0 * PI / f64::from(count)
}

/// The error of the position after three periods.
fn three_periods<const S: usize>(system: impl System<2>, dtau: f64) -> f64 {
    let start = eccentric(&system);
    let mut run = system.at_state(start).integrate(Gauss::<S>.in_transformed_time(), dtau).expect("a valid start");
    let reached = run.until(6.0 * PI).expect("the end");
    assert_eq!(reached.t.to_bits(), (6.0 * PI).to_bits());
    (reached.q - start.q).norm()
}

#[test]
fn few_steps_follow_an_eccentric_orbit() {
    let by_distance = |n: f64| scaled_period(1.0) / n;
    let by_rate = |n: f64| scaled_period(1.5) / n;
    let kepler = Kepler::default();
    let distance = ByDistance::default();
    // Steps per period 15, 30, 60, 120. The period itself is rounded: 4.4e-13 remains.
    let found = [
        (three_periods::<4>(distance, by_distance(15.0)), 1.7e-4),
        (three_periods::<4>(distance, by_distance(30.0)), 2.0e-7),
        (three_periods::<4>(distance, by_distance(60.0)), 1.4e-10),
        (three_periods::<4>(distance, by_distance(120.0)), 5e-13),
        (three_periods::<4>(kepler, by_rate(15.0)), 1.7e-7),
        (three_periods::<4>(kepler, by_rate(30.0)), 6.5e-10),
        (three_periods::<4>(kepler, by_rate(60.0)), 3.0e-12),
        (three_periods::<8>(kepler, by_rate(15.0)), 5e-13),
        (three_periods::<8>(kepler, by_rate(30.0)), 5e-13),
    ];
    for (error, limit) in found {
        println!("off by {error:.2e}");
        assert!(error > 0.0 && error <= limit, "off by {error:e}, limit {limit:e}");
    }
    // Plain steps, 120 per period.
    let end = 6.0 * PI;
    let mut plain = kepler.at_state(eccentric(&kepler)).integrate(Gauss::<4>, end / 360.0).expect("a valid start");
    let reached = plain.by_ref().take(360).last().expect("steps").expect("a step");
    assert!((reached.q - eccentric(&kepler).q).norm() > 0.05);
}

#[test]
fn angular_momentum_and_energy_are_conserved() {
    let system = Kepler::default();
    let start = eccentric(&system);
    let spin = |state: &State<2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    let period = scaled_period(1.5);
    let mut run =
        system.at_state(start).integrate(Gauss::<4>.in_transformed_time(), period / 20.0).expect("a valid start");
    let energy = Some(run.node().energy);
    let mut excess = Vec::new();
    let mut turned = 0.0_f64;
    for _ in 0..1000 {
        let mut largest = 0.0_f64;
        for _ in 0..20 {
            let state = run.step().expect("a step");
            turned = turned.max((spin(&state) - spin(&start)).abs());
            largest = largest.max(run.excess().expect("an energy").abs());
        }
        excess.push(largest);
    }
    assert_eq!(run.discrete_energy(), energy, "nothing acts on E");
    let first = excess[..10].iter().copied().fold(0.0, f64::max);
    let last = excess[990..].iter().copied().fold(0.0, f64::max);
    println!(
        "angular momentum off by {turned:.1e}; H − E up to {first:.2e} in ten periods, {last:.2e} in the last ten of 1000"
    );
    // Measured: 6.8e-15, a random walk of roundings: 1.3e-15 to 9.3e-15 with 17 to 40 steps in a period. 4.39e-9 and 4.39e-9.
    assert!(turned < 1e-14, "{turned:e}");
    assert!(first > 1e-10 && last < 1.1 * first, "{first:e}, {last:e}");
}

#[test]
fn time_runs_backwards() {
    let start = State::at(&EVERYTHING, 0.2, [0.4, -0.3], [0.2, 0.7]);
    let mut there = EVERYTHING.at_state(start).integrate(Gauss::<8>.in_transformed_time(), 0.1).expect("a valid start");
    let end = there.by_ref().take(40).last().expect("steps").expect("a step");
    let mut back = EVERYTHING.at_state(end).integrate(Gauss::<8>.in_transformed_time(), -0.1).expect("a valid start");
    let found = back.by_ref().take(40).last().expect("steps").expect("a step");
    assert!(back.h() < 0.0 && back.dtau() < 0.0 && there.h() > 0.0);
    let off = (found.t - start.t).abs().max((found.q - start.q).amax()).max((found.p - start.p).amax());
    println!("back at the start, off by {off:.1e}");
    assert!(off < 1e-14, "{off:e}");
}

#[test]
fn a_restarted_run_is_the_same_bit_for_bit() {
    let start = State::at(&EVERYTHING, 0.2, [0.4, -0.3], [0.2, 0.7]);
    let mut run = EVERYTHING.at_state(start).integrate(Gauss::<3>.in_transformed_time(), 0.1).expect("a valid start");
    for steps in [0, 1, 7] {
        assert!(run.by_ref().take(steps).all(|state| state.is_ok()));
        let mut again =
            Run::restart(EVERYTHING, Gauss.in_transformed_time(), run.checkpoint()).expect("its own checkpoint");
        let mut on = run.clone();
        for _ in 0..5 {
            assert_eq!(on.step(), again.step());
            assert_eq!(on.checkpoint(), again.checkpoint());
        }
    }
    let other = Everything { b: 0.8, ..EVERYTHING };
    let refused = Run::restart(other, Gauss.in_transformed_time(), run.checkpoint()).expect_err("another parameter");
    assert!(matches!(refused, StepError::OtherSystem { parameter: Some("b"), .. }), "{refused}");
}

#[test]
fn states_at_times_are_those_of_plain_steps() {
    let start = State::at(&EVERYTHING, 0.2, [0.4, -0.3], [0.2, 0.7]);
    let mut run = EVERYTHING.at_state(start).integrate(Gauss::<6>.in_transformed_time(), 0.3).expect("a valid start");
    let untouched: Vec<State<2>> = run.clone().take(8).map(|state| state.expect("a step")).collect();
    let times = [0.25, 0.8, 0.81, 1.9, 2.6];
    let states: Vec<State<2>> = run.states_at(times).map(|state| state.expect("a state")).collect();
    assert!(untouched.iter().any(|state| *state == run.state()), "steps to a time are taken aside");
    for (state, t) in states.iter().zip(times) {
        let mut plain = EVERYTHING.at_state(start).integrate(Gauss::<16>, 0.1).expect("a valid start");
        let exact = plain.until(t).expect("the time");
        let off = (state.q - exact.q).amax().max((state.p - exact.p).amax());
        println!("t = {t}: off by {off:.1e}");
        // Measured: 1.4e-13, the error of six stages.
        assert!(state.t.to_bits() == t.to_bits() && off < 2e-13, "t = {t}: {off:e}");
    }
    // Backward, and with steps longer than those of the run.
    let mut back =
        EVERYTHING.at_state(states[4]).integrate(Gauss::<8>.in_transformed_time(), -0.1).expect("a valid start");
    back.step_of(-0.9).expect("a long step");
    let left = 0.2 - back.state().t;
    assert!((back.state().t - 1.7).abs() < 1e-14 && left < 0.0, "{:?}", back.state());
    let reached = back.until(0.2).expect("the start");
    assert!((reached.q - start.q).amax() < 1e-11, "{reached:?}");
    assert!(matches!(back.step_of(f64::NAN), Err(StepError::InvalidInput { .. })));
}

#[test]
fn the_path_of_a_step_is_its_polynomial() {
    let system = Kepler::default();
    let mut run = system
        .at_state(eccentric(&system))
        .integrate(Gauss::<8>.in_transformed_time(), scaled_period(1.5) / 15.0)
        .expect("a valid start");
    let mut worst = [0.0_f64; 2];
    for _ in 0..15 {
        let before = run.state();
        let after = run.step().expect("a step");
        let path = run.dense_output(&before).expect("a path");
        for state in [before, after] {
            let end = path.state(state.t);
            assert!((end.q - state.q).norm() + (end.p - state.p).norm() / state.p.norm() < 1e-13, "{end:?}, {state:?}");
        }
        for part in [0.2, 0.5, 0.8] {
            let t = before.t + part * run.h();
            let found = path.state(t);
            let mut plain =
                system.at_state(before).integrate(Gauss::<16>, (t - before.t) / 8.0).expect("a valid start");
            let exact = plain.until(t).expect("the time");
            worst[0] = worst[0].max((found.q - exact.q).norm());
            worst[1] = worst[1].max((path.velocity(t) - exact.p).norm() / exact.p.norm());
        }
    }
    println!("in a step off by {:.1e}, the velocity by {:.1e}", worst[0], worst[1]);
    // Of order S + 1 and S in the step. Measured: 3.1e-10, 1.3e-8.
    assert!(worst[0] < 4e-10 && worst[1] < 2e-8, "{worst:?}");
}

#[test]
fn a_run_continues_with_other_parameters_and_from_other_states() {
    let system = Kepler::default();
    let mut run =
        system.at_state(eccentric(&system)).integrate(Gauss::<8>.in_transformed_time(), 0.5).expect("a valid start");
    run.by_ref().take(5).for_each(|state| assert!(state.is_ok()));
    let excess = run.excess().expect("an energy");
    run.set_parameters(|system| system.mu = 1.1).expect("other parameters");
    assert!((run.excess().expect("an energy") - excess).abs() < 1e-14);
    let state = run.state();
    let mut fresh =
        Kepler { mu: 1.1 }.at_state(state).integrate(Gauss::<8>.in_transformed_time(), 0.5).expect("a valid start");
    let [one, other] = [run.step(), fresh.step()].map(|state| state.expect("a step"));
    assert!((one.q - other.q).norm() < 1e-13 && (one.q - state.q).norm() > 1e-3);
    assert_eq!(run.discrete_energy(), Some(run.node().energy));
    let start = eccentric(&system);
    run.set_state(start).expect("another state");
    assert_eq!(run.state(), start);
    let lost = State { p: SVector::from([f64::NAN, 0.0]), ..start };
    run.set_state(lost).expect_err("no state");
    assert_eq!(run.state(), start);
}

#[test]
fn stiff_steps_are_solved_by_newton() {
    let system = Stiff::default();
    // At rest in the stiff direction, so that its remaining motion measures the accuracy of the solution.
    let start = State::at(&system, 0.0, [0.0, 1.0], [0.0, 0.0]);
    let mut run = system.at_state(start).integrate(Gauss::<4>.in_transformed_time(), 0.2).expect("a valid start");
    let reached = run.by_ref().take(50).last().expect("steps").expect("a step");
    let exact = [reached.t.cos(), -reached.t.sin()];
    let off = (reached.q[1] - exact[0]).abs().max((reached.p[1] - exact[1]).abs());
    println!("at t = {:.3} off by {off:.1e}, x = {:.1e}", reached.t, reached.q[0]);
    // Measured: 1.9e-10.
    assert!(off < 3e-10 && reached.q[0].abs() < 1e-15, "{off:e}, {:e}", reached.q[0]);
    let moving = State::at(&system, 0.0, [1e-3, 1.0], [0.0, 0.0]);
    let mut run = system.at_state(moving).integrate(Gauss::<4>.in_transformed_time(), 0.2).expect("a valid start");
    for _ in 0..50 {
        let state = run.step().unwrap_or_else(|error| panic!("{error}"));
        assert!(state.q[0].abs() < 1.1e-3 && run.iterations() > 0);
    }
    // The run knows that it is stiff: fixed-point iteration was tried at the steps 1, 3, 6, 11, 20 and 37, and then not
    // for 32.
    assert!(format!("{:?}", run.checkpoint()).contains("next: 64"), "{:?}", run.checkpoint());
}

/// The error of a run, and that the run retains its last state and the error.
fn ends<const N: usize, const S: usize>(mut run: Run<InTransformedTime<Gauss<S>>, impl System<N>, N>) -> StepError {
    for _ in 0..10_000 {
        let before = run.state();
        if let Err(error) = run.step() {
            assert_eq!(run.state(), before);
            assert_eq!(run.step(), Err(error));
            return error;
        }
    }
    panic!("a run without an end");
}

#[test]
fn a_time_scale_that_is_not_positive_is_an_error_with_its_value() {
    let beyond = State::at(&Wall::default(), 0.5, [1.5], [1.0]);
    let error = Wall::default().at_state(beyond).integrate(Gauss::<4>.in_transformed_time(), 0.1).expect_err("g < 0");
    assert_eq!(error, StepError::TimeScale { t: 0.5, g: -0.5 });
    assert!(error.to_string().starts_with("the time scale is g = -5.000e-1 at t = 0.500000000"), "{error}");
    // A long step from before the wall.
    let before = State::at(&Wall::default(), 0.0, [0.0], [1.0]);
    let run =
        Wall::default().at_state(before).integrate(Gauss::<4>.in_transformed_time(), 30.0).expect("a valid start");
    let error = ends(run);
    assert!(matches!(error, StepError::TimeScale { g, .. } if g <= 0.0), "{error}");
    // A step beyond the wall, from a stage before it: x = 1.5 (1 − (x/2)⁸).
    let run = Wall { k: 0.0 }.at_state(before).integrate(Gauss::<1>.in_transformed_time(), 1.5).expect("a valid start");
    let error = ends(run);
    assert!(matches!(error, StepError::TimeScale { t, g } if (t - 1.40899).abs() < 1e-4 && g < -14.0), "{error}");
    // Short steps never arrive.
    let mut run =
        Wall::default().at_state(before).integrate(Gauss::<4>.in_transformed_time(), 0.1).expect("a valid start");
    let reached = run.by_ref().take(100).last().expect("steps").expect("a step");
    assert!((reached.q[0] - (1.0 - (-10.0_f64).exp())).abs() < 1e-13, "{reached:?}");
}

#[test]
fn a_system_without_a_time_scale_is_refused() {
    let system = Called(vi_systems::Pendulum::default());
    let error = system.at(0.0, [1.0], [0.0]).integrate(Gauss::<2>.in_transformed_time(), 0.1).expect_err("no g");
    assert_eq!(error, StepError::NoTimeScale { system: "Pendulum" });
    // A run with a time scale takes the same steps if its functions are inlined.
    let kepler = Kepler::default();
    let start = eccentric(&kepler);
    let mut runs = (
        kepler.at_state(start).integrate(Gauss::<4>.in_transformed_time(), 0.3).expect("a valid start"),
        Called(kepler).at_state(start).integrate(Gauss::<4>.in_transformed_time(), 0.3).expect("a valid start"),
    );
    for _ in 0..30 {
        let [one, other] = [runs.0.step(), runs.1.step()].map(|step| step.expect("a step"));
        // Measured: 0.
        assert!((one.q - other.q).amax() < 1e-13 && (one.p - other.p).amax() < 1e-13, "{one:?} and {other:?}");
    }
}

#[test]
fn invalid_steps_are_rejected_with_their_numbers() {
    let system = Kepler::default();
    let start = eccentric(&system);
    for dtau in [0.0, f64::NAN, f64::INFINITY, 1e-310] {
        let error = system.at_state(start).integrate(Gauss::<4>.in_transformed_time(), dtau).expect_err("no step");
        assert!(matches!(error, StepError::InvalidInput { input: "the step Δτ in transformed time", .. }), "{error}");
    }
    let lost = State { q: SVector::from([f64::NAN, 0.0]), ..start };
    let error = system.at_state(lost).integrate(Gauss::<4>.in_transformed_time(), 0.1).expect_err("no state");
    assert!(matches!(error, StepError::NonFinite { .. } | StepError::TimeScale { .. }), "{error}");
    // Half a period in one step.
    let error = ends(system.at_state(start).integrate(Gauss::<4>.in_transformed_time(), 40.0).expect("a valid start"));
    assert!(matches!(error, StepError::StagesNotConverged { .. } | StepError::NonFinite { .. }), "{error}");
}
