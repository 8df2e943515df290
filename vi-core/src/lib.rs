//! Run time of generated variational integrators.
//!
//! In: a system that `lagrangian!` generated, an initial state, a step length.
//! Out: an iterator of states, each solved to the rounding floor, or a typed [`StepError`].
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
//! | [`condition`] | condition numbers of the equations that a step solves |
//! | [`error`] | every way in which a step can fail, with its numbers |
//! | [`check`] | what has to hold for every right system, to call by hand or from `check { … }` |
//!
//! Nothing here panics, allocates in a step, or prints.

// A call in the loop over steps is a wall: what it is lent cannot stay in registers.
#![allow(clippy::inline_always)]

pub mod check;
mod closed_form;
mod compensated;
pub mod composition;
pub mod condition;
mod continuation;
pub mod energy_preserving;
pub mod error;
pub mod fixed_step;
mod forecast;
pub mod lagrangian;
pub mod linear;
mod momentum;
pub mod node;
pub mod real;
mod reciprocal;
pub mod state;
mod stride;

pub use composition::{Composition, Scheme};
pub use energy_preserving::{EnergyPreserving, Fallback, Switches};
pub use error::{Residuals, StepError};
pub use fixed_step::FixedStep;
pub use lagrangian::{
    Batch, DiscreteLagrangian, ExtendedSystem, Increment, Lagrangian, Magnitudes, MomentumEquation, Parameters,
    Stepping,
};
pub use nalgebra;
pub use nalgebra::{SMatrix, SVector};
pub use node::Node;
pub use real::{Real, Scalar};
pub use state::{Interval, Method, State, Step};
pub use vi_macros::lagrangian;
