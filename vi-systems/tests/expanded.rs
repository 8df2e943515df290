//! The file `docs/expanded/kepler.rs` equals the current expansion and computes the same as the macro's system.
//!
//! After a change of the compiler, `UPDATE_EXPANDED=1 cargo test -p vi-systems --test expanded` rewrites it; read the
//! difference before you commit it.

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
fn the_documented_expansion_is_todays() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/expanded/kepler.rs");
    let today = expansion(include_str!("../src/kepler.rs"));
    if std::env::var_os("UPDATE_EXPANDED").is_some() {
        fs::write(&path, &today).expect("the file can be written");
    }
    let documented = fs::read_to_string(&path).expect("the documented expansion");
    let line = documented.lines().zip(today.lines()).position(|(old, new)| old != new);
    assert!(documented == today, "kepler.rs differs from line {line:?} on; UPDATE_EXPANDED=1 writes it anew");
}

#[test]
fn every_system_expands_to_the_same_bytes_twice() {
    for text in vi_systems::SOURCES {
        assert!(expansion(text) == expansion(text), "{text}");
    }
}

/// Bits of the states of both integrators over some steps.
fn bits<S: EnergyStepping<2>>(system: &S) -> Vec<u64> {
    let (q, v, h) = ([0.4, 0.0], [0.0, 2.0], 0.005);
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
    assert_eq!(numbers.len(), 200 * (2 * (1 + 2 * 2) + 2));
    numbers.into_iter().map(f64::to_bits).collect()
}

#[test]
fn the_documented_system_moves_as_the_macros_does() {
    let documented = bits(&kepler::Kepler::default());
    assert!(documented == bits(&vi_systems::Kepler::default()));
    // Another parameter gives another motion, so the compared values are not constant.
    assert!(documented != bits(&kepler::Kepler { mu: 1.5 }));
}
