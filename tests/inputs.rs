//! Inputs that a controller sets between steps: linearizations of steps, the energy that inputs bring, balance of a
//! pole, a driven pivot.

use crate::support::slope;
use vi_core::derivatives::Differentiable;
use vi_core::motion::Motion;
use vi_core::nalgebra::DMatrix;
use vi_core::prelude::*;
use vi_core::stepping::Convertible;
use vi_core::{Lagrangian, SVector};

lagrangian! {
    /// Two masses between three springs that grow stiffer. One input is a force, one a field in the potential, and one
    /// has no effect.
    struct Springs {
        param m = 1.3, k = 2.1;
        input push = 0.0;
        param c = 0.7;
        input field[2] = 0.0;
        coord x, y;
        let V = k * x^2 / 2 + c * x^4 / 4 + k * (y - x)^2 / 2 + y^2 / 2 + y^4 / 4;
        L = m * dot(x)^2 / 2 + dot(y)^2 / 2 - V + field[0] * x * y;
        force x = push;
        discretize midpoint;
        check { x = 0.5, dot(y) = 0.3, field[0] = 0.2; h = 0.02; }
    }
}

/// The linearization of a step from the node after a few steps, against differences of steps from changed states and
/// inputs. Returns the largest error relative to the largest entry.
fn error_of_linearization<M, S, const N: usize>(mut run: Run<M, S, N>, set: impl Fn(&mut S, usize, f64)) -> f64
where
    M: Differentiable<S, N>,
    S: Convertible<N> + Motion<N>,
{
    const DELTA: f64 = 1e-5;
    for _ in 0..5 {
        run.step().expect("a step");
    }
    let before = run.state();
    let linear = run.linearization().expect("a linearization");
    assert_eq!(run.state(), before);
    let end = |column: usize, by: f64| {
        let mut run = run.clone();
        let mut state = run.state();
        match column {
            column if column < N => state.q[column] += by,
            column if column < 2 * N => state.p[column - N] += by,
            column => run.set_parameters(|system| set(system, column - 2 * N, by)).expect("parameters"),
        }
        run.set_state(state).expect("a state");
        let State { q, p, .. } = run.step().expect("a step");
        [q, p]
    };
    let columns = 2 * N + S::INPUTS.len();
    let found = DMatrix::from_fn(2 * N, columns, |row, column| match column.checked_sub(2 * N) {
        None => linear.a[(row, column)],
        Some(input) => linear.b[(row, input)],
    });
    assert_eq!(linear.b.shape(), (2 * N, S::INPUTS.len()));
    let wanted = DMatrix::from_fn(2 * N, columns, |row, column| {
        let [after, before] = [DELTA, -DELTA].map(|by| end(column, by)[row / N][row % N]);
        (after - before) / (2.0 * DELTA)
    });
    let State { q, p, .. } = run.step().expect("a step");
    assert!(linear.value.iter().eq(q.iter().chain(&p)));
    (found - &wanted).amax() / wanted.amax()
}

#[test]
fn a_step_has_the_linearization_of_its_differences() {
    let springs = Springs { push: 0.3, field: [0.2, 0.0], ..Springs::default() };
    assert_eq!(<Springs as Lagrangian<2>>::INPUTS, [2, 4, 5]);
    let start = springs.at(0.0, [0.6, -0.3], [0.2, 0.5]);
    let set = |system: &mut Springs, input: usize, by: f64| match input {
        0 => system.push += by,
        input => system.field[input - 1] += by,
    };
    let errors = [
        error_of_linearization(start.integrate(FixedStep, 0.1).expect("a run"), set),
        error_of_linearization(start.integrate(Gauss::<3>, 0.3).expect("a run"), set),
        error_of_linearization(start.integrate(EnergyPreserving, 0.1).expect("a run"), set),
        error_of_linearization(start.integrate(EnergyPreservingGauss::<1>, 0.1).expect("a run"), set),
        error_of_linearization(shifted(start, 0.2), set),
    ];
    println!("linearizations of steps: {errors:?}");
    // 1.6e-9 was measured, of two stages, whose lengths follow from a small energy difference; 1.1e-10 of the others.
    assert!(errors.into_iter().all(|error| error < 8e-9), "{errors:?}");
}

