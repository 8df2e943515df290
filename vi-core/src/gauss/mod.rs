//! Gauss steps: the stage equations and their solvers. [`Gauss`](crate::method::Gauss),
//! [`EnergyPreservingGauss`](crate::method::EnergyPreservingGauss) and
//! [`InTransformedTime`](crate::method::InTransformedTime) are the methods.
//!
//! | file | part of a step |
//! |---|---|
//! | `tableau` | the coefficients, computed at compile time in twice the precision (`pair`) |
//! | `lobatto` | the nodes between which constraints act, for [`GaussLobatto`](crate::method::GaussLobatto) |
//! | `stages` | arrays of stage values, laid out for SIMD |
//! | `separable`, `general`, `first_order` | the stage equations: forces of the position alone, any system with masses, and L linear in the velocities |
//! | `fixed_point` | fixed-point iteration to convergence |
//! | `solve` | the solver of a step, with runtime dispatch to SIMD instructions |
//! | `branch` | continuation of steps in their length, from h → 0 |
//! | `connected` | whether a long step continues short ones |
//! | `points` | the equations of motion at a point, generic and type-erased |
//! | `linearization` | the point of a linearization, and the stiffness of the step |
//! | `newton` | simplified Newton iteration, linearized at the middle of the step |
//! | `modes`, `factors` | the eigenbasis that splits its equations into small systems; their factors |
//! | `fixed_point_only` | in place of `newton` without the feature `alloc` |
//! | `polynomial` | dense output |
//! | `energies` | the discrete energies of a step |
//! | `density` | the step density of order 2s |
//! | `history` | the memory of energy-preserving steps |
//! | `slots` | the discrete Lagrangian of a step, with derivatives, forces and powers, for checks |
//! | `variation`, `curvature` | first and second derivatives of a step |
//! | `rounding` | residuals of stalled stages, by running error analysis |
//! | `transformed` | the same in transformed time |

// One index addresses several arrays, so that a SIMD register holds neighbours.
#![allow(clippy::needless_range_loop)]

pub(crate) mod branch;
mod connected;
#[cfg(feature = "alloc")]
pub(crate) mod curvature;
pub mod density;
pub(crate) mod energies;
#[cfg(feature = "alloc")]
mod factors;
mod first_order;
pub(crate) mod fixed_point;
pub(crate) mod general;
pub(crate) mod history;
pub mod linearization;
pub(crate) mod lobatto;
#[cfg(feature = "alloc")]
mod modes;
#[cfg_attr(not(feature = "alloc"), path = "fixed_point_only.rs")]
pub mod newton;
mod pair;
pub(crate) mod points;
pub(crate) mod polynomial;
mod rounding;
mod separable;
mod slots;
pub mod solve;
pub(crate) mod stages;
pub(crate) mod tableau;
pub mod transformed;
#[cfg(feature = "alloc")]
pub(crate) mod variation;

pub use density::step_density;
pub use polynomial::CollocationPolynomial;
pub use slots::Slots;
