//! Derivatives of a motion: by its start, and by the parameters of its system.
//!
//! In: a run, and directions in which its start and its parameters vary. Out: the variations of every node, by the implicit function theorem on the solved
//! step: where u solves `R(u, z0, θ) = 0` and `z1 = Z(u, z0, θ)`,
//!
//! ```text
//! δu = −(∂R/∂u)⁻¹ (∂R/∂z0 δz0 + ∂R/∂θ δθ)        δz1 = ∂Z/∂u δu + ∂Z/∂z0 δz0 + ∂Z/∂θ δθ
//! ```
//!
//! the derivatives of R and Z by coordinates and unknowns as the system says them, those by the time and by parameters in dual numbers. They are those of the step that
//! was taken, to rounding, not of the continuous motion: the tangent map of a variational integrator without force is symplectic, to rounding too. An energy-preserving
//! step varies in its length besides.
//!
//! | file | what it gives |
//! |---|---|
//! | `variation` | directions, and the dual numbers that they are |
//! | `steps` | variations of one step, for each method |
//! | `tangent` | tangent vectors along a run, to times, events and across changes |
//! | `adjoint` | the gradient of what a run ends in, by one sweep backwards |
//! | `lyapunov` | Lyapunov exponents |

mod adjoint;
mod lyapunov;
mod steps;
mod tangent;
mod variation;

pub use adjoint::{Covector, Gradient, Objective, gradient};
pub use lyapunov::Lyapunov;
pub use steps::Differentiable;
pub(crate) use steps::{Sought, check_fallback, not_last, singular};
pub use tangent::Tangent;
pub use variation::Variation;
pub(crate) use variation::{TOGETHER, Varied, changes_of_energy, more_parameters, not_finite};