/// A run of two stages, whose step density changes its sign without the shift.
fn shifted(start: Start<Springs, 2>, h: f64) -> Run<EnergyPreservingGauss<2>, Springs, 2> {
    start.integrate(EnergyPreservingGauss::<2>, h).and_then(|run| run.with_shift_from(5.0)).expect("a run")
}

lagrangian! {
    /// A mass on a spring, with a force.
    struct Oscillator {
        param m = 1.7, k = 3.1;
        input u = 0.0;
        coord x;
        L = m * dot(x)^2 / 2 - k * x^2 / 2;
        force x = u;
        discretize midpoint;
        check { x = 0.5; h = 0.02; }
    }
}

#[test]
fn inputs_are_constant_over_a_step() {
    let oscillator = Oscillator { u: 0.4, ..Oscillator::default() };
    let Oscillator { m, k, .. } = oscillator;
    let (h, rate) = (0.4, (k / m).sqrt());
    let linear = oscillator.at(0.0, [0.3], [-0.2]).integrate(Gauss::<6>, h).expect("a run").linearization();
    let linear = linear.expect("a linearization");
    let (sine, cosine) = (rate * h).sin_cos();
    let a = DMatrix::from_row_slice(2, 2, &[cosine, sine / (m * rate), -m * rate * sine, cosine]);
    let b = DMatrix::from_column_slice(2, 1, &[(1.0 - cosine) / k, sine / rate]);
    let errors = [(linear.a - a).amax(), (linear.b - b).amax()];
    println!("zero-order hold: {errors:?}");
    // 8.3e-17 was measured.
    assert!(errors.into_iter().all(|error| error < 1e-15), "{errors:?}");
    let plain = Oscillator::default().linearization(0.0, [0.3], [-0.2]).expect("a linearization");
    assert_eq!((plain.b[0], plain.b[1]), (0.0, 1.0 / m));
}

/// The distance between a run with inputs that change after every step, and new runs from each of its states.
fn distance_of_restarts<M: Method<Springs, 2>>(method: &M, h: f64) -> f64 {
    let mut springs = Springs::default();
    let mut run = springs.at(0.0, [0.6, -0.3], [0.2, 0.5]).integrate(method.clone(), h).expect("a run");
    let mut worst = 0.0_f64;
    for k in 0..100 {
        springs.push = 0.4 * f64::sin(0.7 * f64::from(k));
        springs.field[0] = 0.3 * f64::cos(1.1 * f64::from(k));
        let again = springs.at_state(run.state()).integrate(method.clone(), h).expect("a run").step().expect("a step");
        run.set_parameters(|system| *system = springs).expect("parameters");
        let next = run.step().expect("a step");
        worst = worst.max((next.q - again.q).amax()).max((next.p - again.p).amax());
    }
    worst
}

#[test]
fn a_step_after_a_change_is_that_of_a_new_run() {
    let errors = [distance_of_restarts(&FixedStep, 0.05), distance_of_restarts(&Gauss::<4>, 0.2)];
    println!("restarts: {errors:?}");
    // 2.2e-16 was measured: a new run has no low parts.
    assert!(errors.into_iter().all(|error| error < 2e-15), "{errors:?}");
}

/// Number of steps with a controller.
const STEPS: i32 = 10_000;

