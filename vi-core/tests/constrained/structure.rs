//! What constrained steps preserve, and their order.

use super::systems::{Auto, DoublePendulum, Driven, General, HeavyTop, Mixed, Model, PENDULUM, Pendulum, Sleigh};
use vi_core::motion::Motion as _;
use vi_core::{Gauss, Lagrangian, Method, Run, SVector, Starts, State};

type AutoRun<M, const N: usize, const K: usize, const STAGES: usize> = Run<Gauss<STAGES>, Auto<M, K>, N>;

fn run<M: Model<N, K>, const N: usize, const K: usize, const STAGES: usize>(
    system: Auto<M, K>,
    state: State<N>,
    h: f64,
) -> AutoRun<M, N, K, STAGES> {
    system.at_state(state).integrate(Gauss::<STAGES>, h).unwrap_or_else(|error| panic!("{error}"))
}

fn steps<M: Model<N, K>, const N: usize, const K: usize, const STAGES: usize>(
    run: &mut AutoRun<M, N, K, STAGES>,
    count: u32,
) -> State<N> {
    for _ in 0..count {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    run.state()
}

/// Starts of the systems; the fourth place of `Mixed` is on the sphere, and its velocity along the blade.
fn pendulum() -> State<2> {
    State::at(&PENDULUM, 0.0, [0.6, -0.8], [0.8, 0.6])
}

fn double_pendulum() -> State<4> {
    State::at(&Auto(DoublePendulum), 0.0, [0.6, -0.8, 0.6 + 5.0 / 13.0, -0.8 - 12.0 / 13.0], [0.8, 0.6, 0.8, 0.6])
}

fn driven() -> State<2> {
    State::at(&Auto(Driven), 0.0, [0.6, -0.8], [0.8, 1.2])
}

fn heavy_top(j: f64) -> State<4> {
    State::at(&Auto(HeavyTop { j }), 0.0, [0.8, 0.4, 0.4, 0.2], [-0.4, 1.8, -2.2, 2.4])
}

fn general() -> State<2> {
    State::at(&Auto(General), 0.0, [0.6, -0.8], [0.836, 0.552])
}

fn sleigh() -> State<3> {
    State::at(&Auto(Sleigh { turns: false }), 0.0, [0.0, 0.0, 0.0], [1.0, 0.0, 2.0])
}

/// On the sphere, and along the blade at the angle 0.
fn mixed() -> State<4> {
    State::at(&Auto(Mixed), 0.0, [0.0, 0.6, -0.8, 0.0], [1.5, 0.0, 0.0, 0.7])
}

/// Slopes of the error at the end over ln h, for halved steps, against steps of six stages.
fn check_order<M: Model<N, K>, const N: usize, const K: usize, const STAGES: usize>(
    system: Auto<M, K>,
    state: State<N>,
    counts: [u32; 3],
) {
    let end = |count: u32| steps(&mut run::<M, N, K, STAGES>(system, state, f64::from(count).recip()), count);
    let exact = steps(&mut run::<M, N, K, 6>(system, state, 1.0 / 64.0), 64);
    let errors = counts.map(|count| {
        let end = end(count);
        (end.q - exact.q).norm().max((end.p - exact.p).norm())
    });
    for ladder in errors.windows(2).zip(counts.windows(2)) {
        let (errors, counts) = ladder;
        let slope = (errors[0] / errors[1]).ln() / (f64::from(counts[1]) / f64::from(counts[0])).ln();
        println!("{} s = {STAGES}: {errors:?} {slope:.3}", M::NAME);
        let order = f64::from(Method::<Auto<M, K>, N>::facts(&Gauss::<STAGES>).order);
        assert!((slope - order).abs() < 0.1, "{} s = {STAGES}: {slope}", M::NAME);
    }
}

#[test]
fn orders_are_two_four_and_six() {
    check_order::<_, 2, 1, 1>(PENDULUM, pendulum(), [80, 160, 320]);
    check_order::<_, 2, 1, 2>(PENDULUM, pendulum(), [40, 80, 160]);
    check_order::<_, 2, 1, 3>(PENDULUM, pendulum(), [20, 30, 40]);
    check_order::<_, 4, 2, 1>(Auto(DoublePendulum), double_pendulum(), [160, 320, 640]);
    check_order::<_, 4, 2, 2>(Auto(DoublePendulum), double_pendulum(), [80, 120, 160]);
    check_order::<_, 4, 2, 3>(Auto(DoublePendulum), double_pendulum(), [40, 60, 80]);
    check_order::<_, 2, 1, 1>(Auto(Driven), driven(), [160, 320, 640]);
    check_order::<_, 2, 1, 2>(Auto(Driven), driven(), [60, 80, 120]);
    check_order::<_, 2, 1, 3>(Auto(Driven), driven(), [40, 60, 80]);
    check_order::<_, 2, 1, 1>(Auto(General), general(), [40, 80, 160]);
    check_order::<_, 2, 1, 2>(Auto(General), general(), [20, 40, 80]);
    check_order::<_, 2, 1, 3>(Auto(General), general(), [10, 14, 20]);
    check_order::<_, 3, 1, 1>(Auto(Sleigh { turns: false }), sleigh(), [40, 80, 160]);
    check_order::<_, 3, 1, 2>(Auto(Sleigh { turns: true }), sleigh(), [20, 40, 80]);
    check_order::<_, 3, 1, 3>(Auto(Sleigh { turns: false }), sleigh(), [10, 14, 20]);
    check_order::<_, 4, 2, 1>(Auto(Mixed), mixed(), [40, 80, 160]);
    check_order::<_, 4, 2, 2>(Auto(Mixed), mixed(), [20, 40, 80]);
    check_order::<_, 4, 2, 3>(Auto(Mixed), mixed(), [14, 20, 28]);
}

/// Steps forward and back.
fn check_return<M: Model<N, K>, const N: usize, const K: usize, const STAGES: usize>(
    system: Auto<M, K>,
    state: State<N>,
) {
    let h = 0.02;
    let end = steps(&mut run::<M, N, K, STAGES>(system, state, h), 100);
    let back = steps(&mut run::<M, N, K, STAGES>(system, end, -h), 100);
    let off = (back.q - state.q).amax().max((back.p - state.p).amax());
    println!("{} s = {STAGES}: back to {off:.1e}", M::NAME);
    // Measured: at most 6.9e-16.
    assert!(off < 2e-15, "{} s = {STAGES}: {off:e}", M::NAME);
}

#[test]
fn negative_steps_return() {
    check_return::<_, 2, 1, 1>(PENDULUM, pendulum());
    check_return::<_, 2, 1, 2>(PENDULUM, pendulum());
    check_return::<_, 4, 2, 1>(Auto(DoublePendulum), double_pendulum());
    check_return::<_, 4, 2, 3>(Auto(DoublePendulum), double_pendulum());
    check_return::<_, 2, 1, 1>(Auto(Driven), driven());
    check_return::<_, 2, 1, 2>(Auto(Driven), driven());
    check_return::<_, 2, 1, 2>(Auto(General), general());
    check_return::<_, 3, 1, 1>(Auto(Sleigh { turns: true }), sleigh());
    check_return::<_, 3, 1, 2>(Auto(Sleigh { turns: false }), sleigh());
    check_return::<_, 4, 2, 2>(Auto(Mixed), mixed());
}

/// The constraint and its rate at every node of five stretches of these steps.
fn constraints_hold_at_every_node(steps: u32) {
    let mut run = run::<_, 2, 1, 1>(PENDULUM, pendulum(), 0.05);
    // The largest values over ε times their terms, in each fifth of the run.
    let mut worst = [[0.0_f64; 2]; 5];
    for fifth in &mut worst {
        for _ in 0..steps {
            let State { q, p, .. } = run.step().unwrap_or_else(|error| panic!("{error}"));
            let [g] = PENDULUM.constraints(0.0, &q);
            // Unit mass: v = p, from which no bordered matrix removes anything.
            let (rate, terms) = (2.0 * q.dot(&p), 2.0 * (q[0] * p[0]).abs() + 2.0 * (q[1] * p[1]).abs());
            let g_terms = q.norm_squared() + 1.0;
            fifth[0] = fifth[0].max(g.abs() / (f64::EPSILON * g_terms));
            fifth[1] = fifth[1].max(rate.abs() / (f64::EPSILON * terms));
        }
    }
    println!("{worst:?}");
    for [g, rate] in worst {
        // Measured: at most 1.0 and 1.7, without growth.
        assert!(g <= 2.0 && rate <= 4.0, "{worst:?}");
    }
}

#[test]
fn constraints_hold_at_every_node_of_a_run() {
    constraints_hold_at_every_node(400);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn constraints_hold_at_every_node_of_a_long_run() {
    constraints_hold_at_every_node(20_000);
}

/// The same for a constraint that moves and one on velocities, over four stretches of these steps.
fn moving_constraint_and_velocities_hold(steps: u32) {
    let system = Auto(Driven);
    let mut run = run::<_, 2, 1, 2>(system, driven(), 0.02);
    let mut worst = [[0.0_f64; 2]; 4];
    for quarter in &mut worst {
        for _ in 0..steps {
            let State { t, q, p } = run.step().unwrap_or_else(|error| panic!("{error}"));
            let [g] = system.constraints(t, &q);
            let ([row], [rest]) = system.constraint_gradients(t, &q);
            let terms = (row[0] * p[0]).abs() + (row[1] * p[1]).abs() + rest.abs();
            quarter[0] = quarter[0].max(g.abs() / (f64::EPSILON * (q.norm_squared() + 1.0)));
            quarter[1] = quarter[1].max((row.dot(&p) + rest).abs() / (f64::EPSILON * terms));
        }
    }
    println!("{worst:?}");
    for [g, rate] in worst {
        // Measured: at most 1.09 and 1.0.
        assert!(g <= 2.0 && rate <= 2.0, "{worst:?}");
    }
}

#[test]
fn a_run_with_moving_constraint_and_velocities_stays_on_it() {
    moving_constraint_and_velocities_hold(250);
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn a_long_run_with_moving_constraint_and_velocities_stays_on_it() {
    moving_constraint_and_velocities_hold(5000);
}

/// Changes of q and p.
type Tangent = (SVector<f64, 4>, SVector<f64, 4>);

/// The two-form `Σ dq ∧ dp` on tangent vectors of the double pendulum, by central differences over its angles and
/// angular velocities, before and after steps.
fn check_two_form<const STAGES: usize>() {
    let system = Auto(DoublePendulum);
    let state = |x: [f64; 4]| {
        let ((s1, c1), (s2, c2)) = (x[0].sin_cos(), x[1].sin_cos());
        let q = [s1, -c1, s1 + s2, -c1 - c2];
        let v = [c1 * x[2], s1 * x[2], c1 * x[2] + c2 * x[3], s1 * x[2] + s2 * x[3]];
        State::at(&system, 0.0, q, v)
    };
    let at = [0.7, 0.4, 1.0, -0.6];
    let end = |state: State<4>| steps(&mut run::<_, 4, 2, STAGES>(system, state, 0.05), 10);
    let tangents = |map: &dyn Fn(State<4>) -> State<4>| {
        let step = 1e-4;
        [0, 1, 2, 3].map(|k| {
            let shifted = |sign: f64| {
                let mut x = at;
                x[k] += sign * step;
                map(state(x))
            };
            // Of fourth order.
            let half = |of: f64| {
                let (plus, minus) = (shifted(of), shifted(-of));
                ((plus.q - minus.q) / (2.0 * of * step), (plus.p - minus.p) / (2.0 * of * step))
            };
            let ((q1, p1), (q2, p2)) = (half(1.0), half(2.0));
            ((q1 * 4.0 - q2) / 3.0, (p1 * 4.0 - p2) / 3.0)
        })
    };
    let form = |(a, b): (&Tangent, &Tangent)| a.0.dot(&b.1) - a.1.dot(&b.0);
    let (before, after) = (tangents(&|state| state), tangents(&end));
    let mut worst = 0.0_f64;
    for i in 0..4 {
        for j in 0..i {
            worst = worst.max((form((&before[i], &before[j])) - form((&after[i], &after[j]))).abs());
        }
    }
    println!("s = {STAGES}: the two-form changes by {worst:e}");
    // Measured: at most 2.8e-12, by differences over 1e-4.
    assert!(worst < 1e-11, "s = {STAGES}: {worst:e}");
}

#[test]
fn steps_without_force_are_symplectic() {
    check_two_form::<1>();
    check_two_form::<2>();
    check_two_form::<3>();
}

/// The largest change of the momentum of the heavy top about its axis.
fn change_of_momentum_about_the_axis(steps: u32) -> f64 {
    let momentum = |State { q, p, .. }: State<4>| 0.5 * (-q[3] * p[0] + q[2] * p[1] - q[1] * p[2] + q[0] * p[3]);
    let mut run = run::<_, 4, 1, 1>(Auto(HeavyTop { j: 1.0 }), heavy_top(1.0), 0.025);
    assert!((momentum(run.state()) - 3.6).abs() < 1e-15);
    let mut worst = 0.0_f64;
    for _ in 0..steps {
        let state = run.step().unwrap_or_else(|error| panic!("{error}"));
        worst = worst.max((momentum(state) - 3.6).abs());
    }
    println!("momentum {worst:e}");
    worst
}

#[test]
fn the_heavy_top_keeps_its_momentum_about_its_axis() {
    let worst = change_of_momentum_about_the_axis(1000);
    // Measured: 2.2e-15.
    assert!(worst < 4e-15, "{worst:e}");
}

#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn the_heavy_top_keeps_its_momentum_for_long() {
    let worst = change_of_momentum_about_the_axis(40_000);
    // Measured: 2.1e-14.
    assert!(worst < 3e-14, "{worst:e}");
}

#[test]
fn inertia_along_a_constraint_changes_nothing() {
    // With j = 0 the mass matrix is singular.
    let [with, without] =
        [1.0, 0.0].map(|j| steps(&mut run::<_, 4, 1, 1>(Auto(HeavyTop { j }), heavy_top(j), 0.025), 200));
    let off = (with.q - without.q).amax().max((with.p - without.p).amax());
    println!("j: {off:e}");
    // Measured: 4.8e-15.
    assert!(off < 2e-14, "{off:e}");
}

#[test]
fn impulses_on_both_sides_of_a_node_are_the_multiplier() {
    let off = |count: u32| {
        let h = 0.5 / f64::from(count);
        let mut run = run::<_, 2, 1, 1>(PENDULUM, pendulum(), h);
        let state = steps(&mut run, count);
        let mu = run.impulses().expect("a step").mu[0];
        let [multiplier] = state.reaction(&PENDULUM).unwrap_or_else(|error| panic!("{error}"));
        run.step().unwrap_or_else(|error| panic!("{error}"));
        let [[lambda]] = run.impulses().expect("a step").lambda;
        (mu + lambda) / h - multiplier
    };
    let [coarse, fine] = [10, 20].map(off);
    println!("{coarse:e} {fine:e} {}", coarse / fine);
    assert!(((coarse + 8.0e-3) / 8.0e-3).abs() < 0.05, "{coarse}");
    assert!((coarse / fine - 4.0).abs() < 0.1, "{}", coarse / fine);
}

#[test]
fn momenta_are_balanced_by_impulses() {
    // Both kinds of constraints; the only force is the weight.
    let mut run = run::<_, 4, 2, 1>(Auto(Mixed), mixed(), 0.05);
    let before = steps(&mut run, 7);
    let after = steps(&mut run, 1);
    let impulses = run.impulses().expect("a step");
    let of = |state: &State<4>, multipliers: [f64; 2]| {
        let (rows, _) = Auto(Mixed).constraint_gradients(state.t, &state.q);
        rows[0] * multipliers[0] + rows[1] * multipliers[1]
    };
    let [lambda] = impulses.lambda;
    let weight = SVector::from([0.0, 0.0, -2.0 * 0.05, 0.0]);
    let rest = after.p - before.p - weight - of(&before, lambda) - of(&after, impulses.mu);
    println!("{:e}", rest.amax());
    // Measured: 2.8e-17.
    assert!(rest.amax() < 1e-15 && impulses.mu[1].abs() > 1e-3, "{rest} {impulses:?}");
}

#[test]
fn reactions_are_those_of_newton() {
    // a = −g e_y + 2Λ q and q·a = −|v|² give 2Λ = g y − |v|².
    let state = pendulum();
    let force = state.reaction_force(&PENDULUM).unwrap_or_else(|error| panic!("{error}"));
    let [multiplier] = state.reaction(&PENDULUM).unwrap_or_else(|error| panic!("{error}"));
    let expected = 9.81 * -0.8 - 1.0;
    // Measured: at most 1.8e-15.
    assert!((2.0 * multiplier - expected).abs() < 4e-15, "{multiplier}");
    assert!((force - state.q * expected).amax() < 4e-15, "{force}");
    let acceleration = PENDULUM.acceleration(0.0, &state.q, &state.p).unwrap_or_else(|error| panic!("{error}"));
    assert!((acceleration - force - SVector::from([0.0, -9.81])).amax() < 4e-15);
    // A moving constraint does work: the flow along the motion, against central differences over short steps.
    let system = Auto(Driven);
    let start = State::at(&system, 0.3, [0.6, -0.8 + 0.1 * 1.8_f64.sin()], [0.8, 0.6 + 0.6 * 1.8_f64.cos()]);
    let flow = start.flow(&system).unwrap_or_else(|error| panic!("{error}"));
    let energy = |h: f64| {
        let end = steps(&mut run::<_, 2, 1, 4>(system, start, h), 1);
        (end.energy(&system).unwrap_or_else(|error| panic!("{error}")), end.p)
    };
    let h = 1e-3;
    let ((later, p_later), (earlier, p_earlier)) = (energy(h), energy(-h));
    println!(
        "{} {}",
        flow.power - (later - earlier) / (2.0 * h),
        (flow.force - (p_later - p_earlier) / (2.0 * h)).amax()
    );
    // Measured: 1.3e-5 and 1.9e-5. Third derivatives of the motion times h²/6.
    assert!((flow.power - (later - earlier) / (2.0 * h)).abs() < 4e-5);
    assert!((flow.force - (p_later - p_earlier) / (2.0 * h)).amax() < 4e-5);
}

#[test]
fn the_energy_of_the_sleigh_does_not_drift() {
    let mut run = run::<_, 3, 1, 1>(Auto(Sleigh { turns: false }), sleigh(), 0.05);
    let initial = run.energy().unwrap_or_else(|error| panic!("{error}"));
    let energies = [2000, 500, 500].map(|count| {
        steps(&mut run, count);
        run.energy().unwrap_or_else(|error| panic!("{error}")) - initial
    });
    println!("{energies:?}");
    assert!((energies[0] + 2.08e-3).abs() < 5e-6, "{energies:?}");
    // Measured: 0.
    assert!((energies[2] - energies[0]).abs() < 1e-14, "{energies:?}");
}

#[test]
fn a_rotor_turns_by_its_sine() {
    // Without weight the pendulum is a free rotor: sin(turn) = h w.
    let rotor = Auto(Pendulum { length: 1.0, g: 0.0 });
    let start = State::at(&rotor, 0.0, [1.0, 0.0], [0.0, 1.0]);
    let end = steps(&mut run::<_, 2, 1, 1>(rotor, start, 0.97), 1);
    let turn = end.q[1].atan2(end.q[0]);
    println!("{:e}", turn.sin() - 0.97);
    // Measured: 2.3e-16.
    assert!((turn.sin() - 0.97).abs() < 1e-14 && turn < 1.4, "{turn}");
}
