//! The fixed step as a map: its own inverse under h → −h, and symplectic without force.

use crate::support::scenes::{Scene, damped_oscillator, each_system};
use vi_core::stepping::FixedStepping;
use vi_core::{FixedStep, SVector, Starts, State};

/// The state after `steps` steps of length `h`.
fn after<const N: usize, S: FixedStepping<N> + Copy>(system: S, start: State<N>, h: f64, steps: usize) -> State<N> {
    let run = system.at_state(start).integrate(FixedStep, h).unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
    run.take(steps).last().expect("a step").unwrap_or_else(|error| panic!("{}: {error}", S::NAME))
}

/// The midpoint rule and its forces are symmetric in both ends, so damped systems are reversed too.
fn reversible<const N: usize, S: FixedStepping<N> + Copy>(scene: Scene<S, N>) {
    const STEPS: usize = 100;
    let Scene { system, q, v, h, .. } = scene;
    let start = State::at(&system, 0.2, q, v);
    let there = after(system, start, 2.0 * h, STEPS);
    let back = after(system, there, -2.0 * h, STEPS);
    let error = (back.q - start.q).amax().max((back.p - start.p).amax()).max((back.t - start.t).abs());
    println!("{}: forth and back again, off by {error:.1e}", S::NAME);
    assert!((there.q - start.q).amax().max((there.p - start.p).amax()) > 0.1, "{}: nothing moved", S::NAME);
    // Measured: at most 3.8e-15.
    assert!(error <= 1e-14, "{}: off by {error:e}", S::NAME);
}

/// Derivative of the map of one step, by central differences of fourth order; columns are q, then p.
fn derivative<const N: usize, S: FixedStepping<N> + Copy>(system: S, start: State<N>, h: f64) -> Vec<Vec<f64>> {
    const DISTANCE: f64 = 5e-4;
    let moved = |column: usize, distance: f64| -> Vec<f64> {
        let mut state = start;
        let entry = if column < N { &mut state.q[column] } else { &mut state.p[column - N] };
        *entry += distance;
        let state = after(system, state, h, 1);
        state.q.iter().chain(state.p.iter()).copied().collect()
    };
    let differentiated = |column: usize| -> Vec<f64> {
        let near = [moved(column, DISTANCE), moved(column, -DISTANCE)];
        let far = [moved(column, 2.0 * DISTANCE), moved(column, -2.0 * DISTANCE)];
        let entry = |i: usize| (8.0 * (near[0][i] - near[1][i]) - (far[0][i] - far[1][i])) / (12.0 * DISTANCE);
        (0..2 * N).map(entry).collect()
    };
    (0..2 * N).map(differentiated).collect()
}

/// The largest entry of `MᵀJM − J` for the columns of M.
fn defect<const N: usize>(columns: &[Vec<f64>]) -> f64 {
    let product = |a: &[f64], b: &[f64]| (0..N).map(|i| a[i] * b[i + N] - a[i + N] * b[i]).sum::<f64>();
    let wanted = |i: usize, j: usize| f64::from(u8::from(i + N == j)) - f64::from(u8::from(j + N == i));
    let each = (0..2 * N).flat_map(|i| (0..2 * N).map(move |j| (i, j)));
    each.fold(0.0, |worst, (i, j)| f64::max(worst, (product(&columns[i], &columns[j]) - wanted(i, j)).abs()))
}

/// Without force the map of one step is symplectic. The forces of all forced systems damp, and the same check detects
/// it.
fn symplectic<const N: usize, S: FixedStepping<N> + Copy>(scene: Scene<S, N>) {
    let Scene { system, q, v, h, .. } = scene;
    let defect = defect::<N>(&derivative(system, State::at(&system, 0.2, q, v), 4.0 * h));
    println!("{}: M'JM - J = {defect:.1e}", S::NAME);
    if S::FORCED {
        // Measured: 1.5e-2 to 4.7e-2.
        assert!(defect > 1e-2, "{}: {defect:e}", S::NAME);
    } else {
        // Measured: 2.7e-12 for Kepler's problem, whose differences are least accurate, otherwise at most 2.7e-13.
        assert!(defect <= 1e-11, "{}: {defect:e}", S::NAME);
    }
}

mod backwards {
    super::each_system!(super::reversible);
}

mod one_step_is_symplectic_unless_damped {
    super::each_system!(super::symplectic);
}

#[test]
fn damping_contracts_areas_as_the_midpoint_rule_predicts() {
    // m (v1 − v0) = −h (k x̄ + c v̄) in the variables (x, p): det M = (1 + a − b)/(1 + a + b) with a = h² k/(4 m), b = h c/(2 m).
    let Scene { system, q, v, .. } = damped_oscillator();
    let h = 0.4;
    let (a, b) = (h * h * system.k / (4.0 * system.m), h * system.c / (2.0 * system.m));
    let columns = derivative(system, State::at(&system, 0.0, q, SVector::from(v)), h);
    let determinant = columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0];
    let wanted = (1.0 + a - b) / (1.0 + a + b);
    assert!(wanted < 0.98);
    // Measured: 2.8e-13.
    assert!((determinant - wanted).abs() <= 1e-12, "{determinant} instead of {wanted}");
}
