//! Gauss–Lobatto steps against trajectories computed in 40-digit arithmetic (`tests/reference/constraints.json` at the
//! root of the project).

use super::systems::{Auto, DoublePendulum, Driven, General, HeavyTop, Model, PENDULUM, RollingDisk, Sleigh};
use crate::references::{number, reference, vector};
use serde_json::Value;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Run, SVector, Starts, State};

/// Largest difference of q and p, relative to the size of the state.
fn difference<const N: usize>(state: &State<N>, expected: &Value) -> f64 {
    let (q, p): (SVector<f64, N>, SVector<f64, N>) = (vector(&expected["q"]), vector(&expected["p"]));
    (state.q - q).amax().max((state.p - p).amax()) / q.amax().max(p.amax())
}

fn start<S: Convertible<N>, const N: usize, const STAGES: usize>(
    system: S,
    case: &Value,
    h: f64,
) -> Run<Gauss<STAGES>, S, N> {
    let start = system.at(number(&case["t0"]), vector::<N>(&case["q0"]), vector::<N>(&case["v0"]));
    let p: SVector<f64, N> = vector(&case["p0"]);
    assert!((start.state.p - p).amax() <= 1e-15 * p.amax(), "{} {p}", start.state.p);
    start.integrate(Gauss::<STAGES>, h).unwrap_or_else(|error| panic!("{error}"))
}

/// Differences after steps 1, 10, 100, and of the impulses of the midpoint rule.
fn check<M: Model<N, K>, const N: usize, const K: usize, const STAGES: usize>(
    system: Auto<M, K>,
    case: &Value,
    table: &str,
) {
    let mut run = start::<_, N, STAGES>(system, case, number(&case["h"]));
    let mut done = 0;
    for (expected, bound) in case[table].as_array().expect("a table").iter().zip(BOUNDS) {
        let step = expected["step"].as_u64().expect("a count");
        for _ in done..step {
            run.step().unwrap_or_else(|error| panic!("{} {table} {step}: {error}", M::NAME));
            assert!(run.residual() <= 4.0, "{} {table}: {}", M::NAME, run.residual());
        }
        done = step;
        let difference = difference(&run.state(), expected);
        println!("{} {table} step {step}: {difference:.1e}, {} iterations", M::NAME, run.iterations());
        assert!(difference < bound, "{} {table} step {step}: {difference:e}", M::NAME);
        if expected["lam"].is_array() {
            let impulses = run.impulses().expect("a step");
            let [lambda, mu] = [&expected["lam"], &expected["mu"]].map(vector::<K>);
            let off = (SVector::from(impulses.lambda[0]) - lambda).amax().max((SVector::from(impulses.mu) - mu).amax());
            println!("{} impulses, step {step}: {off:.1e}", M::NAME);
            // Measured: at most 8.9e-15. g is known to a rounding, and an impulse is g over h.
            assert!(off < 2e-14, "{} impulses, step {step}: {off:e}", M::NAME);
        }
    }
}

fn holonomic<M: Model<N, K>, const N: usize, const K: usize>(system: Auto<M, K>, name: &str) {
    let case = &reference("constraints")["holonomic"][name];
    check::<M, N, K, 1>(system, case, "fixed");
    check::<M, N, K, 2>(system, case, "gauss_lobatto_s2");
    check::<M, N, K, 3>(system, case, "gauss_lobatto_s3");
}

fn nonholonomic<M: Model<N, K>, const N: usize, const K: usize>(system: Auto<M, K>, name: &str) {
    let case = &reference("constraints")["nonholonomic"][name];
    check::<M, N, K, 1>(system, case, "fixed");
    check::<M, N, K, 2>(system, case, "gauss_lobatto_s2");
}

/// Largest differences after 1, 10 and 100 steps. Measured: at most 2.9e-16, 3.6e-16 and 4.4e-15.
const BOUNDS: [f64; 3] = [1e-15, 1e-15, 1e-14];

