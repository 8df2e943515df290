//! Run time of generated variational integrators.
//!
//! Inputs are a system that `lagrangian!` generated, a state, a method and a step length. Outputs are states, or a
//! typed [`StepError`]. Every accepted step satisfies its equations to rounding: the residual of each row is at the
//! rounding floor (`docs/mathematics.md`, section 8).
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
//! | module | contents |
//! |---|---|
//! | [`mod@lagrangian`] | the continuous system: L, f, energy, momentum, flow |
//! | [`discrete`] | the discrete Lagrangian of a rule, with its derivatives |
//! | [`stepping`] | the momentum and energy equations of one step, and their derivatives |
//! | [`kind`] | free systems, and systems with constraints |
//! | [`motion`] | the equations of motion at one point, for Gauss steps |
//! | [`constrained`] | systems with constraints, for Gauss–Lobatto steps |
//! | [`first_order`] | systems whose L is linear in the velocities |
//! | `indexed` | large systems: all their functions from first and second derivatives by loops |
//! | [`rules`] | markers of the quadrature rules that `discretize` can name |
//! | [`state`], [`node`] | states, intervals and steps; nodes with compensated sums |
//! | [`method`] | the integrators, one file each |
//! | [`run`] | shared by all methods: steps, dense output, output at given times, events, error estimates, checkpoints |
//! | [`control`] | mass matrix, bias, inverse dynamics, linearizations, equilibria |
//! | [`derivatives`] | sensitivities to initial conditions and parameters, gradients, Lyapunov exponents |
//! | `momentum`, [`energy_preserving`], [`gauss`] | solvers of the step equations |
//! | `newton`, `solve`, [`linear`] | Newton iteration, root bracketing, small linear systems with their zero patterns |
//! | `vector`, `branch` | the unknowns of a step as one vector; the root that a fixed step takes if there are several |
//! | `predictor` | the initial guess of a step, extrapolated from the last steps |
//! | `legendre` | velocities from momenta |
//! | [`condition`] | condition numbers of the step equations |
//! | [`error`], `explained` | the typed failures of a step, with their numbers; the reason why an expression is not finite |
//! | [`check`] | tests of a system: derivatives, order, momenta, symplecticity; also from `check { … }` |
//! | [`function`], [`table`] | derivatives of Rust functions; functions given by points |
//! | [`real`] | number types: `f64`, duals, series, running error analysis, SIMD lanes |
//! | `compensated`, `angles` | compensated summation; angles as a reduced angle and a count of turns |
//! | [`called`], `delegate`, `forward` | wrappers of a system, for example with functions that are not inlined |
//! | `support` | internals for the other crates of this project |
//!
//! | feature | adds |
//! |---|---|
//! | `std`, by default | vectors of the widest instructions of this processor; `alloc` |
//! | `alloc` | Newton iteration of Gauss steps, compositions, systems with constraints, events, checkpoints, derivatives, control, checks |
//! | `serde` | checkpoints that can be stored |
//!
//! Without them nothing allocates, and functions are those of `libm` (`docs/microcontrollers.md`).
//!
//! Nothing here panics or prints. Stepping does not allocate, except for buffers at the first stiff Gauss step, at the first
//! step of a composition and at the first steps with constraints.

#![no_std]
// Some functions serve only modules that need `alloc`.
#![cfg_attr(not(feature = "alloc"), allow(dead_code, unreachable_pub))]
// A call that is not inlined spills the run's state out of registers.
#![allow(clippy::inline_always)]

#[cfg(feature = "alloc")]
#[cfg_attr(not(test), macro_use)]
extern crate alloc;
#[cfg(any(feature = "std", test))]
#[cfg_attr(test, macro_use)]
extern crate std;

mod angles;
mod branch;
pub mod called;
#[cfg(feature = "alloc")]
pub mod check;

mod compensated;
#[cfg(feature = "alloc")]
pub mod condition;
#[cfg(feature = "alloc")]
pub mod constrained;
#[cfg(feature = "alloc")]
pub mod control;
mod delegate;
mod dense_output;
#[cfg(feature = "alloc")]
pub mod derivatives;
pub mod discrete;
pub mod energy_preserving;
pub mod error;
mod explained;
pub mod first_order;
mod forward;
pub mod function;
pub mod gauss;
#[doc(hidden)]
pub mod indexed;
pub mod kind;
pub mod lagrangian;
mod legendre;
pub mod linear;
pub mod method;
mod momentum;
pub mod motion;
mod newton;
pub mod node;
mod predictor;
pub mod real;
mod rotation;
pub mod rules;
pub mod run;
mod solve;
pub mod state;
pub mod stepping;
#[doc(hidden)]
pub mod support;
pub mod table;
mod vector;

pub use called::{Called, Presumed};
#[cfg(feature = "alloc")]
pub use control::Dynamics;
pub use discrete::DiscreteLagrangian;
pub use error::StepError;
pub use lagrangian::Lagrangian;
pub use method::{
    Adaptive, Connected, EnergyPreserving, EnergyPreservingGauss, EnergyPreservingGaussLobatto, Fallback, FixedStep,
    Gauss, GaussLobatto, InTransformedTime, Method, Splitting,
};
#[cfg(feature = "alloc")]
pub use method::{Composed, Composition};
pub use nalgebra;
pub use nalgebra::SVector;
pub use run::{Run, Start, Starts, Tolerance};
pub use state::{Interval, State, Step};
pub use vi_macros::lagrangian;

/// The names that a typical program needs.
pub mod prelude {
    #[cfg(feature = "alloc")]
    pub use crate::control::Dynamics as _;
    pub use crate::error::StepError;
    #[cfg(feature = "alloc")]
    pub use crate::method::Composition;
    pub use crate::method::{EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, Method, Splitting};
    pub use crate::real::Number;
    #[cfg(feature = "alloc")]
    pub use crate::run::{Crossing, Event, Moment, Solution};
    pub use crate::run::{Monitored, Run, Start, Starts as _, Tolerance};
    pub use crate::state::State;
    pub use vi_macros::lagrangian;
}
