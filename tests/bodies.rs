//! Bodies with mutual attraction: the outer solar system against other programs, and three bodies on a figure of eight.

use crate::support::reference::{file, number, vector};
use serde_json::Value;
use vi_core::{Gauss, Run, SVector, Starts, State};
use vi_systems::{OuterSolarSystem, ThreeBody};

/// Momentum and angular momentum of the six bodies along one axis.
fn sums(state: &State<18>, axis: usize) -> [f64; 2] {
    let State { q, p, .. } = state;
    let i = (axis + 1) % 3 * 6;
    let j = (axis + 2) % 3 * 6;
    let momentum = (0..6).map(|body| p[axis * 6 + body]).sum();
    let angular = (0..6).map(|body| q[i + body] * p[j + body] - q[j + body] * p[i + body]).sum();
    [momentum, angular]
}

/// Largest difference of positions, and of velocities, from an entry of the reference.
fn off(run: &Run<Gauss<8>, OuterSolarSystem, 18>, expected: &Value) -> [f64; 2] {
    let state = run.state();
    let v = state.velocity(run.system()).expect("a mass matrix");
    let difference =
        |found: SVector<f64, 18>, list: &str| (found - SVector::from(vector::<18>(&expected[list]))).amax();
    assert!((state.t - number(&expected["t"])).abs() < 1e-9, "t = {}", state.t);
    [difference(state.q, "q"), difference(v, "v")]
}

#[test]
fn the_outer_solar_system_agrees_with_other_programs() {
    let reference = file("outer_solar_system.json");
    let system = OuterSolarSystem::default();
    let start = State::at(&system, 0.0, OuterSolarSystem::POSITIONS, OuterSolarSystem::VELOCITIES);
    let mut run = system.at_state(start).integrate(Gauss::<8>, 100.0).expect("a valid start");
    assert!(run.by_ref().take(200).all(|step| step.is_ok()));
    let [q, v] = off(&run, &reference["taylor"]);
    println!("20 000 days: q off by {q:.1e}, v by {v:.1e}");
    // Measured: 6.3e-14, at 41 AU, and 8.3e-17.
    assert!(q < 1e-13 && v < 2e-16, "{q:e}, {v:e}");
    assert!(run.by_ref().take(4800).all(|step| step.is_ok()));
    let [q, v] = off(&run, &reference["published"]);
    println!("500 000 days: q off by {q:.1e}, v by {v:.1e}");
    // Measured: 2.5e-12 and 4.1e-15. Taylor series with 40 digits differ from the published values by 1.9e-12 and
    // 3.2e-15.
    assert!(q < 5e-12 && v < 8e-15, "{q:e}, {v:e}");
}

#[test]
fn the_outer_solar_system_keeps_energy_momentum_and_angular_momentum() {
    let system = OuterSolarSystem::default();
    let start = State::at(&system, 0.0, OuterSolarSystem::POSITIONS, OuterSolarSystem::VELOCITIES);
    let energy = |state: &State<18>| state.energy(&system).expect("a mass matrix");
    let mut changes = [0.0_f64; 3];
    let mut swing = 0.0_f64;
    for state in system.at_state(start).integrate(Gauss::<8>, 100.0).expect("a valid start").take(5000) {
        let state = state.expect("a step");
        for axis in 0..3 {
            let [momentum, angular] = sums(&state, axis);
            let [momentum_0, angular_0] = sums(&start, axis);
            changes[0] = changes[0].max((momentum / momentum_0 - 1.0).abs());
            changes[1] = changes[1].max((angular / angular_0 - 1.0).abs());
        }
        changes[2] = changes[2].max((energy(&state) / energy(&start) - 1.0).abs());
        swing = swing.max((state.q - start.q).amax());
    }
    println!("relative changes of momentum, angular momentum, energy: {changes:?}");
    assert!(swing > 50.0, "the planets go round: {swing}");
    // Measured: 4.2e-15, 1.7e-14, 2.0e-15.
    assert!(changes.iter().zip([1e-14, 4e-14, 5e-15]).all(|(change, limit)| *change < limit), "{changes:?}");
}

#[test]
fn three_bodies_follow_one_another_on_the_figure_of_eight() {
    // Initial state and period by C. Simó.
    const PERIOD: f64 = 6.325_913_982_926_21;
    let system = ThreeBody::default();
    let [x, y] = [0.970_004_356_697_34, 0.243_087_531_535_83];
    let [u, w] = [0.466_203_685_720_52, 0.432_365_730_460_51];
    let start = State::at(&system, 0.0, [x, -x, 0.0, -y, y, 0.0], [u, u, -2.0 * u, w, w, -2.0 * w]);
    let mut run = system.at_state(start).integrate(Gauss::<8>, PERIOD / 60.0).expect("a valid start");
    // After a third of the period each body is at the initial position of another one; after a full period at its own.
    for ahead in [2, 1, 0] {
        let state = run.by_ref().take(20).last().expect("a step").expect("a step");
        let began = |of: SVector<f64, 6>| SVector::<f64, 6>::from_fn(|i, _| of[i / 3 * 3 + (i + ahead) % 3]);
        let q = (state.q - began(start.q)).amax();
        let p = (state.p - began(start.p)).amax();
        let energy = state.energy(&system).expect("a mass matrix") - start.energy(&system).expect("a mass matrix");
        let angular: f64 = (0..3).map(|i| state.q[i] * state.p[i + 3] - state.q[i + 3] * state.p[i]).sum();
        println!("off by {q:.1e}, {p:.1e}, energy by {energy:.1e}, angular momentum {angular:.1e}");
        assert!((state.q - start.q).amax() > 1.0 || ahead == 0);
        // Measured: 3.5e-14, 4.7e-14, 4.4e-16, 2.2e-16.
        assert!(q < 8e-14 && p < 1e-13 && energy.abs() < 1e-15 && angular.abs() < 5e-16);
    }
}