#[test]
fn holonomic_steps_are_those_of_forty_digits() {
    holonomic(PENDULUM, "pendulum");
    holonomic(Auto(DoublePendulum), "double_pendulum");
    holonomic(Auto(HeavyTop { j: 1.0 }), "heavy_top");
    holonomic(Auto(Driven), "driven_pendulum");
    holonomic(Auto(General), "general");
}

#[test]
fn nonholonomic_steps_are_those_of_forty_digits() {
    nonholonomic(Auto(Sleigh { turns: false }), "sleigh");
    nonholonomic(Auto(Sleigh { turns: true }), "turntable_sleigh");
    nonholonomic(Auto(RollingDisk), "rolling_disk");
}

/// The discrete energy at the end of the first step, against the energy that the energy-preserving step carries: its
/// first step is a fixed one, and its energy is less by the shift.
fn energy<M: Model<N, K>, const N: usize, const K: usize, const STAGES: usize>(
    system: Auto<M, K>,
    case: &Value,
    run: &Value,
) {
    let h = number(&run["h0"]);
    let mut run_of = start::<_, N, STAGES>(system, case, h);
    run_of.step().unwrap_or_else(|error| panic!("{error}"));
    // C_s = (s!)⁴/((2s)!)³.
    let added = if STAGES == 1 { h * h / 8.0 } else { h.powi(4) / 864.0 };
    let expected = number(&run["steps"][0]["E_shifted_carried"]) + added * plain(&run["shift"]);
    let found = run_of.discrete_energy().expect("a step");
    println!("{} s = {STAGES}: {found} {expected} {:.1e}", M::NAME, found - expected);
    // Measured: at most 1.8e-14, for the pendulum with 30.8.
    assert!((found - expected).abs() < 4e-14, "{} {found} {expected}", M::NAME);
}

/// A number, as text or not.
fn plain(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| number(value))
}

#[test]
fn discrete_energies_are_those_of_forty_digits() {
    let all = reference("constraints");
    // The start of the energy-preserving runs, which is that of the system but for the pendulum.
    let of = |name: &str, start: &str, run: &str| {
        let (mut case, runs) = (all["holonomic"][name].clone(), &all["energy_preserving"][start]);
        (case["q0"], case["v0"]) = (runs["q0"].clone(), runs["v0"].clone());
        if start == "pendulum_rotation" {
            case["p0"] = case["v0"].clone();
        }
        (case, runs["runs"][run].clone())
    };
    let (case, run) = of("pendulum", "pendulum_rotation", "order2_shift0");
    energy::<_, 2, 1, 1>(PENDULUM, &case, &run);
    let (case, run) = of("pendulum", "pendulum_rotation", "order4_shift1400000");
    energy::<_, 2, 1, 2>(PENDULUM, &case, &run);
    let (case, run) = of("double_pendulum", "double_pendulum", "order2_shift0");
    energy::<_, 4, 2, 1>(Auto(DoublePendulum), &case, &run);
    let (case, run) = of("heavy_top", "heavy_top", "order2_shift0");
    energy::<_, 4, 1, 1>(Auto(HeavyTop { j: 1.0 }), &case, &run);
    let (case, run) = of("driven_pendulum", "driven_pendulum", "order2_shift400");
    energy::<_, 2, 1, 1>(Auto(Driven), &case, &run);
    let (case, run) = of("general", "general", "order2_shift100");
    energy::<_, 2, 1, 1>(Auto(General), &case, &run);
    let (case, run) = of("general", "general", "order4_shift1000");
    energy::<_, 2, 1, 2>(Auto(General), &case, &run);
    let case = &all["nonholonomic"]["sleigh"];
    energy::<_, 3, 1, 1>(Auto(Sleigh { turns: false }), case, &case["energy_preserving"]);
    let case = &all["nonholonomic"]["turntable_sleigh"];
    energy::<_, 3, 1, 1>(Auto(Sleigh { turns: true }), case, &case["energy_preserving"]);
    let case = &all["nonholonomic"]["rolling_disk"];
    energy::<_, 5, 2, 1>(Auto(RollingDisk), case, &case["energy_preserving"]);
}
