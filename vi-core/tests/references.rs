//! The steppers against trajectories computed in 50-digit arithmetic (`tests/reference` at the root of the project).

use crate::systems::{DampedOscillator, DoubleWell, ForcedDuffing, Kepler, Steppable, UnitMass};
use serde_json::Value;
use vi_core::{EnergyPreserving, FixedStep, Run, SVector, Starts, State};

/// Bounds on the difference after 1000 steps, absolute, in t, q and p.
/// Measured: at most 1.4e-14 and 8.3e-11; the step length is a second-order quantity.
const FIXED: f64 = 5e-14;
const ENERGY_PRESERVING: f64 = 5e-10;

pub(crate) fn reference(name: &str) -> Value {
    let path = format!("{}/../../tests/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The number at `key`, written as a decimal or as a quotient.
pub(crate) fn number(value: &Value) -> f64 {
    let text = value.as_str().unwrap_or_else(|| panic!("not a number: {value}"));
    let parse = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("not a number: {text}"));
    text.split_once('/').map_or_else(|| parse(text), |(above, below)| parse(above) / parse(below))
}

/// The vector at `key`: a list, or a single number.
pub(crate) fn vector<const N: usize>(value: &Value) -> SVector<f64, N> {
    match value.as_array() {
        Some(entries) => SVector::from_iterator(entries.iter().map(number)),
        None => SVector::repeat(number(value)),
    }
}

/// The entry of a list of references for 1000 steps.
fn thousandth(list: &Value) -> &Value {
    let is_it = |entry: &&Value| [&entry["step"], &entry["steps_after_start"]].iter().any(|n| n.as_u64() == Some(1000));
    list.as_array().and_then(|list| list.iter().find(is_it)).unwrap_or_else(|| panic!("no step 1000"))
}

/// Largest difference in t, q and p.
fn difference<const N: usize>(state: &State<N>, expected: &Value) -> f64 {
    let q = (state.q - vector(&expected["q"])).amax();
    let p = (state.p - vector(&expected["p"])).amax();
    (state.t - number(&expected["t"])).abs().max(q).max(p)
}

/// Both integrators from the start of `case`; the differences after 1000 steps, fixed and energy-preserving.
fn differences<const N: usize, P: Steppable<N>>(
    system: &UnitMass<P>,
    case: &Value,
    fixed: State<N>,
    mut adaptive: Run<EnergyPreserving, &UnitMass<P>, N>,
) -> (f64, f64) {
    let mut fixed =
        system.at_state(fixed).integrate(FixedStep, number(&case["h0"])).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..1000 {
        fixed.step().unwrap_or_else(|error| panic!("{error}"));
        adaptive.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let expected = thousandth(&case["adaptive"]);
    // Measured: at most 2.5e-11.
    assert!((adaptive.h() / number(&expected["h"]) - 1.0).abs() < 1e-10);
    (difference(&fixed.state(), thousandth(&case["fixed"])), difference(&adaptive.state(), expected))
}

/// From the paper's start: p1 and E1 of the reference.
fn from_paper<P: Steppable<1>>(system: &UnitMass<P>, case: &Value) -> (f64, f64) {
    let initial = &case["initial"];
    let start = State { t: number(&initial["t1"]), q: vector(&initial["q1"]), p: vector(&initial["p1"]) };
    let v: SVector<f64, 1> = vector(&initial["v_first"]);
    let adaptive = EnergyPreserving::from_state(system, start, number(&initial["E1"]), number(&case["h0"]), v);
    differences(system, case, start, adaptive.unwrap_or_else(|error| panic!("{error}")))
}

/// From the state at t0: the fixed step from there, the other integrator from its midpoint start.
fn from_midpoint<const N: usize, P: Steppable<N>>(system: &UnitMass<P>, case: &Value) -> (f64, f64) {
    let (t0, q0, v0) = (number(&case["t0"]), vector(&case["q0"]), vector(&case["v0"]));
    let adaptive = EnergyPreserving::from_midpoint(system, t0, q0, v0, number(&case["h0"]));
    let adaptive = adaptive.unwrap_or_else(|error| panic!("{error}"));
    let start = &case["adaptive_start"];
    assert!((adaptive.state().q - vector(&start["q1"])).amax() < 1e-16);
    // Measured: 0.
    assert!((adaptive.state().p - vector(&start["p1"])).amax() < 5e-16);
    assert!((adaptive.node().energy - number(&start["E1"])).abs() < 5e-16);
    differences(system, case, State::at(system, t0, q0, v0), adaptive)
}

fn assert_close(name: &str, (fixed, energy_preserving): (f64, f64)) {
    assert!(fixed < FIXED, "{name}, fixed step: {fixed:e}");
    assert!(energy_preserving < ENERGY_PRESERVING, "{name}, energy-preserving: {energy_preserving:e}");
}

#[test]
fn double_well_follows_the_reference() {
    let cases = reference("double_well");
    let cases = cases.as_array().unwrap_or_else(|| panic!("not a list"));
    assert_eq!(cases.len(), 4);
    for case in cases {
        assert_close(case["name"].as_str().unwrap_or("?"), from_paper(&UnitMass(DoubleWell), case));
    }
}

#[test]
fn damped_oscillator_follows_the_reference() {
    let cases = reference("damped_oscillator");
    let cases = cases.as_array().unwrap_or_else(|| panic!("not a list"));
    assert_eq!(cases.len(), 2);
    for case in cases {
        let system = UnitMass(DampedOscillator { k: 4.0, c: 4.0 * number(&case["zeta"]) });
        assert_close(case["name"].as_str().unwrap_or("?"), from_paper(&system, case));
    }
}

#[test]
fn forced_duffing_and_kepler_follow_the_reference() {
    let cases = reference("discrete_multi");
    assert_close("duffing", from_midpoint(&UnitMass(ForcedDuffing), &cases["duffing_hard"]));
    assert_close("kepler", from_midpoint(&UnitMass(Kepler { mu: 1.0 }), &cases["kepler"]));
}
