//! The files in `docs/expanded` equal the current expansions and compute the same as the macro's systems.
//!
//! After a change of the compiler, `UPDATE_EXPANDED=1 cargo test -p vi-systems --test expanded` rewrites them; read the
//! difference before you commit it.

#![allow(mixed_script_confusables, reason = "θ is the only Greek letter in these files")]

#[rustfmt::skip]
#[allow(clippy::trivially_copy_pass_by_ref, dead_code, unreachable_pub, reason = "the items of a library")]
#[path = "../../docs/expanded/damped_oscillator.rs"]
mod damped_oscillator;
#[rustfmt::skip]
#[allow(clippy::trivially_copy_pass_by_ref, dead_code, unreachable_pub, reason = "the items of a library")]
#[path = "../../docs/expanded/double_pendulum.rs"]
mod double_pendulum;
#[rustfmt::skip]
#[allow(clippy::trivially_copy_pass_by_ref, dead_code, unreachable_pub, reason = "the items of a library")]
#[path = "../../docs/expanded/kepler.rs"]
mod kepler;

use std::fs;
use std::path::Path;
use vi_codegen::inspect::{Stage, source, stage};
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Starts, State};

/// The expansion of the one system that a text declares.
fn expansion(text: &str) -> String {
    let declarations = source::declarations(text).expect("Rust");
    assert_eq!(declarations.len(), 1, "{text}");
    stage(declarations[0].clone(), Stage::Rust).expect("a right system")
}

#[test]
fn the_documented_expansions_are_todays() {
    for file in ["damped_oscillator", "double_pendulum", "kepler"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/expanded").join(file).with_extension("rs");
        let declared = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(file).with_extension("rs");
        let today = expansion(&fs::read_to_string(declared).expect("the declaration"));
        if std::env::var_os("UPDATE_EXPANDED").is_some() {
            fs::write(&path, &today).expect("the file can be written");
        }
        let documented = fs::read_to_string(&path).expect("the documented expansion");
        let line = documented.lines().zip(today.lines()).position(|(old, new)| old != new);
        assert!(documented == today, "{file}.rs differs from line {line:?} on; UPDATE_EXPANDED=1 writes it anew");
    }
}

#[test]
fn every_system_expands_to_the_same_bytes_twice() {
    for text in vi_systems::SOURCES {
        assert!(expansion(text) == expansion(text), "{text}");
    }
}

/// Bits of the states of both integrators over some steps.
fn bits<S: EnergyStepping<N>, const N: usize>(system: &S, q: [f64; N], v: [f64; N], h: f64) -> Vec<u64> {
    let mut numbers = Vec::new();
    let start = State::at(system, 0.0, q, v);
    for state in system.at_state(start).integrate(FixedStep, h).expect("a start").take(200) {
        let State { t, q, p, .. } = state.expect("a step");
        numbers.push(t);
        numbers.extend(q.iter().chain(p.iter()));
    }
    let mut run = EnergyPreserving::from_midpoint(system, 0.0, q, v, h).expect("a start");
    for step in run.detailed_steps().take(200) {
        let step = step.expect("a step");
        numbers.extend([step.t, step.energy, step.h]);
        numbers.extend(step.q.iter().chain(step.p.iter()));
    }
    assert_eq!(numbers.len(), 200 * (2 * (1 + 2 * N) + 2));
    numbers.into_iter().map(f64::to_bits).collect()
}

#[test]
fn the_documented_systems_move_as_the_macros_do() {
    let damped = bits(&damped_oscillator::DampedOscillator::default(), [1.0], [0.5], 0.01);
    assert!(damped == bits(&vi_systems::DampedOscillator::default(), [1.0], [0.5], 0.01));
    let kepler = bits(&kepler::Kepler::default(), [0.4, 0.0], [0.0, 2.0], 0.005);
    assert!(kepler == bits(&vi_systems::Kepler::default(), [0.4, 0.0], [0.0, 2.0], 0.005));
    let pendulum = bits(&double_pendulum::DoublePendulum::default(), [1.0, 1.0], [0.0, 0.0], 0.005);
    assert!(pendulum == bits(&vi_systems::DoublePendulum::default(), [1.0, 1.0], [0.0, 0.0], 0.005));
    // Another parameter gives another motion, so the compared values are not constant.
    let heavier = damped_oscillator::DampedOscillator { m: 1.5, ..Default::default() };
    assert!(damped != bits(&heavier, [1.0], [0.5], 0.01));
}
