//! Compositions of steps with constraints.

use super::systems::{Auto, Driven, Mixed, Model, PENDULUM, Sleigh};
use vi_core::derivatives::{Tangent, Variation};
use vi_core::motion::Motion as _;
use vi_core::run::Checkpoint;
use vi_core::{Composed, Composition, Gauss, Method, Run, Starts, State, StepError};

type ARun<M, const N: usize, const K: usize> = Run<Composed<Gauss<1>>, Auto<M, K>, N>;

fn begin<M: Model<N, K>, const N: usize, const K: usize>(
    system: Auto<M, K>,
    state: State<N>,
    (scheme, h): (Composition, f64),
) -> ARun<M, N, K> {
    system.at_state(state).integrate(Gauss::<1>.composed(scheme), h).unwrap_or_else(|error| panic!("{error}"))
}

fn pendulum() -> State<2> {
    State::at(&PENDULUM, 0.0, [0.6, -0.8], [0.8, 0.6])
}

/// Slopes of the error at t = 1 over ln h, against steps of six stages.
fn check_order<M: Model<N, K>, const N: usize, const K: usize>(
    system: Auto<M, K>,
    state: State<N>,
    (scheme, counts): (Composition, [u32; 3]),
) {
    let mut exact = system.at_state(state).integrate(Gauss::<6>, 1.0 / 64.0).expect("a start");
    let exact = (0..64).map(|_| exact.step().expect("a step")).last().expect("a state");
    let errors = counts.map(|count| {
        let mut run = begin(system, state, (scheme, f64::from(count).recip()));
        let ends = (0..count).map(|_| run.step().unwrap_or_else(|error| panic!("{error}")));
        let end = ends.last().expect("a state");
        (end.q - exact.q).norm().max((end.p - exact.p).norm())
    });
    for (errors, counts) in errors.windows(2).zip(counts.windows(2)) {
        let slope = (errors[0] / errors[1]).ln() / (f64::from(counts[1]) / f64::from(counts[0])).ln();
        println!("{} {}: {errors:?} {slope:.3}", M::NAME, scheme.name);
        let order = Method::<Auto<M, K>, N>::facts(&Gauss::<1>.composed(scheme)).order;
        assert!((slope - f64::from(order)).abs() < 0.1, "{} {}: {slope}", M::NAME, scheme.name);
    }
}

#[test]
fn orders_are_four_six_and_eight() {
    check_order(PENDULUM, pendulum(), (Composition::TRIPLE_JUMP_4, [80, 120, 160]));
    check_order(PENDULUM, pendulum(), (Composition::SUZUKI_4, [40, 60, 80]));
    check_order(PENDULUM, pendulum(), (Composition::KAHAN_LI_6, [40, 60, 80]));
    check_order(PENDULUM, pendulum(), (Composition::KAHAN_LI_8, [20, 25, 30]));
    let driven = State::at(&Auto(Driven), 0.0, [0.6, -0.8], [0.8, 1.2]);
    check_order(Auto(Driven), driven, (Composition::SUZUKI_4, [120, 160, 240]));
    check_order(Auto(Driven), driven, (Composition::KAHAN_LI_6, [80, 100, 120]));
    let sleigh = Auto(Sleigh { turns: true });
    let start = State::at(&sleigh, 0.0, [0.0, 0.0, 0.0], [1.0, 0.0, 2.0]);
    check_order(sleigh, start, (Composition::SUZUKI_4, [20, 30, 40]));
    check_order(sleigh, start, (Composition::KAHAN_LI_6, [20, 25, 30]));
    let mixed = State::at(&Auto(Mixed), 0.0, [0.0, 0.6, -0.8, 0.0], [1.5, 0.0, 0.0, 0.7]);
    check_order(Auto(Mixed), mixed, (Composition::KAHAN_LI_6, [16, 20, 24]));
}

