//! Features of all integrators at their edges: times, events, inputs, changed states; against closed forms.

use core::f64::consts::{PI, TAU};
use vi_core::run::{Crossing, DenseOutput, Event, Met};
use vi_core::{
    Composition, EnergyPreserving, FixedStep, Gauss, Lagrangian, Method, Run, SVector, Starts, State, StepError,
    lagrangian,
};
use vi_systems::{DoublePendulum, DoubleWell, HarmonicOscillator, HenonHeiles, Kepler, Pendulum};

lagrangian! {
    /// A body on a spring with a force that is constant between steps.
    struct Pushed {
        param m = 1.7, k = 2.3, u = 0.0;
        coord x;
        L = m * dot(x)^2 / 2 - k * x^2 / 2 - x^4 / 5;
        force x = u;
        discretize midpoint;
    }
}

lagrangian! {
    /// A ball above the floor.
    struct Ball {
        param g = 9.81;
        coord z;
        L = dot(z)^2 / 2 - g * z;
        discretize midpoint;
    }
}

fn distance<const N: usize>(a: &State<N>, b: &State<N>) -> f64 {
    (a.q - b.q).norm() + (a.p - b.p).norm()
}

#[test]
fn runs_to_multiples_of_a_step_take_plain_steps() {
    let well = DoubleWell::default();
    let start = State::at(&well, 0.0, [0.8], [0.0]);
    for h in [0.1, 0.3, 1.0 / 3.0, -0.07] {
        let mut plain = well.at_state(start).integrate(FixedStep, h).expect("valid");
        let mut asked = plain.clone();
        for step in 1..=300_u32 {
            let state = plain.step().expect("solvable");
            if step % 30 == 0 {
                let reached = asked.until(f64::from(step) * h).expect("solvable");
                // Rounding of the time may change the last step: 1.8e-15.
                assert!(distance(&reached, &state) < 1e-14, "{h}, {step}: {}", distance(&reached, &state));
            }
        }
    }
}

#[test]
fn times_behind_or_beyond_all_are_typed_errors() {
    let well = DoubleWell::default();
    let start = State::at(&well, 1.0, [0.8], [0.0]);
    let mut run = well.at_state(start).integrate(FixedStep, 0.1).expect("valid");
    for t in [0.5, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let Err(StepError::InvalidInput { input, value, .. }) = run.until(t) else { panic!("{t}") };
        assert_eq!((input, value.to_bits()), ("the time to propagate to", t.to_bits()));
        let asked = run.states_at([t]).next();
        assert!(matches!(asked, Some(Err(StepError::InvalidInput { .. }))), "{asked:?}");
        assert!(matches!(run.next_event(Vec::new(), t), Err(StepError::InvalidInput { .. })));
        assert_eq!(run.state(), start, "the run stays");
    }
    for h in [0.0, f64::NAN, 1e-320] {
        assert!(matches!(run.step_of(h), Err(StepError::InvalidInput { .. })), "{h}");
    }
    assert!(run.step().is_ok(), "the run goes on");
}

/// Zeros of the angle of a pendulum from 2 rad, rising.
fn rising<M: Method<S, 1>, S: Lagrangian<1> + Copy>(mut run: Run<M, S, 1>, end: f64) -> Vec<f64> {
    let events = Event::rising(|s| s.q[0]);
    let found: Vec<_> = run.events(&events, end).map(|crossing| crossing.expect("solvable")).collect();
    assert_eq!(run.t().to_bits(), end.to_bits(), "the run ends at the given time");
    for crossing in &found {
        assert!(crossing.events == [Met { event: 0, is_rising: true }] && crossing.v[0] > 0.0);
        // 5.6e-17.
        assert!(crossing.state.q[0].abs() < 1e-15, "{}", crossing.state.q[0]);
    }
    found.iter().map(|crossing| crossing.state.t).collect()
}

