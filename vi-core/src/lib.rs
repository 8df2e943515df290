//! Run time of generated variational integrators.
//!
//! In: a system that `lagrangian!` generated, an initial state, a step length.
//! Out: an iterator of states, or a typed [`StepError`]. AFTER A STEP its residual was measured at the very unknowns that were taken,
//! row by row, and is at the rounding floor (`docs/mathematics.md`, section 8).
//!
//! | module | what it holds |
//! |---|---|
//! | [`real`] | the numbers that generated code computes with |
//! | [`mod@lagrangian`] | what a system says of itself, continuous and discrete |
//! | [`state`] | states, intervals, steps |
//! | [`node`] | nodes as the steppers carry them |
//! | [`linear`] | small linear systems, by their zero pattern |
//! | [`fixed_step`] | the variational integrator with a given step |
//! | [`composition`] | fixed steps of order 4, 6 and 8 |
//! | [`energy_preserving`] | the integrator that solves for its own step; its bounds, its fallback, its checkpoints |
//! | [`integrator`] | what all integrators share: states at times, on a grid, at events; inputs |
//! | [`derivatives`] | variations of steps and runs, gradients, Lyapunov exponents |
//! | [`condition`] | condition numbers of the equations that a step solves |
//! | [`checkpoint`] | a run between two steps, with the system that it is of |
//! | [`error`] | every way in which a step can fail, with its numbers |
//! | [`check`] | what has to hold for every right system, to call by hand or from `check { … }` |
//! | `momentum` | steps of a given length: predicted, corrected, measured; else searched |
//! | `predictor` | the guess of a step, by a polynomial through the last ones |
//! | `called` | a system whose functions are calls, for rare code |
//! | `forward` | the functions of a system, forwarded by a wrapper |
//! | `compensated` | sums that keep what rounding takes from them |
//!
//! Nothing here panics, allocates in a step (but for the room that the first stiff Gauss step makes), or prints.

// A call that is not inlined spills the run's state out of registers.
#![allow(clippy::inline_always)]

mod branch;
pub mod called;
pub mod check;
pub mod checkpoint;
pub mod collocation;
mod compensated;
pub mod composition;
pub mod condition;
mod delegate;
pub mod derivatives;
pub mod discrete;
pub mod energy_preserving;
pub mod error;
mod explained;
pub mod fixed_step;
mod forward;
pub mod gauss;
pub mod integrator;
pub mod lagrangian;
mod legendre;
pub mod linear;
mod momentum;
mod newton;
pub mod node;
mod predictor;
pub mod real;
pub mod rules;
pub mod state;
pub mod stepping;
#[doc(hidden)]
pub mod support;
mod vector;

pub use called::Called;
pub use composition::{Composition, Scheme};
pub use discrete::DiscreteLagrangian;
pub use energy_preserving::{EnergyPreserving, Fallback};
pub use error::StepError;
pub use fixed_step::FixedStep;
pub use gauss::Gauss;
pub use gauss::energy::EnergyPreservingGauss;
pub use gauss::scaled::ScaledGauss;
pub use integrator::Integrator;
pub use lagrangian::Lagrangian;
pub use nalgebra;
pub use nalgebra::SVector;
pub use state::{Interval, State, Step};
pub use vi_macros::lagrangian;
