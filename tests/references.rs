//! Trajectories against 50-digit references, for every system that has one.
//!
//! After 1000 steps the errors are far below the limits for plain `f64`: 5e-14 with fixed steps and 5e-9 with
//! energy-preserving ones, whose length is a second-order quantity (`docs/mathematics.md`).

use crate::support::reference::{file, number, steps, vector};
use serde_json::Value;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Run, Starts, State};
use vi_systems::{DampedOscillator, DoublePendulum, DoubleWell, HardDuffing, Kepler, Pendulum};

/// Number of steps for which the limits hold.
const STEPS: u32 = 1000;
/// Largest difference of fixed steps in (q, p, t). Measured: 4.1e-14, where the double well amplifies roundings.
const FIXED: f64 = 1e-13;
/// Largest difference of energy-preserving steps in (q, p, t). Measured: 9.5e-11.
const ENERGY_PRESERVING: f64 = 2e-10;

/// The largest difference to an entry of a reference.
fn difference<const N: usize>(state: &State<N>, entry: &Value) -> f64 {
    let (q, p) = (vector::<N>(&entry["q"]), vector::<N>(&entry["p"]));
    let each = (0..N).flat_map(|i| [(state.q[i] - q[i]).abs(), (state.p[i] - p[i]).abs()]);
    each.fold((state.t - number(&entry["t"])).abs(), f64::max)
}

/// Runs fixed steps through the entries of a reference.
fn fixed<const N: usize>(name: &str, system: impl EnergyStepping<N>, state: State<N>, h: f64, list: &Value) {
    let mut integrator = system.at_state(state).integrate(FixedStep, h).expect("a valid start");
    let (mut taken, mut worst) = (0, 0.0_f64);
    for (step, entry) in steps(list).into_iter().filter(|(step, _)| *step <= STEPS) {
        while taken < step {
            integrator.step().unwrap_or_else(|error| panic!("{name}: {error}"));
            taken += 1;
        }
        worst = worst.max(difference(&integrator.state(), entry));
    }
    println!("{name}: fixed, {taken} steps, off by {worst:.2e}");
    assert_eq!(taken, STEPS);
    assert!(worst <= FIXED, "{name}: off by {worst:e}");
}

/// Runs energy-preserving steps through the entries of a reference.
fn energy_preserving<const N: usize, S: EnergyStepping<N>>(
    name: &str,
    mut integrator: Run<EnergyPreserving, S, N>,
    first: u32,
    list: &Value,
) {
    let (mut taken, mut worst, mut iterations) = (first, 0.0_f64, 0);
    for (step, entry) in steps(list).into_iter().filter(|(step, _)| *step <= STEPS) {
        while taken < step {
            integrator.step().unwrap_or_else(|error| panic!("{name}: {error}"));
            iterations += integrator.iterations();
            taken += 1;
        }
        worst = worst.max(difference(&integrator.state(), entry));
        let energy = integrator.node().energy - number(&entry["E"]);
        assert!(energy.abs() <= ENERGY_PRESERVING, "{name}: energy off by {energy:e}");
    }
    let mean = f64::from(iterations) / f64::from(taken - first);
    println!("{name}: energy-preserving, {taken} steps, off by {worst:.2e}, {mean:.2} iterations a step");
    assert_eq!(taken, STEPS);
    assert!(worst <= ENERGY_PRESERVING, "{name}: off by {worst:e}");
    assert!(mean <= if N == 1 { 3.5 } else { 5.0 }, "{name}: {mean} iterations a step");
}

/// A system of `discrete_multi.json`: fixed steps from (q0, p0), energy-preserving steps from the midpoint start.
fn multi<const N: usize, S: EnergyStepping<N> + Copy>(name: &str, system: S) {
    let file = file("discrete_multi.json");
    let of = &file[name];
    let (q, v, p) = (vector::<N>(&of["q0"]), vector::<N>(&of["v0"]), vector::<N>(&of["p0"]));
    let h = number(&of["h0"]);
    let state = State::at(&system, 0.0, q, v);
    assert_eq!(state.p, p.into(), "{name}: p0");
    fixed(name, system, state, h, &of["fixed"]);
    let integrator = EnergyPreserving::from_midpoint(system, 0.0, q, v, h).expect("a valid start");
    let start = &of["adaptive_start"];
    let (found, p1) = (integrator.state(), vector::<N>(&start["p1"]));
    assert!((0..N).all(|i| (found.p[i] - p1[i]).abs() <= 1e-15), "{name}: p1 of the midpoint start");
    assert!((integrator.node().energy - number(&start["E1"])).abs() <= 4e-15, "{name}: E1 of the midpoint start");
    energy_preserving(name, integrator, 0, &of["adaptive"]);
}

/// A run of the paper: both integrators from the state `initial` of the paper's start.
fn paper<S: EnergyStepping<1> + Copy>(system: S, run: &Value) {
    let (name, initial) = (run["name"].as_str().expect("a name"), &run["initial"]);
    let (h, q, p) = (number(&run["h0"]), vector(&initial["q1"]), vector(&initial["p1"]));
    let state = State { t: number(&initial["t1"]), q: q.into(), p: p.into() };
    fixed(name, system, state, h, &run["fixed"]);
    let (energy, v) = (number(&initial["E1"]), vector::<1>(&initial["v_first"]));
    let integrator = EnergyPreserving::from_state(system, state, energy, h, v).expect("a valid start");
    energy_preserving(name, integrator, 0, &run["adaptive"]);
}

#[test]
fn hard_duffing() {
    multi::<1, _>("duffing_hard", HardDuffing::default());
}

#[test]
fn pendulum() {
    multi::<1, _>("pendulum", Pendulum::default());
}

#[test]
fn kepler() {
    multi::<2, _>("kepler", Kepler::default());
}

#[test]
fn double_pendulum() {
    multi::<2, _>("double_pendulum", DoublePendulum::default());
}

#[test]
fn double_well() {
    let runs = file("double_well.json");
    let runs = runs.as_array().expect("a list of runs");
    assert_eq!(runs.len(), 4);
    for run in runs {
        paper(DoubleWell::default(), run);
    }
}

#[test]
fn damped_oscillator() {
    let runs = file("damped_oscillator.json");
    let runs = runs.as_array().expect("a list of runs");
    assert_eq!(runs.len(), 2);
    for run in runs {
        paper(DampedOscillator { c: 4.0 * number(&run["zeta"]), ..DampedOscillator::default() }, run);
    }
}
