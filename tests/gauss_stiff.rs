//! Gauss steps too stiff for fixed-point iteration: Newton iteration solves them, or they return errors.

use crate::gauss_slots::momenta_off;
use vi_core::{Gauss, Starts, State, StepError, lagrangian};
use vi_systems::{DampedOscillator, DoublePendulum, FpuChain};

/// On a linear system the step of S stages is a rational function of its matrix: the diagonal Padé approximant of exp.
fn pade<const S: usize>(matrix: vi_core::nalgebra::SMatrix<f64, 2, 2>) -> vi_core::nalgebra::SMatrix<f64, 2, 2> {
    let identity = vi_core::nalgebra::SMatrix::<f64, 2, 2>::identity();
    let (mut above, mut below) = (identity, identity);
    let (mut power, mut coefficient, mut sign) = (identity, 1.0, 1.0);
    for k in 0..S {
        let [left, done] = [S - k, k + 1].map(|n| f64::from(u32::try_from(n).expect("a few stages")));
        coefficient *= left / (done * (left + f64::from(u32::try_from(S).expect("a few stages"))));
        sign = -sign;
        power *= matrix;
        above += power * coefficient;
        below += power * (coefficient * sign);
    }
    below.try_inverse().expect("a regular matrix") * above
}

/// The step of an oscillator of mass m, stiffness k and damping c, in q and p.
fn oscillator<const S: usize>([m, k, c]: [f64; 3], h: f64) -> vi_core::nalgebra::SMatrix<f64, 2, 2> {
    pade::<S>(vi_core::nalgebra::SMatrix::<f64, 2, 2>::new(0.0, 1.0 / m, -k, -c / m) * h)
}

fn linear<const S: usize>(c: f64, h: f64) {
    let (m, k) = (1.2, 3.4);
    let system = DampedOscillator { m, k, c };
    let step = oscillator::<S>([m, k, c], h);
    let mut run = system.at(0.0, [0.8], [0.5]).integrate(Gauss::<S>, h).expect("a valid start");
    let mut worst = 0.0_f64;
    for _ in 0..20 {
        let before = vi_core::SVector::<f64, 2>::new(run.state().q[0], run.state().p[0]);
        let state = run.step().unwrap_or_else(|error| panic!("c = {c}, h = {h}, {S} stages: {error}"));
        let exact = step * before;
        worst = worst.max((state.q[0] - exact[0]).abs().max((state.p[0] - exact[1]).abs()) / before.amax());
    }
    // Relative to the previous node. The matrices of stiff steps have large entries that cancel.
    let scale = 1.0 + (k / m).sqrt() * h.abs() + c / m * h.abs();
    println!("c = {c}, h = {h}, {S} stages: off by {worst:.1e}, stiffness {scale:.1e}");
    assert!(worst < 3e-14 * scale, "c = {c}, h = {h}, {S} stages: {worst:e}");
}

#[test]
fn a_linear_step_is_the_rational_function_of_its_order_however_stiff() {
    for c in [0.0, 0.05, 4.0] {
        for h in [0.05, 1.0, 5.0, 30.0, -0.5] {
            linear::<1>(c, h);
            linear::<2>(c, h);
            linear::<3>(c, h);
            linear::<6>(c, h);
        }
    }
    // At high degree the rational function itself loses its digits for such a matrix.
    linear::<1>(400.0, 30.0);
    linear::<2>(400.0, 30.0);
}

lagrangian! {
    /// Five damped oscillators, each three times as stiff as the previous one, in mixed coordinates.
    struct Mixed {
        const N = 5;
        param m = 1.2, k = 3.4, c = 0.3;
        coord q[N];
        let x[i in 0..N] = sum(j in 0..N, q[j] / (1 + (i - j)^2));
        let v[i in 0..N] = sum(j in 0..N, dot(q[j]) / (1 + (i - j)^2));
        L = sum(i in 0..N, m * v[i]^2 / 2 - 3^i * k * x[i]^2 / 2);
        force q[l in 0..N] = -sum(i in 0..N, c * v[i] / (1 + (i - l)^2));
        discretize midpoint;
    }
}

