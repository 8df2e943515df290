//! Many trajectories of one system, each with its own parameters and its own start: by fixed steps of order 2 ([`Ensemble`]), or by
//! any integrator ([`Runs`]).
//!
//! In: systems of one kind, a state for each, one step h. Out: for each trajectory the state reached, or the typed error
//! that it ended with and the step at which it did. The equations of a step are those of [`vi_core::FixedStep`]. AFTER A STEP the
//! residual of each trajectory was measured at the velocity that was taken, and is at the rounding floor.
//!
//! Systems of up to three degrees of freedom whose functions are short ([`FixedStepping::INLINED`](vi_core::stepping::FixedStepping::INLINED)) go side by
//! side in vector lanes, 64 trajectories a thread at a time. All others are one `FixedStep` a trajectory, shared among threads: on
//! one core that costs what single runs cost.
//!
//! | module | what it holds |
//! |---|---|
//! | [`ensemble`] | the trajectories of a caller, in groups, over threads |
//! | `runs` | many runs of any integrator, over threads |
//! | `alone` | a trajectory by itself |
//! | `group` | whether trajectories go side by side or one after the other |
//! | `block` | 64 trajectories side by side, and what becomes of one that the common path refuses |
//! | `sweep` | one step of a block: a loop without a branch, which the compiler turns into vector instructions |
//! | `layout` | nodes and velocities of a block, one row per coordinate |
//! | `ended` | how a trajectory ended |
//!
//! A trajectory depends neither on its neighbours nor on the number of threads, bit for bit; on processors with and
//! without fused multiply-add it differs by rounding.
//!
//! Where the momentum equation has one root only, a trajectory agrees with [`vi_core::FixedStep`] and with steps converged
//! each by itself, to a few roundings, which the motion may enlarge. Where it has several, the root taken depends on the guess, and
//! an ensemble guesses otherwise: there it need not agree.

// A call inside a loop over trajectories keeps it from becoming vector instructions.
#![allow(clippy::inline_always)]

mod alone;
mod block;
mod ended;
pub mod ensemble;
mod group;
#[cfg(test)]
mod hunt;
mod layout;
mod runs;
mod sweep;

pub use ended::Ended;
pub use ensemble::Ensemble;
pub use runs::Runs;