/// Damps and drives the masses; returns the sum of the energies that the inputs brought, by formulas of this test, the
/// kept energy, and the range of H about it.
fn balance<M: Method<Springs, 2>>(mut run: Run<M, Springs, 2>, kept: impl Fn(&Run<M, Springs, 2>) -> f64) {
    let first = kept(&run);
    let mut brought = first;
    let (mut error, mut apart, mut moved) = (0.0_f64, [0.0_f64; 2], 0.0_f64);
    for k in 0..STEPS {
        let State { t, q, .. } = run.state();
        let v = run.velocity().expect("a velocity");
        let [push, field] = [-0.05 * v[0] + 0.3 * (0.9 * t).sin(), 0.2 * (0.31 * t).cos()];
        // H contains −field x y; a force is not part of it.
        brought -= (field - run.system().field[0]) * q[0] * q[1];
        run.set_parameters(|system| (system.push, system.field[0]) = (push, field)).expect("parameters");
        let after = run.step().unwrap_or_else(|error| panic!("{k}: {error}"));
        brought += push * (after.q[0] - q[0]);
        error = error.max((kept(&run) - brought).abs());
        moved = moved.max((brought - first).abs());
        let half = usize::from(2 * k >= STEPS);
        apart[half] = apart[half].max((run.energy().expect("an energy") - brought).abs());
    }
    println!("kept energy {error:.1e} from the balance, which moves by {moved:.2}; H within {apart:?}");
    // 8.4e-15 was measured.
    assert!(error < 1e-13 && moved > 1.0, "{error:e}, {moved}");
    // 9.2e-4 was measured, of order h².
    assert!(apart.into_iter().all(|apart| apart < 2e-3) && apart[1] < 2.0 * apart[0], "{apart:?}");
}

#[test]
fn an_energy_preserving_run_accounts_for_inputs() {
    let start = Springs::default().at(0.0, [0.6, -0.3], [0.2, 0.5]);
    let kept = |run: &Run<_, Springs, 2>| run.node().energy + run.node().energy_low;
    balance(start.integrate(EnergyPreserving, 0.02).expect("a run"), kept);
    balance(shifted(start, 0.1), |run| run.node().energy + run.node().energy_low);
}

lagrangian! {
    /// A pole on a cart; the angle a is zero where the pole is upright.
    struct CartPole {
        param M = 1.0, m = 0.2, l = 0.5, g = 9.81;
        input u = 0.0;
        coord x, a;
        L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 - m * g * l * cos(a);
        force x = u;
        discretize midpoint;
    }
}

/// The gain G of u = −G x that minimizes Σ xᵀ Q x + R u², by iterating the discrete Riccati equation.
fn lqr(a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>, r: &DMatrix<f64>) -> DMatrix<f64> {
    let mut cost = q.clone();
    loop {
        let (with_a, with_b) = (&cost * a, &cost * b);
        let gain = (r + b.transpose() * &with_b).lu().solve(&(b.transpose() * &with_a)).expect("a gain");
        let next = q + a.transpose() * (with_a - with_b * &gain);
        if (&next - &cost).amax() <= 1e-12 * cost.amax() {
            return gain;
        }
        cost = next;
    }
}

#[test]
fn a_regulator_from_the_linear_step_balances_a_pole() {
    const H: f64 = 0.02;
    let pole = CartPole::default();
    let top = pole.equilibrium(0.0, [0.0, 0.2]).expect("an equilibrium");
    let step = pole.at(0.0, top.q, [0.0, 0.0]).integrate(FixedStep, H).expect("a run").linearization().expect("A, B");
    let gain = lqr(&step.a, &step.b, &DMatrix::identity(4, 4), &DMatrix::from_element(1, 1, 0.1));
    // Unstable alone, and stable with the regulator.
    let size = |a: DMatrix<f64>| {
        let of = vi_core::control::Linearization { a, ..step.clone() };
        of.eigenvalues().expect("eigenvalues").iter().map(|z| z.norm()).fold(0.0, f64::max)
    };
    let rate = ((pole.M + pole.m) * pole.g / (pole.M * pole.l)).sqrt();
    let [open, closed] = [size(step.a.clone()), size(&step.a - &step.b * &gain)];
    // The midpoint rule: (1 + hλ/2)/(1 − hλ/2).
    let expected = (1.0 + 0.5 * H * rate) / (1.0 - 0.5 * H * rate);
    println!("open {open}, {:.1e} from the rule; closed {closed}", open - expected);
    // 2.2e-16 was measured.
    assert!((open - expected).abs() < 2e-15 && closed < 0.99);
    let mut run = pole.at(0.0, [0.5, 0.6], [0.0, 0.0]).integrate(FixedStep, H).expect("a run");
    for _ in 0..2000 {
        let State { q, p, .. } = run.state();
        let x = DMatrix::from_iterator(4, 1, q.iter().chain(&p).copied());
        let u = -(&gain * x)[0];
        run.set_parameters(|pole| pole.u = u).expect("a finite force");
        run.step().expect("a step");
    }
    let State { q, p, .. } = run.state();
    println!("after 40 s: {:.1e}, {:.1e}", q.amax(), p.amax());
    // 5.7e-15 was measured.
    assert!(q.amax() < 1e-13 && p.amax() < 1e-13, "{q}, {p}");
}

