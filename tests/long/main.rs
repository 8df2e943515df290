//! The tests across crates with many steps as one program, compiled with optimization.

mod angles;
mod events;
mod failures;
mod invariants;
mod kept_energies;
mod large;
#[path = "../support/mod.rs"]
mod support;
mod swing_up;
