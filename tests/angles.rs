//! Angles: whole turns leave no trace in a motion, and everything that a user sees is continuous.
#![allow(clippy::cast_precision_loss, reason = "counts of turns and of events")]

use std::f64::consts::{PI, TAU};
use vi_core::derivatives::{Differentiable, Tangent, Variation};
use vi_core::real::Dual;
use vi_core::run::{Checkpoint, Crossing, DenseOutput, Event, Moment};
use vi_core::stepping::Convertible;
use vi_core::{
    Composition, EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, Lagrangian, Method, Run, Start,
    Starts, State, StepError, lagrangian,
};

lagrangian! {
    /// A rotor with an unbalance, and a clock.
    struct Rotor {
        param g = 2.0;
        angle θ;
        L = dot(θ)^2 / 2 + g * cos(θ);
        time_scale = 1 / (2 + cos(θ));
        discretize midpoint;
    }
}

lagrangian! {
    /// The same with a coordinate.
    struct Unreduced {
        param g = 2.0;
        coord θ;
        L = dot(θ)^2 / 2 + g * cos(θ);
        discretize midpoint;
    }
}

lagrangian! {
    /// A rod on a moving cart, with an engine and a brake.
    struct Cart {
        param g = 9.81, k = 3.0, T = 2.0, c = 0.1;
        coord x;
        angle θ;
        L = dot(x)^2 + dot(θ)^2 / 2 + dot(x) * dot(θ) * cos(θ) + g * cos(θ) - k * x^2 / 2;
        force θ = T;
        dissipation = c * dot(θ)^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two rotors that see each other.
    struct Pair {
        param k = 1.5;
        angle q[2];
        L = dot(q[0])^2 / 2 + dot(q[1])^2 / 3 + k * cos(q[0] - q[1]) + cos(2 * q[1]);
        discretize midpoint;
    }
}

lagrangian! {
    /// A planet: its energy-preserving steps exist everywhere.
    struct Planet {
        coord r;
        angle φ;
        L = (dot(r)^2 + r^2 * dot(φ)^2) / 2 + 1 / r;
        discretize midpoint;
    }
}

/// Turns that a number of sixteen digits cannot carry beside an angle.
const TURNS: i64 = 10_000_000;

/// A planet on an ellipse.
fn planet() -> Start<Planet, 2> {
    Planet::default().at(0.3, [1.0, 0.4], [0.1, 1.1])
}

/// Two runs of the same steps, one of them with further turns: everything but the turns has equal bits.
fn same_bits<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize>(run: Run<M, S, N>, turns: [i64; N], steps: u32) {
    let (mut one, mut other) = (run.clone(), run);
    other.set_turns(turns).expect("turns of angles");
    let begun = one.turns();
    for step in 0..steps {
        let (a, b) = (one.step().expect("a step"), other.step().expect("a step"));
        assert_eq!(one.node(), other.node(), "step {step}");
        assert_eq!(one.reduced(), other.reduced(), "step {step}");
        assert_eq!((one.velocity(), one.energy()), (other.velocity(), other.energy()), "step {step}");
        let difference = |i: usize| other.turns()[i] - one.turns()[i];
        for i in 0..N {
            assert_eq!(difference(i), turns[i] - begun[i], "step {step}");
            let moved = TAU * difference(i) as f64;
            let rounding = f64::EPSILON * (a.q[i].abs() + b.q[i].abs() + moved.abs());
            assert!((b.q[i] - a.q[i] - moved).abs() <= rounding, "step {step}: {a:?} {b:?}");
            let back = one.reduced()[i] + TAU * one.turns()[i] as f64;
            assert!((back - a.q[i]).abs() <= 4.0 * f64::EPSILON * a.q[i].abs(), "step {step}: {back} {a:?}");
            assert!(!S::SPACES[i].is_angle() || one.reduced()[i].abs() <= PI, "step {step}");
        }
    }
    assert!((0..N).any(|i| one.turns()[i] != begun[i]), "{:?}", one.turns());
}

#[test]
fn turns_change_no_bit_of_any_method() {
    let rotor = Rotor::default().at(0.3, [0.4], [7.0]);
    let turns = [TURNS];
    same_bits(rotor.integrate(FixedStep, 0.1).expect("a start"), turns, 300);
    same_bits(rotor.integrate(FixedStep.connected(), 0.1).expect("a start"), turns, 20);
    same_bits(rotor.integrate(Composition::TRIPLE_JUMP_4, 0.1).expect("a start"), turns, 300);
    same_bits(rotor.integrate(Gauss::<3>, 0.1).expect("a start"), turns, 300);
    // Several turns in a step, forwards and backwards.
    same_bits(rotor.integrate(Gauss::<8>, 1.5).expect("a start"), turns, 100);
    same_bits(rotor.integrate(Gauss::<2>, -0.1).expect("a start"), turns, 300);
    let energy = rotor.integrate(EnergyPreserving, 0.1).expect("a start").with_fallback(Fallback::FixedSteps);
    same_bits(energy, turns, 300);
    let shifted = rotor.integrate(EnergyPreservingGauss::<2>, 0.1).expect("a start").with_shift_from(2.0);
    same_bits(shifted.expect("a shift"), turns, 300);
    same_bits(planet().integrate(EnergyPreserving, 0.1).expect("a start"), [0, TURNS], 300);
    same_bits(planet().integrate(EnergyPreservingGauss::<2>, 0.1).expect("a start"), [0, TURNS], 300);
    same_bits(rotor.integrate(Gauss::<3>.in_transformed_time(), 0.2).expect("a start"), turns, 300);
    let cart = Cart::default().at(0.0, [0.1, 3.0], [0.3, 9.0]);
    same_bits(cart.integrate(FixedStep, 0.05).expect("a start"), [0, TURNS], 300);
    same_bits(cart.integrate(Gauss::<4>, 0.02).expect("a start"), [0, -TURNS], 300);
    let pair = Pair::default().at(0.0, [0.1, 3.0], [5.0, -8.0]);
    same_bits(pair.integrate(FixedStep, 0.05).expect("a start"), [TURNS, -3], 300);
    same_bits(pair.integrate(Gauss::<4>, 0.1).expect("a start"), [-5, TURNS], 300);
}

#[test]
fn an_angle_has_the_motion_of_a_coordinate() {
    let (q, v) = ([0.4], [7.0]);
    let angle = Rotor::default().at(0.0, q, v).integrate(Gauss::<6>, 0.05).expect("a start").until(20.0);
    let coordinate = Unreduced::default().at(0.0, q, v).integrate(Gauss::<6>, 0.05).expect("a start").until(20.0);
    let (angle, coordinate) = (angle.expect("an end"), coordinate.expect("an end"));
    assert!(angle.q[0] > 20.0 * TAU);
    // Measured: 4e-14, 2e-15.
    assert!(
        (angle.q - coordinate.q).amax() < 1e-12 && (angle.p - coordinate.p).amax() < 1e-13,
        "{angle:?} {coordinate:?}"
    );
}

#[test]
fn a_start_is_reduced_as_the_number_that_it_is() {
    // 1e9 less 159154943 turns, from 120 digits of 2π.
    let rest = 0.577_395_423_501_385_2;
    let mut far = Rotor::default().at(0.0, [1e9], [3.0]).integrate(FixedStep, 0.01).expect("a start");
    let mut near = Rotor::default().at(0.0, [rest], [3.0]).integrate(FixedStep, 0.01).expect("a start");
    assert_eq!((far.turns(), far.reduced()[0].to_bits()), ([159_154_943], rest.to_bits()));
    assert_eq!(far.state().q[0].to_bits(), 1e9_f64.to_bits());
    for _ in 0..1000 {
        far.step().expect("a step");
        near.step().expect("a step");
    }
    let difference = far.reduced() - near.reduced();
    // The start differs by 5e-18. Measured: 4e-16.
    assert!(difference.amax() < 4e-15, "{difference}");
    assert!(far.state().q[0] > 1e9 + 20.0);
    // The number that is given again continues the same motion.
    let State { t, p, .. } = near.state();
    near.set_state(State { t, q: [-1e9].into(), p }).expect("a state");
    assert_eq!((near.turns(), near.reduced()[0].to_bits()), ([-159_154_943], (-rest).to_bits()));
    // Beyond 2^53 turns.
    let refused = Rotor::default().at(0.0, [1e20], [3.0]).integrate(FixedStep, 0.01).expect_err("no angle");
    assert!(matches!(refused, StepError::InvalidInput { input: "an angle", .. }), "{refused}");
    let refused = near.set_state(State { t, q: [1e20].into(), p }).expect_err("no angle");
    assert!(matches!(refused, StepError::InvalidInput { input: "an angle", .. }), "{refused}");
    assert!(near.step().is_ok());
    let mut cart = Cart::default().at(0.0, [0.1, 0.0], [0.0; 2]).integrate(FixedStep, 0.01).expect("a start");
    assert!(matches!(cart.set_turns([1, 0]), Err(StepError::InvalidInput { value: 1.0, .. })));
    assert!(matches!(cart.set_turns([0, 1 << 60]), Err(StepError::InvalidInput { input: "an angle", .. })));
}

/// The times at which θ is a whole number of turns, by events of a run.
fn crossings<M: Method<Rotor, 1>>(method: M, h: f64, turns: i64, end: f64) -> Vec<f64> {
    let mut run = Rotor::default().at(0.0, [0.4], [7.0]).integrate(method, h).expect("a start");
    run.set_turns([turns]).expect("turns");
    let half = |q: f64| (0.5 * q).sin();
    let crossings: Vec<_> = run.events(Event::crossing(move |moment| half(moment.q[0])), end).collect();
    let state = |crossing: &Result<Crossing<1>, StepError>| crossing.as_ref().expect("an event").state;
    for (index, crossing) in crossings.iter().enumerate() {
        let State { q, .. } = state(crossing);
        let turn = turns as f64 + index as f64 + 1.0;
        assert!((q[0] - TAU * turn).abs() <= 4.0 * f64::EPSILON * q[0].abs(), "{q} is not {turn} turns");
    }
    crossings.iter().map(|crossing| state(crossing).t).collect()
}

#[test]
fn every_turn_is_an_event_once() {
    let end = 50.0;
    for h in [0.037, 0.3] {
        let near = crossings(Gauss::<6>, h, 0, end);
        let mut run = Rotor::default().at(0.0, [0.4], [7.0]).integrate(Gauss::<6>, h).expect("a start");
        let whole = (run.until(end).expect("an end").q[0] / TAU).floor();
        assert!((near.len() as f64 - whole).abs() < 0.5, "h = {h}");
        // With turns, the angle of an event has eight digits less.
        let far = crossings(Gauss::<6>, h, TURNS, end);
        assert_eq!(far.len(), near.len());
        let late = near.iter().zip(&far).map(|(near, far)| (near - far).abs()).fold(0.0, f64::max);
        // Measured: 1e-9, a rounding of the angle over its velocity.
        assert!(late < 4e-9, "{late:e}");
    }
    assert_eq!(crossings(FixedStep, 0.05, 0, end).len(), crossings(FixedStep, 0.05, 7, end).len());
}

#[test]
fn an_event_on_the_border_is_met() {
    // Multiples of π, where the angle changes its turn, and of 4, where a step reduces it.
    let mut run = Rotor::default().at(0.0, [0.0], [7.0]).integrate(FixedStep, 0.05).expect("a start");
    for k in 1..60_i32 {
        let at = f64::from(k) * PI;
        let crossing = run.until_rising(move |moment| moment.q[0] - at, 1e3).expect("steps").expect("an event");
        assert!((crossing.state.q[0] - at).abs() <= f64::EPSILON * 4.0 * at && run.state() == crossing.state, "{k}");
    }
    // A rotor that swings about the upper point crosses it again and again, without more events than swings.
    let swing = Rotor { g: -2.0 };
    let mut run = swing.at(0.0, [PI], [0.5]).integrate(FixedStep, 0.05).expect("a start");
    let mut plain = Unreduced { g: -2.0 }.at(0.0, [PI], [0.5]).integrate(FixedStep, 0.05).expect("a start");
    let met =
        run.events(Event::crossing(|moment| moment.q[0] - PI), 100.0).map(|event| event.expect("an event").state.t);
    let met: Vec<f64> = met.collect();
    let expected =
        plain.events(Event::crossing(|moment| moment.q[0] - PI), 100.0).map(|event| event.expect("an event").state.t);
    let expected: Vec<f64> = expected.collect();
    assert_eq!(met.len(), expected.len());
    assert!(met.len() > 40 && met.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{met:?}");
    // An oscillation of less than 4 - π is never reduced.
    assert_eq!(run.node().q[0].to_bits(), run.state().q[0].to_bits());
}

/// The largest jumps of the dense output from the states at both ends of its step.
fn jumps<M: Method<Rotor, 1>>(method: M, turns: i64, h: f64) -> [f64; 2] {
    let mut run = Rotor::default().at(0.0, [0.4], [7.0]).integrate(method, h).expect("a start");
    run.set_turns([turns]).expect("turns");
    let (mut ends, mut between) = (0.0_f64, 0.0_f64);
    for _ in 0..200 {
        let before = run.state();
        let after = run.step().expect("a step");
        let path = run.dense_output(&before).expect("a path");
        let rounding = f64::EPSILON * after.q[0].abs();
        for end in [before, after] {
            ends = ends.max((path.state(end.t).q - end.q).amax() / rounding);
        }
        let middle = 0.5 * (before.t + after.t);
        let mut aside = Rotor::default().at_state(before).integrate(Gauss::<8>, middle - before.t).expect("a start");
        between = between.max((aside.step().expect("a step").q - path.state(middle).q).amax());
        between = between.max((path.velocity(middle) - aside.velocity().expect("a velocity")).amax());
    }
    [ends, between]
}

#[test]
fn dense_output_continues_over_a_reduction() {
    for turns in [0, 1000] {
        // Roundings of the angle at the ends, and the error of the polynomial. Measured: 2 and 4e-6; 2 and 5e-6; 2 and 5e-4.
        let [ends, between] = jumps(Gauss::<4>, turns, 0.05);
        assert!(ends <= 8.0 && between < 1e-4, "{ends} {between:e}");
        let [ends, between] = jumps(FixedStep, turns, 0.02);
        assert!(ends <= 8.0 && between < 1e-3, "{ends} {between:e}");
        let [ends, between] = jumps(Gauss::<4>.in_transformed_time(), turns, 0.1);
        assert!(ends <= 16.0 && between < 1e-3, "{ends} {between:e}");
    }
}

/// Restarts after each step, with turns: the next steps equal those of the uninterrupted run. A macro, since this
/// program does not name the traits of a format.
macro_rules! resumes {
    ($start:expr, $method:expr) => {{
        let Start { system, .. } = $start;
        let mut whole = $start.integrate($method, 0.1).expect("a start");
        // The last coordinate is an angle.
        let mut turns = whole.turns();
        turns.reverse();
        turns[0] = TURNS;
        turns.reverse();
        whole.set_turns(turns).expect("turns");
        let mut resumed = whole.clone();
        for step in 0..100 {
            let text = serde_json::to_string(&resumed.checkpoint()).expect("numbers");
            let stored: Checkpoint<_, _> = serde_json::from_str(&text).expect("the same numbers");
            resumed = Run::restart(system, $method, stored).expect("a checkpoint of this system");
            let (next, again) = (whole.step().expect("a step"), resumed.step().expect("a step"));
            assert_eq!((next, whole.turns()), (again, resumed.turns()), "step {step}");
            assert_eq!(format!("{:?}", whole.checkpoint()), format!("{:?}", resumed.checkpoint()));
        }
        assert!(whole.turns().last().is_some_and(|turns| *turns > TURNS));
    }};
}

#[test]
fn checkpoints_carry_the_turns() {
    let rotor = || Rotor::default().at(0.3, [0.4], [7.0]);
    resumes!(rotor(), FixedStep);
    resumes!(rotor(), Gauss::<3>);
    resumes!(planet(), EnergyPreserving);
    resumes!(planet(), EnergyPreservingGauss::<2>);
    // A file of before has no turns, and one of a system without angles none but zero.
    let mut run = Unreduced::default().at(0.0, [0.4], [7.0]).integrate(FixedStep, 0.1).expect("a start");
    run.step().expect("a step");
    let text = serde_json::to_string(&run.checkpoint()).expect("numbers");
    assert!(text.contains("\"turns\":[0]"), "{text}");
    let read = |text: &str| Run::restart(Unreduced::default(), FixedStep, serde_json::from_str(text).expect("numbers"));
    assert_eq!(read(&text.replace("\"turns\":[0],", "")).expect("a checkpoint").state(), run.state());
    let refused = read(&text.replace("\"turns\":[0]", "\"turns\":[3]")).expect_err("no angle");
    assert!(matches!(refused, StepError::InvalidInput { value: 3.0, .. }), "{refused}");
}

/// Tangent vectors of a run with and without turns of its last coordinate.
fn same_tangent<M, S, const N: usize>(start: Start<S, N>, method: M, h: f64)
where
    M: Differentiable<S, N>,
    S: Convertible<N>,
{
    let start = start.integrate(method, h).expect("a start");
    let mut turned = start.clone();
    let mut turns = [0; N];
    turns[N - 1] = TURNS;
    turned.set_turns(turns).expect("turns");
    let of = |run| Tangent::from_start(run, Variation::of_state()).expect("a start");
    let (mut one, mut other) = (of(start), of(turned));
    for step in 0..100 {
        one.step().expect("a step");
        other.step().expect("a step");
        assert_eq!(one.variations(), other.variations(), "step {step}");
    }
    let t = one.run().t() + 1.234;
    one.until(t).expect("a time");
    other.until(t).expect("a time");
    assert_eq!(one.variations(), other.variations());
    one.step_of(0.01).expect("a step");
    other.step_of(0.01).expect("a step");
    assert_eq!(one.variations(), other.variations());
    assert!(one.run().turns()[N - 1] > 0 && other.run().turns()[N - 1] > TURNS);
}

#[test]
fn turns_have_no_derivative() {
    let rotor = Rotor::default().at(0.3, [0.4], [7.0]);
    same_tangent(rotor, FixedStep, 0.05);
    same_tangent(rotor, Composition::TRIPLE_JUMP_4, 0.05);
    same_tangent(rotor, Gauss::<3>, 0.05);
    same_tangent(rotor, Gauss::<3>.in_transformed_time(), 0.1);
    same_tangent(planet(), EnergyPreserving, 0.1);
    same_tangent(planet(), EnergyPreservingGauss::<2>, 0.1);
    // Up to an event far away, against differences of its state.
    let event = || Event::smooth_rising(|m: &Moment<1, Dual<f64>>| m.q[0] - Dual::fixed(100.0));
    let run = |v: f64| Rotor::default().at(0.0, [0.4], [v]).integrate(Gauss::<6>, 0.05).expect("a start");
    let mut tangent = Tangent::new(run(7.0), Variation::of_state());
    let met = tangent.until_event(&event(), 100.0).expect("steps").expect("an event").state;
    let step = 1e-4;
    let [less, more] = [-step, step]
        .map(|change| run(7.0 + change).until_event(event(), 100.0).expect("steps").expect("an event").state);
    let slope = (more.t - less.t) / (2.0 * step);
    // Measured: 1e-8, relative.
    assert!((tangent.variations()[1].t / slope - 1.0).abs() < 1e-6, "{} {slope} {met:?}", tangent.variations()[1].t);
}

#[test]
fn measured_errors_do_not_see_turns() {
    let start = Rotor::default().at(0.3, [0.4], [7.0]).integrate(FixedStep, 0.05).expect("a start");
    let mut turned = start.clone();
    turned.set_turns([TURNS]).expect("turns");
    let (mut one, mut other) = (start.monitored(), turned.monitored());
    for _ in 0..2000 {
        assert_eq!(one.run().local_error(), other.run().local_error());
        one.step().expect("a step");
        other.step().expect("a step");
    }
    let mut plain = Unreduced::default().at(0.3, [0.4], [7.0]).integrate(FixedStep, 0.05).expect("a start").monitored();
    for _ in 0..2000 {
        plain.step().expect("a step");
    }
    let [one, other, plain] = [one.largest(), other.largest(), plain.largest()].map(|found| found.estimate);
    assert!(plain > 1e-9 && (one / plain - 1.0).abs() < 1e-6, "{one:e} {plain:e}");
    // Beside 6e7 an excursion has eight digits.
    assert!((other / one - 1.0).abs() < 1e-6, "{other:e} {one:e}");
}

#[test]
fn output_at_times_is_continuous_and_has_exact_energies() {
    let run = || {
        let mut run = Rotor::default().at(0.0, [0.4], [7.0]).integrate(Gauss::<6>, 0.1).expect("a start");
        run.set_turns([TURNS]).expect("turns");
        run
    };
    let times = (1..400).map(|index| 0.0251 * f64::from(index));
    let solution = run().at_times(times).expect("states");
    let energy = solution.energies[0];
    for (before, after) in solution.states.iter().zip(&solution.states[1..]) {
        let moved = after.q[0] - before.q[0];
        assert!(moved > 0.0 && moved < 0.3, "{before:?} {after:?}");
    }
    let off = solution.energies.iter().map(|of| (of - energy).abs()).fold(0.0, f64::max);
    // Measured: 7e-14. The rounding of θ alone, 7e-9, would give 1e-8.
    assert!(off < 1e-12, "{off:e}");
}