#[test]
fn nodes_are_on_the_constraint_and_steps_return() {
    let case = (Composition::KAHAN_LI_8, 0.05);
    let mut run = begin(PENDULUM, pendulum(), case);
    let mut worst = 0.0_f64;
    for _ in 0..200 {
        let state = run.step().unwrap_or_else(|error| panic!("{error}"));
        worst = worst.max(PENDULUM.constraints(0.0, &state.q)[0].abs()).max(state.q.dot(&state.p).abs());
    }
    assert!(run.iterations() > 0 && run.residual() > 0.0 && run.discrete_energy().is_none());
    let mut back = begin(PENDULUM, run.state(), (case.0, -case.1));
    let end = (0..200).map(|_| back.step().unwrap_or_else(|error| panic!("{error}"))).last().expect("a state");
    let off = (end.q - pendulum().q).amax().max((end.p - pendulum().p).amax());
    println!("{worst:e} {off:e}");
    // Measured: 4.5e-16 and 6.7e-16.
    assert!(worst < 1e-15 && off < 2e-15, "{worst:e} {off:e}");
}

#[test]
fn stored_runs_resume_and_tangent_vectors_are_symplectic() {
    let case = (Composition::SUZUKI_4, 0.03);
    let mut run = begin(PENDULUM, pendulum(), case);
    for _ in 0..10 {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let text = serde_json::to_string(&run.checkpoint()).expect("a text");
    let stored: Checkpoint<_, 2> = serde_json::from_str(&text).expect("a checkpoint");
    let method = Gauss::<1>.composed(case.0);
    let mut resumed = Run::restart(PENDULUM, method, stored).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..10 {
        assert_eq!(run.step(), resumed.step());
    }
    let stored: Checkpoint<_, 2> = serde_json::from_str(&text).expect("a checkpoint");
    let other = Gauss::<1>.composed(Composition::KAHAN_LI_6);
    assert!(matches!(Run::restart(PENDULUM, other, stored), Err(StepError::InvalidInput { .. })));

    // Two directions on the circle: along the motion, and a change of speed.
    let across = begin(PENDULUM, pendulum(), case);
    let mut tangent = Tangent::new(across, Variation::of_state());
    tangent.project().unwrap_or_else(|error| panic!("{error}"));
    let form = |of: &[Variation<2>]| of[0].q.dot(&of[2].p) - of[0].p.dot(&of[2].q);
    let before = form(tangent.variations());
    let end = |by: f64| {
        let moved = State::projected(&PENDULUM, 0.0, pendulum().q, pendulum().p + tangent.variations()[2].p * by);
        let mut run = begin(PENDULUM, moved.expect("nearest").state, case);
        (0..20).map(|_| run.step().expect("a step").q).last().expect("a state")
    };
    let by = 1e-4;
    let difference = (end(by) - end(-by)) / (2.0 * by);
    for _ in 0..20 {
        tangent.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let (change, off) = (form(tangent.variations()) - before, (tangent.variations()[2].q - difference).amax());
    println!("{before} {change:e} {off:e}");
    // Measured: 3.4e-16 and 2.9e-11.
    assert!(before.abs() > 0.1 && change.abs() < 1e-15 && off < 6e-11, "{before} {change:e} {off:e}");
    // The length of a substep is a part of that of the step.
    let ends = |h: f64| {
        let mut run = begin(PENDULUM, pendulum(), (case.0, h));
        (0..20).map(|_| run.step().expect("a step").q).last().expect("a state")
    };
    let mut longer = Tangent::new(begin(PENDULUM, pendulum(), case), vec![Variation { h: 1.0, ..Variation::zero() }]);
    for _ in 0..20 {
        longer.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let difference = (ends(case.1 + 1e-6) - ends(case.1 - 1e-6)) / 2e-6;
    let off = (longer.variations()[0].q - difference).amax();
    println!("{off:e}");
    // Measured: 3.9e-8, by differences over 1e-6.
    assert!(off < 8e-8 && (longer.variations()[0].t - 20.0).abs() < 1e-12, "{off:e}");
}

#[test]
fn a_substep_that_fails_ends_the_run() {
    let mut run = begin(PENDULUM, pendulum(), (Composition::TRIPLE_JUMP_4, 0.9));
    let failure = run.step().expect_err("too long");
    assert!(matches!(failure, StepError::NotConverged { .. }), "{failure}");
    assert_eq!((run.state(), run.step()), (pendulum(), Err(failure)));
    run.step_of(0.05).unwrap_or_else(|error| panic!("{error}"));
}