/// The largest difference of the steps of five mixed oscillators from those of single ones, relative to the energy.
fn mixed<const S: usize>(h: f64) {
    let system = Mixed::default();
    let Mixed { m, k, c } = system;
    let places = [0.0, 1.0, 2.0, 3.0, 4.0_f64];
    let mix = vi_core::nalgebra::SMatrix::<f64, 5, 5>::from_fn(|i, j| 1.0 / (1.0 + (places[i] - places[j]).powi(2)));
    let start = State::at(&system, 0.0, [0.3, -0.2, 0.5, 0.1, -0.4], [0.2, 0.1, -0.3, 0.4, 0.5]);
    let mut run = system.at_state(start).integrate(Gauss::<S>, h).expect("a valid start");
    let mut worst = 0.0_f64;
    for _ in 0..20 {
        let before = run.state();
        let after = run.step().unwrap_or_else(|error| panic!("h = {h}, {S} stages: {error}"));
        // p = mixᵀ (m v).
        let decoupled = |state: &State<5>| (mix * state.q, mix.transpose().try_inverse().expect("regular") * state.p);
        let ((x, p), (x1, p1)) = (decoupled(&before), decoupled(&after));
        for i in 0..5 {
            let k = k * 3.0_f64.powi(i32::try_from(i).expect("a few"));
            let step = oscillator::<S>([m, k, c], h);
            let exact = step * vi_core::SVector::<f64, 2>::new(x[i], p[i]);
            let rate = (k / m).sqrt();
            let size = x.amax().max(p.amax() / (m * rate));
            worst = worst.max((x1[i] - exact[0]).abs().max((p1[i] - exact[1]).abs() / (m * rate)) / size);
        }
    }
    println!("h = {h}, {S} stages: off by {worst:.1e}, {} iterations in the last step", run.iterations());
    // The largest h ω is 15 h. Measured: 6.3e-16 of 1 + h ω.
    assert!(worst < 1e-15 * (1.0 + 15.0 * h.abs()), "h = {h}, {S} stages: {worst:e}");
}

#[test]
fn stiff_steps_of_long_systems_are_solved_side_by_side() {
    for h in [0.2, 2.0, 5.0, -1.0] {
        mixed::<1>(h);
        mixed::<2>(h);
        mixed::<5>(h);
        mixed::<6>(h);
    }
}

/// The largest difference of the steps of a linear chain from those of its modes, relative to its size.
fn linear_chain<const S: usize>(h: f64) {
    let system = FpuChain { m: 1.2, k: 3.4, alpha: 0.0, beta: 0.0 };
    let FpuChain { m, k, .. } = system;
    let sine = |i: usize, j: usize| {
        let turns = f64::from(u32::try_from((i + 1) * (j + 1)).expect("a few"));
        (turns * core::f64::consts::PI / 17.0).sin() * (2.0_f64 / 17.0).sqrt()
    };
    let modes = vi_core::nalgebra::SMatrix::<f64, 16, 16>::from_fn(sine);
    let place = |i: usize| f64::from(u32::try_from(i + 1).expect("a few"));
    let (q, v) = (core::array::from_fn(|i| (7.0 * place(i)).sin()), core::array::from_fn(|i| (3.0 * place(i)).cos()));
    let mut run = system.at(0.0, q, v).integrate(Gauss::<S>, h).expect("a valid start");
    let mut worst = 0.0_f64;
    for _ in 0..50 {
        let before = run.state();
        let after = run.step().unwrap_or_else(|error| panic!("h = {h}, {S} stages: {error}"));
        // The matrix of sines is its own inverse.
        let ([x, p], [x1, p1]) = ([before.q, before.p].map(|of| modes * of), [after.q, after.p].map(|of| modes * of));
        let highest = 2.0 * (k / m).sqrt();
        let size = x.amax().max(p.amax() / (m * highest));
        for j in 0..16 {
            let rate = highest * (place(j) * core::f64::consts::PI / 34.0).sin();
            let exact = oscillator::<S>([m, m * rate * rate, 0.0], h) * vi_core::SVector::<f64, 2>::new(x[j], p[j]);
            worst = worst.max((x1[j] - exact[0]).abs().max((p1[j] - exact[1]).abs() / (m * highest)) / size);
        }
    }
    println!("h = {h}, {S} stages: off by {worst:.1e}, {} iterations in the last step", run.iterations());
    // The largest h ω is 3.4 h. Measured: 4.3e-16 of 1 + h ω.
    assert!(worst < 1e-15 * (1.0 + 3.4 * h.abs()), "h = {h}, {S} stages: {worst:e}");
}

#[test]
fn each_mode_of_a_linear_chain_takes_its_rational_function() {
    for h in [0.3, 1.0, 1.5, 2.0, 3.0, 6.0, 30.0, -2.0] {
        linear_chain::<3>(h);
        linear_chain::<4>(h);
        linear_chain::<8>(h);
    }
}

lagrangian! {
    /// y is at rest where its curvature is infinite.
    struct Kink {
        const N = 2;
        coord x, y[N];
        L = (dot(x)^2 + sum(i in 0..N, dot(y[i])^2)) / 2 - sum(i in 0..N, abs(y[i])^(3/2)) - 5000 * x^2 - x^4;
        discretize midpoint;
    }
}

lagrangian! {
    /// The matrix of a step of length 2 is singular.
    struct Saddle {
        const N = 2;
        coord x, y[N];
        L = (dot(x)^2 + sum(i in 0..N, dot(y[i])^2)) / 2 + x^2 / 2 - 5000 * sum(i in 0..N, y[i]^2);
        discretize midpoint;
    }
}

