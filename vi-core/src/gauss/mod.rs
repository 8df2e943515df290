//! Gauss steps: the equations of their stages, and the solution of these. [`Gauss`](crate::method::Gauss), [`EnergyPreservingGauss`](crate::method::EnergyPreservingGauss)
//! and [`InTransformedTime`](crate::method::InTransformedTime) are the methods.
//!
//! | file | part of a step |
//! |---|---|
//! | `tableau` | the coefficients, computed by the compiler in twice the precision (`pair`) |
//! | `stages` | numbers of all stages side by side |
//! | `separable`, `general` | the equations of the stages: forces of the position alone, and any system |
//! | `sweep` | fixed-point iteration over the stages until they no longer move |
//! | `solve` | the solution of a step by the instructions of the processor |
//! | `points` | a system as these equations see it, and as cold code does |
//! | `newton` | simplified Newton iterations about the middle of the step |
//! | `modes` | the basis in which these are small systems of equations |
//! | `polynomial` | the motion between the nodes of a step |
//! | `energies` | the discrete energies of a step |
//! | `density` | the step density of order 2s |
//! | `course` | what energy-preserving steps remember |
//! | `slots` | the discrete Lagrangian of a step, with derivatives, forces and powers, for checks |
//! | `variation` | derivatives of a step |
//! | `rounding` | whether stages that stall are solved, by running error analysis |
//! | `transformed` | the same in transformed time |

// The index is that of several arrays, of which a vector register holds neighbours.
#![allow(clippy::needless_range_loop)]

pub(crate) mod course;
pub mod density;
pub(crate) mod energies;
mod general;
mod modes;
pub mod newton;
mod pair;
pub(crate) mod points;
mod polynomial;
mod rounding;
mod separable;
mod slots;
pub mod solve;
pub(crate) mod stages;
pub(crate) mod sweep;
mod tableau;
pub mod transformed;
mod variation;

pub use density::step_density;
pub use polynomial::Polynomial;
pub use slots::Slots;
