//! Many trajectories of one system, each with its own parameters and initial state: with fixed steps of order 2
//! ([`Ensemble`]), or with any integrator ([`Runs`]).
//!
//! In: systems of one type, a state for each, a step h. Out: for each trajectory its state, or the typed error that
//! ended it and the number of its steps. A step solves the equations of [`vi_core::FixedStep`]. After each step the
//! residual of each trajectory, evaluated at its velocity, is at the rounding floor.
//!
//! Systems of up to three degrees of freedom with short functions
//! ([`FixedStepping::INLINED`](vi_core::stepping::FixedStepping::INLINED)) run in vector lanes, 64 trajectories per
//! task. Other systems run one `FixedStep` per trajectory, shared among threads: on one core this costs as much as
//! single runs.
//!
//! | module | content |
//! |---|---|
//! | [`ensemble`] | the ensemble of a caller: groups of trajectories on threads |
//! | `runs` | many runs of any integrator, on threads |
//! | `single` | a single trajectory |
//! | `group` | vector lanes, or one trajectory after the other |
//! | `block` | 64 trajectories in vector lanes, and the retry of rejected steps |
//! | `pass` | one step of a block: a branch-free loop, which LLVM vectorizes |
//! | `layout` | nodes and velocities of a block, one row per coordinate |
//! | `ended` | the end of a trajectory |
//!
//! A trajectory does not depend on its neighbours or on the number of threads, bit for bit. Processors with and without
//! fused multiply-add give results that differ by rounding.
//!
//! If the momentum equation has one root, a trajectory agrees with [`vi_core::FixedStep`] and with individually
//! converged steps to a few roundings, which the motion may amplify. If it has several roots, both take the one that is
//! connected with h = 0.

// A call inside a loop over trajectories prevents vectorization.
#![allow(clippy::inline_always)]

mod block;
mod ended;
pub mod ensemble;
mod group;
#[cfg(test)]
mod hunt;
mod layout;
mod pass;
mod runs;
mod single;

pub use ended::Ended;
pub use ensemble::Ensemble;
pub use runs::Runs;
