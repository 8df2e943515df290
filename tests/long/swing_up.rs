//! The optimal swing-up of `examples`: its gradient against differences of runs, and its optimum against nearby inputs.

use crate::support::Sequence;
use example::{STEPS, SwingUp, TOLERANCE, solved};

#[path = "../../examples/swing_up.rs"]
#[allow(dead_code, reason = "its `main` is the example's")]
mod example;

/// Pseudo-random unit vectors.
fn directions() -> impl Iterator<Item = Vec<f64>> {
    let mut draw = Sequence::new(1);
    (0..10).map(move |_| {
        let direction: Vec<f64> = (0..STEPS).map(|_| draw.within(-1.0, 1.0)).collect();
        let norm = direction.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        direction.iter().map(|entry| entry / norm).collect()
    })
}

fn moved(forces: &[f64], direction: &[f64], by: f64) -> Vec<f64> {
    forces.iter().zip(direction).map(|(force, along)| force + by * along).collect()
}

/// The derivative of the cost along a direction, from differences of runs.
fn difference(problem: &SwingUp, forces: &[f64], direction: &[f64]) -> f64 {
    let value = |by| problem.value(&moved(forces, direction, by)).expect("a run");
    (value(1e-6) - value(-1e-6)) / 2e-6
}

#[test]
fn the_gradient_is_that_of_the_runs() {
    let problem = SwingUp::new().expect("a start");
    let forces: Vec<f64> = (0..STEPS).map(|step| f64::from(step).cos()).collect();
    let slope = problem.slope(&forces).expect("a gradient");
    for direction in directions() {
        let exact: f64 = slope.iter().zip(&direction).map(|(by, along)| by * along).sum();
        let found = difference(&problem, &forces, &direction);
        assert!((found - exact).abs() < 1e-6 * slope.iter().map(|by| by.abs()).fold(0.0, f64::max), "{found} {exact}");
    }
}

#[test]
fn the_pole_is_swung_up_and_no_other_forces_nearby_cost_less() {
    let (forces, problem) = solved().expect("a solution");
    let z = problem.end(&forces).expect("a run");
    assert!(z.norm() < TOLERANCE, "{z}");
    let least = problem.value(&forces).expect("a run");
    for direction in directions() {
        let slope = difference(&problem, &forces, &direction);
        // Measured: at most 1.3e-8, two roundings of the cost in the difference.
        assert!(slope.abs() < 2e-8, "{slope:e}");
        for by in [-0.05, 0.05] {
            assert!(problem.value(&moved(&forces, &direction, by)).expect("a run") > least);
        }
    }
}
