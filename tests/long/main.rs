//! The tests across crates with many steps as one program, compiled with optimization.

mod angles;
mod derivatives_at_the_edge;
mod derivatives_of_runs;
mod energy_preserving_gauss;
mod events;
mod failures;
mod gauss;
mod gauss_scales;
mod gauss_slots;
mod gauss_stiff;
mod hunt;
mod invariants;
mod iterations;
mod kept_energies;
mod large;
mod motions;
mod robustness;
mod smoothness;
mod solvability;
#[path = "../support/mod.rs"]
mod support;
mod swing_up;
mod velocities;
