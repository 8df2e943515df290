//! Run time of generated variational integrators.
//!
//! In: a system that `lagrangian!` generated, a state, a method, a step length. Out: states, or a typed [`StepError`]. AFTER A STEP its residual was measured at the
//! very unknowns that were taken, row by row, and is at the rounding floor (`docs/mathematics.md`, section 8).
//!
//! ```
//! use vi_core::prelude::*;
//!
//! lagrangian! {
//!     struct Kepler {
//!         param mu = 1.0;
//!         coord x, y;
//!         let r = sqrt(x^2 + y^2);
//!         L = (dot(x)^2 + dot(y)^2) / 2 + mu / r;
//!         discretize midpoint;
//!     }
//! }
//!
//! # fn main() -> Result<(), StepError> {
//! let start = Kepler::default().at(0.0, [0.4, 0.0], [0.0, 2.0]);
//! let mut run = start.integrate(Gauss::<8>, 0.2)?;
//! println!("{}", run.at_times((0..=100).map(|k| 0.05 * f64::from(k)))?);
//! # Ok(())
//! # }
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | [`real`] | the numbers that generated code computes with |
//! | [`mod@lagrangian`] | what a system says of itself, continuous and discrete |
//! | [`state`] | states, intervals, steps |
//! | [`node`] | nodes as the steppers carry them |
//! | [`linear`] | small linear systems, by their zero pattern |
//! | [`method`] | how a step is found: one file for each method |
//! | [`run`] | what all methods share: steps, states at times, events, changes, checkpoints |
//! | `momentum`, [`energy_preserving`], [`gauss`] | the equations of a step, and their solution |
//! | [`derivatives`] | sensitivities to initial conditions and parameters, gradients, Lyapunov exponents |
//! | `solve` | solvers that do not depend on a method: a bracket of a root |
//! | [`condition`] | condition numbers of the equations that a step solves |
//! | [`error`] | every way in which a step can fail, with its numbers |
//! | [`check`] | what has to hold for every right system, to call by hand or from `check { … }` |
//! | `predictor` | the guess of a step, by a polynomial through the last ones |
//! | `called` | a system whose functions are not inlined, for cold code |
//! | `forward` | the functions of a system, forwarded by a wrapper |
//! | `compensated` | sums that keep what rounding takes from them |
//!
//! Nothing here panics, allocates in a step (but for the room that the first stiff Gauss step makes), or prints.

// A call that is not inlined spills the run's state out of registers.
#![allow(clippy::inline_always)]

mod branch;
pub mod called;
pub mod check;
pub mod collocation;
mod compensated;
pub mod condition;
mod delegate;
pub mod derivatives;
pub mod discrete;
pub mod energy_preserving;
pub mod error;
mod explained;
mod forward;
pub mod gauss;
pub mod lagrangian;
mod legendre;
pub mod linear;
pub mod method;
mod momentum;
mod newton;
pub mod node;
mod predictor;
pub mod real;
pub mod rules;
pub mod run;
mod solve;
pub mod state;
pub mod stepping;
#[doc(hidden)]
pub mod support;
mod vector;

pub use called::Called;
pub use discrete::DiscreteLagrangian;
pub use error::StepError;
pub use lagrangian::Lagrangian;
pub use method::{
    Composition, Connected, EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, InTransformedTime,
    Method,
};
pub use nalgebra;
pub use nalgebra::SVector;
pub use run::{Run, Start, Starts, Tolerance};
pub use state::{Interval, State, Step};
pub use vi_macros::lagrangian;

/// What a user's file needs.
pub mod prelude {
    pub use crate::error::StepError;
    pub use crate::method::{Composition, EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, Method};
    pub use crate::run::{Crossing, Event, Moment, Monitored, Run, Solution, Start, Starts as _, Tolerance};
    pub use crate::state::State;
    pub use vi_macros::lagrangian;
}