lagrangian! {
    /// Oscillators whose matrices have squares beyond the range.
    struct Units {
        param m = 1.0;
        coord x, y;
        L = m * ((dot(x)^2 + dot(y)^2) / 2 - 5000 * x^2 - 10000 * y^2);
        discretize midpoint;
    }
}

/// The number of accepted steps; each satisfies its equations.
fn accepted<const S: usize, const N: usize>(
    mut run: vi_core::Run<Gauss<S>, impl vi_core::stepping::Convertible<N, Kind = vi_core::kind::Free>, N>,
) -> u32 {
    for steps in 0..20 {
        let before = run.state();
        let Ok(after) = run.step() else { return steps };
        let slots = run.slots().expect("a step was taken");
        let left = momenta_off(&slots, [&before, &after]);
        let size = before.p.amax().max(after.p.amax());
        assert!(left <= 1e-10 * size, "{S} stages: {left:e} of {size:e}");
    }
    20
}

#[test]
fn a_matrix_without_an_inverse_solves_nothing() {
    for h in [0.1, 1.0, -0.3] {
        let kink = Kink::default().at(0.0, [1.0, 0.0, 0.0], [0.0; 3]);
        assert_eq!(accepted(kink.integrate(Gauss::<2>, h).expect("a start")), 0, "{h}");
        assert_eq!(accepted(kink.integrate(Gauss::<3>, h).expect("a start")), 0, "{h}");
    }
    for h in [2.0, -2.0] {
        let saddle = Saddle::default().at(0.0, [1.0, 0.1, 0.2], [0.3, 0.2, 0.1]);
        assert_eq!(accepted(saddle.integrate(Gauss::<1>, h).expect("a start")), 0, "{h}");
    }
    for m in [1e-170, 1e160] {
        let units = Units { m }.at(0.0, [1.0, 0.5], [0.3, 0.2]);
        println!("{m:e}: {}", accepted(units.integrate(Gauss::<2>, 0.1).expect("a start")));
        println!("{m:e}: {}", accepted(units.integrate(Gauss::<4>, 0.1).expect("a start")));
    }
}

/// A chain at rest in its lowest mode.
pub(crate) fn lowest_mode() -> ([f64; 16], [f64; 16]) {
    let place = |i: usize| f64::from(u32::try_from(i + 1).expect("a few"));
    (core::array::from_fn(|i| (place(i) * core::f64::consts::PI / 17.0).sin()), [0.0; 16])
}

/// The residual of the slots at the end momenta, for very stiff steps.
fn chain<const S: usize>(h: f64) {
    let system = FpuChain::default();
    let (q, v) = lowest_mode();
    let start = State::at(&system, 0.0, q, v);
    let mut run = system.at_state(start).integrate(Gauss::<S>, h).expect("a valid start");
    let mut worst = 0.0_f64;
    let mut most = 0;
    for _ in 0..20 {
        let before = run.state();
        let after = run.step().unwrap_or_else(|error| panic!("h = {h}, {S} stages: {error}"));
        let slots = run.slots().expect("a step was taken");
        worst = worst.max(momenta_off(&slots, [&before, &after]));
        most = most.max(run.iterations());
    }
    println!("h = {h}, {S} stages: momenta off by {worst:.1e}, at most {most} iterations");
    // Measured: 4.2e-14, and 31.
    assert!(worst < 5e-14 && most < 32, "h = {h}, {S} stages: {worst:e}, {most} iterations");
}

#[test]
fn steps_of_a_chain_are_solved_where_its_fastest_modes_turn_twice() {
    chain::<4>(3.2);
    chain::<8>(3.2);
    // Extrapolation of the last step leads to where the cubic springs fail.
    chain::<12>(4.0);
    chain::<8>(6.4);
}

#[test]
fn stages_that_went_astray_are_not_taken_for_rounding() {
    let system = DoublePendulum::default();
    let start = State::at(&system, 0.0, [1.2, 0.5], [0.0, 0.0]);
    let energy = start.energy(&system).expect("an energy");
    for h in [0.2, 0.25, 0.4, 0.7, 2.0] {
        let mut run = system.at_state(start).integrate(Gauss::<8>, h).expect("a valid start");
        let mut worst = 0.0_f64;
        for _ in 0..3000 {
            match run.step() {
                Ok(state) => worst = worst.max((state.energy(&system).expect("an energy") - energy).abs()),
                Err(error) => {
                    assert!(matches!(error, StepError::StagesNotConverged { .. }), "h = {h}: {error}");
                    break;
                }
            }
        }
        println!("h = {h}: energy off by {worst:.1e} until t = {}", run.state().t);
        // Measured: 6.5e-1 with h = 0.4, whose steps are off by at most 1.3e-2 in an angle; 6.1e-2 with h = 0.7. Far from
        // the node the sine of an angle is arbitrary, and so is the residual of the stages: energies of order 10.
        assert!(worst < 0.7, "h = {h}: {worst:e}");
    }
}