/// The arithmetic-geometric mean.
fn mean(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

#[test]
fn the_period_of_a_pendulum() {
    let pendulum = Pendulum::default();
    let start = State::at(&pendulum, 0.0, [2.0], [0.0]);
    // T = 2π / (ω agm(1, cos(θ0/2))), ω² = g/l: with the default parameters ω = 1.
    let period = TAU / mean(1.0, 1.0_f64.cos());
    let rises = |times: &[f64]| {
        assert_eq!(times.len(), 12);
        let expected = (0..12).map(|k| (f64::from(k) + 0.75) * period);
        times.iter().zip(expected).map(|(t, exact)| (t - exact).abs()).fold(0.0, f64::max)
    };
    let end = 12.0 * period;
    let gauss = rises(&rising(pendulum.at_state(start).integrate(Gauss::<8>, 0.4).expect("valid"), end));
    // 4.3e-14.
    assert!(gauss < 2e-13, "{gauss}");
    let errors =
        [0.05, 0.025].map(|h| rises(&rising(pendulum.at_state(start).integrate(FixedStep, h).expect("valid"), end)));
    let slope = (errors[0] / errors[1]).log2();
    assert!((slope - 2.0).abs() < 0.1, "{slope}");
    let composed = pendulum.at_state(start).integrate(Composition::KAHAN_LI_6, 0.2).expect("valid");
    // 5.2e-7.
    assert!(rises(&rising(composed, end)) < 1e-6);
    let energy = EnergyPreserving::from_midpoint(pendulum, 0.0, [2.0], [0.0], 0.02).expect("valid");
    let error = rises(&rising(energy, end));
    // 1.2e-3.
    assert!(error < 2e-3, "{error}");
}

#[test]
fn two_events_in_a_step_and_one_that_only_touches() {
    let oscillator = HarmonicOscillator { k: 1.0, ..HarmonicOscillator::default() };
    let start = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let run = || oscillator.at_state(start).integrate(Gauss::<10>, 0.5).expect("valid");
    let times = |event: Event<1>| -> Vec<f64> {
        run().events(event, 13.0).map(|crossing| crossing.expect("solvable").state.t).collect()
    };
    for level in [0.0_f64, 0.9, 0.999, 1.0 - 1e-6, 1.0 - 1e-10] {
        let angle = level.acos();
        let expected = [angle, TAU - angle, TAU + angle, 2.0 * TAU - angle, 2.0 * TAU + angle];
        let expected: Vec<f64> = expected.into_iter().filter(|t| *t < 13.0).collect();
        let found = times(Event::crossing(move |s| s.q[0] - level));
        assert_eq!(found.len(), expected.len(), "{level}: {found:?}");
        for (t, exact) in found.iter().zip(&expected) {
            // Near tangency, a rounding of x is a large error in t: 1.8e-15 at 0.9, 7.2e-15 at 0.999, 1.7e-13, 2.2e-11.
            assert!((t - exact).abs() < 6e-16 / (1.0 - level * level).sqrt() + 2e-15, "{level}: {t} {exact}");
        }
        let rising = times(Event::rising(move |s| s.q[0] - level));
        let falling = times(Event::falling(move |s| s.q[0] - level));
        assert_eq!(rising.len() + falling.len(), found.len());
        assert!(rising.iter().zip(&falling).all(|(up, down)| down < up), "it falls first");
    }
    // A level that is not reached, or only touched, is not an event.
    assert!(times(Event::crossing(|s| s.q[0] - (1.0 + 1e-9))).is_empty());
}

#[test]
fn several_functions_in_one_step_come_in_their_order() {
    let oscillator = HarmonicOscillator { k: 1.0, ..HarmonicOscillator::default() };
    let start = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let mut run = oscillator.at_state(start).integrate(Gauss::<10>, 2.0).expect("valid");
    let events = [Event::crossing(|s| s.t - 1.3), Event::crossing(|s| s.q[0]), Event::crossing(|s| s.v[0] + 0.5)];
    let found: Vec<_> = run.events(&events, 4.0).map(|crossing| crossing.expect("solvable")).collect();
    assert!(found.iter().all(|crossing| crossing.events.len() == 1));
    let order: Vec<usize> = found.iter().map(|crossing| crossing.events[0].event).collect();
    assert_eq!(order, [2, 0, 1, 2]);
    for (crossing, exact) in found.iter().zip([PI / 6.0, 1.3, PI / 2.0, 5.0 * PI / 6.0]) {
        assert!((crossing.state.t - exact).abs() < 1e-14, "{crossing:?}");
    }
}

#[test]
fn a_run_that_stops_at_an_event_continues_from_it() {
    let oscillator = HarmonicOscillator { k: 1.0, ..HarmonicOscillator::default() };
    let start = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let mut run = oscillator.at_state(start).integrate(Gauss::<6>, 0.3).expect("valid");
    let events = [Event::crossing(|s| s.q[0])];
    for half in 0..200 {
        let crossing = run.next_event(&events, 1e4).expect("solvable").expect("there is one");
        assert_eq!(crossing.state, run.state());
        let exact = (f64::from(half) + 0.5) * PI;
        // Each event once: 1.2e-13, of 628.
        assert!((run.t() - exact).abs() < 5e-13, "{half}: {} {exact}", run.t());
    }
    let start = run.t();
    assert_eq!(run.next_event(&events, start + 1.0), Ok(None));
    assert_eq!(run.t().to_bits(), (start + 1.0).to_bits());
    // A run that starts at a zero leaves it.
    let start = State::at(&oscillator, 0.0, [0.0], [1.0]);
    let mut run = oscillator.at_state(start).integrate(FixedStep, 0.1).expect("valid");
    let first = run.next_event(&events, 10.0).expect("solvable").expect("there is one");
    assert!((first.state.t - PI).abs() < 0.01 && first.direction(0) == Some(false), "{first:?}");
}

#[test]
fn an_event_function_that_is_not_finite_is_a_typed_error() {
    let oscillator = HarmonicOscillator { k: 1.0, ..HarmonicOscillator::default() };
    let start = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let mut run = oscillator.at_state(start).integrate(FixedStep, 0.1).expect("valid");
    let mut found = run.events(Event::crossing(|s| s.q[0].ln()), 10.0);
    let failure = found.next();
    assert!(matches!(failure, Some(Err(StepError::NonFinite { quantity: "function of an event", .. }))), "{failure:?}");
    assert_eq!(found.next(), None);
}

#[test]
fn a_section_of_henon_and_heiles() {
    let system = HenonHeiles::default();
    // Energy 1/12 on the section x = 0: p_x from it.
    let (y, p_y) = (0.1_f64, 0.0_f64);
    let p_x = (2.0_f64 * (1.0 / 12.0) - p_y * p_y - y * y + 2.0 * y * y * y / 3.0).sqrt();
    let start = State::at(&system, 0.0, [0.0, y], [p_x, p_y]);
    let events = Event::rising(|s| s.q[0]);
    let section = |h: f64| -> Vec<State<2>> {
        let mut run = system.at_state(start).integrate(Gauss::<8>, h).expect("valid");
        run.events(&events, 300.0).map(|crossing| crossing.expect("solvable").state).collect()
    };
    let coarse = section(0.5);
    let fine = section(0.21);
    // The start is not an event; later ones are, with either step.
    assert_eq!((coarse.len(), fine.len()), (fine.len(), coarse.len()));
    assert!(coarse.len() > 40, "{}", coarse.len());
    for (a, b) in coarse.iter().zip(&fine) {
        // 2.2e-15 and 2.8e-17.
        assert!(distance(a, b) < 1e-14 && a.q[0].abs() < 1e-15, "{a:?} {b:?}");
        let energy = a.energy(&system).expect("regular");
        // 9.8e-17.
        assert!((energy - 1.0 / 12.0).abs() < 1e-15, "{energy}");
    }
}

/// Advances to the next impact, reverses the momentum, and returns the time.
fn bounce<M: Method<S, 1>, S: Lagrangian<1> + Copy>(run: &mut Run<M, S, 1>) -> f64 {
    let hit = run.until_falling(|s| s.q[0], 100.0).expect("solvable").expect("it falls");
    run.set_state(State { p: -hit.state.p, ..hit.state }).expect("valid");
    hit.state.t
}

#[test]
fn a_ball_bounces() {
    let ball = Ball::default();
    let mut run = ball.at(0.0, [1.3], [0.0]).integrate(FixedStep, 0.037).expect("valid");
    let fall = (2.0_f64 * 1.3 / 9.81).sqrt();
    for count in 0..20 {
        let t = bounce(&mut run);
        let exact = (2.0 * f64::from(count) + 1.0) * fall;
        // The midpoint rule is exact under constant forces: 3.6e-15.
        assert!((t - exact).abs() < 1e-14, "{count}: {t} {exact}");
    }
}

#[test]
fn the_last_step_is_reported_with_the_new_parameters() {
    let system = Pushed { u: 0.3, ..Pushed::default() };
    let start = State::at(&system, 0.0, [0.4], [0.2]);
    let h = 0.1;
    let mut fixed = system.at_state(start).integrate(FixedStep, h).expect("valid");
    let before = fixed.step().expect("solvable");
    let after = fixed.step().expect("solvable");
    let mut gauss = system.at_state(start).integrate(Gauss::<4>, h).expect("valid");
    let gauss_before = gauss.step().expect("solvable");
    let gauss_after = gauss.step().expect("solvable");
    assert!(gauss.discrete_energy().is_some() && gauss.slots().is_some());
    let (m, k, u) = (1.9, 3.1, -0.4);
    let change = |system: &mut Pushed| (system.m, system.k, system.u) = (m, k, u);
    fixed.set_parameters(change).and_then(|()| gauss.set_parameters(change)).expect("regular");
    // By hand: E1 = H at the midpoint plus the second half of the work; H at the node with v = p/m.
    let energy = |x: f64, v: f64| m * v * v / 2.0 + k * x * x / 2.0 + x.powi(4) / 5.0;
    let (x0, x1) = (before.q[0], after.q[0]);
    let path = fixed.dense_output(&before).expect("regular");
    let gauss_path = gauss.dense_output(&gauss_before).expect("regular");
    let errors = [
        fixed.discrete_energy().expect("a step") - energy(f64::midpoint(x0, x1), (x1 - x0) / h) - u * (x1 - x0) / 2.0,
        fixed.energy().expect("regular") - energy(x1, after.p[0] / m),
        path.velocity(before.t)[0] - before.p[0] / m,
        path.velocity(after.t)[0] - after.p[0] / m,
        gauss.energy().expect("regular") - energy(gauss_after.q[0], gauss_after.p[0] / m),
        gauss_path.velocity(gauss_before.t)[0] - gauss_before.p[0] / m,
        gauss_path.velocity(gauss_after.t)[0] - gauss_after.p[0] / m,
    ];
    // Measured 6.7e-17.
    assert!(errors.iter().all(|error| error.abs() < 1e-15), "{errors:?}");
    assert_eq!((gauss.discrete_energy(), gauss.slots().is_none()), (None, true));
    // Coordinates and momenta are unchanged, and the next step is predicted again.
    assert_eq!((fixed.state(), gauss.state()), (after, gauss_after));
    gauss.step().expect("solvable");
    assert!(gauss.discrete_energy().is_some() && gauss.slots().is_some());
}

#[test]
fn the_energy_that_a_change_brings_is_accounted_for() {
    let system = Pushed { u: 0.3, ..Pushed::default() };
    let mut run = EnergyPreserving::from_midpoint(system, 0.0, [0.7], [0.0], 0.02).expect("valid");
    let mut brought = 0.0;
    let mut work = 0.0;
    let e0 = run.node().energy;
    for step in 0..100 {
        if step % 10 == 5 {
            let before = run.energy().expect("regular");
            run.set_parameters(|system| system.k *= 1.01).expect("regular");
            brought += run.energy().expect("regular") - before;
        }
        let q0 = run.state().q;
        run.step().expect("solvable");
        work += 0.3 * (run.state().q - q0)[0];
        let error = run.node().energy - e0 - brought - work;
        // 1.7e-16.
        assert!(error.abs() < 1e-15, "{step}: {error}");
    }
    assert!(brought > 1e-3, "{brought}");
    // H follows the preserved energy.
    let difference = run.energy().expect("regular") - run.node().energy;
    // 7.0e-5.
    assert!(difference.abs() < 1e-4, "{difference}");
}

/// Asserts that a run rejects invalid parameters and states, and continues.
fn refuses<M: Method<Pushed, 1>>(mut run: Run<M, Pushed, 1>) {
    run.step().expect("solvable");
    let state = run.state();
    for m in [0.0, f64::NAN] {
        let refused = run.set_parameters(|system| system.m = m);
        let is_told = match refused {
            Err(StepError::Singular { .. }) => m == 0.0,
            Err(StepError::InvalidInput { input: "a parameter", .. }) => m.is_nan(),
            _ => false,
        };
        assert!(is_told, "{refused:?}");
    }
    assert_eq!((run.state(), run.system().m.to_bits()), (state, 1.7_f64.to_bits()));
    run.step().expect("the run goes on");
    let lost = State { q: SVector::from([f64::NAN]), ..state };
    assert!(matches!(run.set_state(lost), Err(StepError::NonFinite { .. })));
    run.step().expect("the run goes on");
}

#[test]
fn parameters_with_which_nothing_moves_are_refused() {
    let system = Pushed::default();
    let start = State::at(&system, 0.0, [0.4], [0.2]);
    refuses(system.at_state(start).integrate(FixedStep, 0.1).expect("valid"));
    refuses(system.at_state(start).integrate(Composition::SUZUKI_4, 0.1).expect("valid"));
    refuses(system.at_state(start).integrate(Gauss::<4>, 0.1).expect("valid"));
    refuses(EnergyPreserving::from_midpoint(system, 0.0, [0.4], [0.2], 0.05).expect("valid"));
}

#[test]
fn a_shorter_step_passes_the_place_of_an_error() {
    // Kepler's orbit with e = 0.9 from the apocentre: near the pericentre the stages of a step of 0.5 do not converge.
    let kepler = Kepler::default();
    let start = kepler.at(0.0, [1.9, 0.0], [0.0, (0.1_f64 / 1.9).sqrt()]);
    let mut run = start.integrate(Gauss::<8>, 0.5).expect("a start");
    let error = run.until(100.0).expect_err("a pericentre");
    let StepError::StagesNotConverged { t, h, .. } = error else { panic!("{error}") };
    assert_eq!((run.step(), run.t(), h), (Err(error), t, 0.5), "the error repeats");
    assert!(run.step_of(0.5).is_err() && run.step() == Err(error), "a failed step changes nothing");
    // The advice: shorter steps, on the same run.
    let pericentre = core::f64::consts::PI;
    assert!((t - pericentre).abs() < 0.5, "{t}");
    while run.t() < pericentre + 0.2 {
        run.step_of(0.01).expect("a shorter step");
    }
    run.step().expect("the run goes on with its own steps");
    // Measured: 4.1e-7, of the first step after the pericentre.
    let energies = [start.state.energy(&kepler), run.energy()].map(|energy| energy.expect("H"));
    assert!((energies[1] - energies[0]).abs() < 5e-7, "{energies:?}");
}

#[test]
fn a_step_of_the_double_pendulum_is_found_from_cold_stages() {
    // Fast motions, with steps that extrapolated stages lead astray: half of 300 such runs ended within 100 steps.
    let mut parts = (0..400).map(|k| f64::from((k * 7919) % 1000) / 250.0 - 2.0);
    for _ in 0..100 {
        let mut part = || parts.next().expect("four numbers of each run");
        let start = DoublePendulum { g: 1.0, ..DoublePendulum::default() }.at(0.0, [part(), part()], [part(), part()]);
        let mut run = start.integrate(Gauss::<8>, 0.1).expect("a start");
        for _ in 0..100 {
            run.step().unwrap_or_else(|error| panic!("{start:?}: {error}"));
        }
    }
}

#[test]
fn many_events_of_a_step_come_in_their_order_and_each_once() {
    let free = Ball { g: 0.0 };
    let start = State::at(&free, 0.0, [0.0], [1.0]);
    let levels: Vec<f64> = (0..300).map(|k| 0.013 + 0.0031 * f64::from((k * 77) % 300)).collect();
    let events: Vec<_> = levels.iter().map(|&level| Event::rising(move |s| s.q[0] - level)).collect();
    let reached = |crossings: &mut dyn Iterator<Item = Result<Crossing<1>, StepError>>| -> Vec<(usize, f64)> {
        crossings
            .map(|crossing| crossing.expect("solvable"))
            .flat_map(|crossing| crossing.events.into_iter().map(move |met| (met.event, crossing.state.t)))
            .collect()
    };
    for h in [0.3, 1.0] {
        let mut fixed = free.at_state(start).integrate(FixedStep, h).expect("valid");
        let mut gauss = free.at_state(start).integrate(Gauss::<4>, h).expect("valid");
        for found in [reached(&mut fixed.events(&events, 1.0)), reached(&mut gauss.events(&events, 1.0))] {
            assert!(found.len() == 300 && found.windows(2).all(|pair| pair[0].1 <= pair[1].1), "h = {h}");
            let worst = found.iter().map(|(event, t)| (t - levels[*event]).abs()).fold(0.0, f64::max);
            // Measured 1.1e-16.
            assert!(worst < 3e-16, "h = {h}: {worst:e}");
        }
    }
}

/// Times of the events of a function, from single searches and from one search; largest |g| there.
fn met<M: Method<S, 1>, S: Lagrangian<1> + Copy>(
    run: &Run<M, S, 1>,
    wanted: &Event<1>,
    until: f64,
) -> ([usize; 2], f64) {
    let mut one_by_one = run.clone();
    let mut times = Vec::new();
    while let Some(crossing) = one_by_one.next_event(wanted, until).expect("the run goes on") {
        times.push(crossing.state.t);
        assert!(times.len() < 100, "the same event again: {times:?}");
    }
    let together: Vec<f64> =
        run.clone().events(wanted, until).map(|crossing| crossing.expect("the run goes on").state.t).collect();
    let difference = times.iter().zip(&together).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    ([times.len(), together.len()], difference)
}

#[test]
fn functions_that_are_flat_steep_or_jump_are_met_once() {
    let functions: [fn(f64) -> f64; 7] = [
        |x| x,
        |x| x.powi(3),
        |x| x.powi(5),
        |x| x.abs().sqrt().copysign(x),
        |x| (1e6 * x).atan(),
        |x| 1.0_f64.copysign(x),
        |x| 1e-320 * x,
    ];
    let oscillator = HarmonicOscillator::default();
    let start = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let omega = (oscillator.energy(0.0, &start.q, &SVector::zeros()) * 2.0).sqrt();
    let until = 10.0 / omega;
    for g in functions {
        for wanted in [Event::crossing(move |s| g(s.q[0])), Event::crossing(move |s| g(s.v[0]))] {
            let found = [
                met(&oscillator.at_state(start).integrate(FixedStep, 0.1 / omega).expect("valid"), &wanted, until),
                met(&oscillator.at_state(start).integrate(Gauss::<4>, 0.3 / omega).expect("valid"), &wanted, until),
            ];
            assert_eq!(found[1].0, [3, 3]);
            assert_eq!(found[0].0, [3, 3]);
            // Steps of order 8: 5e-9.
            assert!(found[1].1 < 1e-7, "{found:?}");
        }
    }
}

#[test]
fn an_event_at_the_end_of_a_search_is_met_once() {
    let body = Pushed { k: 0.0, ..Pushed::default() };
    let mut seen = 0;
    for n in [7.0, 10.0, 13.0, 16.0, 32.0, 33.0, 100.0] {
        for h in [1.0 / n, 1.01 / n, 0.77 / n] {
            let wanted = Event::crossing(|s| s.t - 1.0);
            let mut run = body.at(0.0, [0.3], [0.2]).integrate(Gauss::<3>, h).expect("valid");
            let mut count = 0;
            for until in [1.0, 2.0] {
                for crossing in run.events(&wanted, until) {
                    assert!((crossing.expect("the run goes on").state.t - 1.0).abs() < 1e-15);
                    count += 1;
                }
                assert_eq!(run.t().to_bits(), f64::to_bits(until));
            }
            assert_eq!(count, 1, "steps of {h}");
            seen += 1;
        }
    }
    assert_eq!(seen, 21);
}

/// The position after an eighth, the step to the next event, and the velocity there.
fn later<M: Method<S, 1>, S: Lagrangian<1> + Copy>(mut run: Run<M, S, 1>, wanted: &Event<1>) -> [f64; 3] {
    let start = run.state();
    let state = run.clone().until(start.t + 0.125).expect("the run goes on");
    let crossing = run.next_event(wanted, start.t + 10.0).expect("the run goes on").expect("one");
    let mut run = run.clone();
    let before = run.state();
    run.step().expect("the run goes on");
    let velocity = run.dense_output(&before).expect("regular").velocity(before.t);
    [state.q[0], crossing.length, velocity[0]]
}

#[test]
fn far_from_zero_a_rounding_of_the_time_is_many_steps() {
    // At 1e15 the spacing of times is 0.125.
    let oscillator = HarmonicOscillator::default();
    let h = 1e-3;
    let near = State::at(&oscillator, 0.0, [1.0], [0.0]);
    let far = State { t: 1e15, ..near };
    let wanted = Event::crossing(|s| s.q[0]);
    let fixed =
        [near, far].map(|state| later(oscillator.at_state(state).integrate(FixedStep, h).expect("valid"), &wanted));
    let gauss =
        [near, far].map(|state| later(oscillator.at_state(state).integrate(Gauss::<4>, h).expect("valid"), &wanted));
    for [near, far] in [fixed, gauss] {
        let difference = near.iter().zip(far).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // 2e-14.
        assert!(difference < 1e-12, "{near:?} {far:?}");
    }
}

#[test]
fn a_step_bound_never_passes_the_end_time() {
    let oscillator = HarmonicOscillator::default();
    let run = EnergyPreserving::from_midpoint(oscillator, 0.0, [1.0], [0.0], 0.001).expect("valid");
    let mut run = run.with_fallback(vi_core::Fallback::FixedSteps).with_step_bounds(0.1, 1.0).expect("valid");
    for t in [0.05, 0.5] {
        assert_eq!(run.until(t).map(|state| state.t), Ok(t));
    }
}

#[test]
fn a_time_nearer_than_the_smallest_step_is_here() {
    let oscillator = HarmonicOscillator::default();
    let mut run = oscillator.at(0.0, [1.0], [0.0]).integrate(FixedStep, 0.1).expect("valid");
    assert_eq!(run.until(1e-310).map(|state| state.t), Ok(1e-310));
    assert_eq!(
        run.states_at([2e-310, 0.1]).map(|state| state.map(|state| state.t)).collect::<Vec<_>>(),
        [Ok(2e-310), Ok(0.1)]
    );
}