lagrangian! {
    /// A pendulum whose pivot moves up and down as a function of time.
    struct Written {
        param g = 9.81, l = 0.8, lift = 0.15, w = 4.0;
        coord a;
        let y = lift * sin(w * t);
        L = (dot(l * sin(a))^2 + dot(y - l * cos(a))^2) / 2 - g * (y - l * cos(a));
        discretize midpoint;
    }
}

lagrangian! {
    /// The same pendulum; the height of its pivot and its rate are inputs.
    struct Driven {
        param g = 9.81, l = 0.8;
        input y = 0.0, y_dot = 0.0;
        coord a;
        L = (l^2 * dot(a)^2 + 2 * l * dot(a) * y_dot * sin(a) + y_dot^2) / 2 - g * (y - l * cos(a));
        discretize midpoint;
        check { a = 0.7, dot(a) = 0.5, y_dot = 0.2; h = 0.01; }
    }
}

/// The momentum at t = 2 of the driven pendulum in this number of steps, by inputs at the middle of each step.
fn driven<M: Method<Driven, 1>>(method: M, steps: i32) -> SVector<f64, 2> {
    let Written { lift, w, .. } = Written::default();
    let h = 2.0 / f64::from(steps);
    let pivot = |t: f64| [lift * (w * t).sin(), lift * w * (w * t).cos()];
    let [y, y_dot] = pivot(0.0);
    // The momenta at the start belong to the rate there.
    let mut run = Driven { y, y_dot, ..Driven::default() }.at(0.0, [0.7], [0.5]).integrate(method, h).expect("a run");
    for _ in 0..steps {
        let [y, y_dot] = pivot(run.t() + 0.5 * h);
        run.set_parameters(|system| (system.y, system.y_dot) = (y, y_dot)).expect("parameters");
        run.step().expect("a step");
    }
    let State { q, p, .. } = run.state();
    [q[0], p[0]].into()
}

#[test]
fn a_driven_pivot_as_inputs_has_order_two() {
    let written = Written::default().at(0.0, [0.7], [0.5]);
    let State { q, p, .. } = written.integrate(Gauss::<8>, 0.05).expect("a run").until(2.0).expect("a state");
    let exact = SVector::from([q[0], p[0]]);
    let errors = |of: &dyn Fn(i32) -> SVector<f64, 2>| -> Vec<(f64, f64)> {
        [20, 40, 80, 160].map(|steps| (2.0 / f64::from(steps), (of(steps) - exact).amax())).to_vec()
    };
    let slopes = [
        slope("driven, fixed steps", &errors(&|steps| driven(FixedStep, steps)), 0.0),
        slope("driven, Gauss", &errors(&|steps| driven(Gauss::<3>, steps)), 0.0),
    ];
    // 1.996 and 2.008 were measured.
    assert!(slopes.into_iter().all(|slope| (slope - 2.0).abs() < 0.05), "{slopes:?}");
    // The midpoint rule evaluates L at the middle too: its steps are those of the motion in t.
    let State { q, p, .. } = written.integrate(FixedStep, 0.025).expect("a run").nth(79).expect("a step").expect("one");
    let error = (driven(FixedStep, 80) - SVector::from([q[0], p[0]])).amax();
    println!("driven by inputs and in t: {error:.1e}");
    // 1.7e-16 was measured.
    assert!(error < 2e-15);
}
