//! The fixed step as a map: how damping contracts areas.

use crate::support::scenes::{Scene, damped_oscillator};
use vi_core::stepping::FixedStepping;
use vi_core::{FixedStep, SVector, Starts, State};

/// The state after `steps` steps of length `h`.
fn after<const N: usize, S: FixedStepping<N> + Copy>(system: S, start: State<N>, h: f64, steps: usize) -> State<N> {
    let run = system.at_state(start).integrate(FixedStep, h).unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
    run.take(steps).last().expect("a step").unwrap_or_else(|error| panic!("{}: {error}", S::NAME))
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
