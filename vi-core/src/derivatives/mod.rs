//! Derivatives of a trajectory with respect to its initial conditions and the parameters of its system.
//!
//! Tangent vectors of the start and the parameters propagate to every node of a run, by the implicit function theorem
//! on the solved step. If u solves `R(u, z0, θ) = 0` and `z1 = Z(u, z0, θ)`, then
//!
//! ```text
//! δu = −(∂R/∂u)⁻¹ (∂R/∂z0 δz0 + ∂R/∂θ δθ)        δz1 = ∂Z/∂u δu + ∂Z/∂z0 δz0 + ∂Z/∂θ δθ
//! ```
//!
//! The system provides the derivatives of R and Z with respect to coordinates and unknowns. Dual numbers provide those
//! with respect to the time and the parameters. The result is the derivative of the discrete step, exact to rounding,
//! not that of the continuous flow. The tangent map of a variational integrator without force is therefore symplectic
//! to rounding. An energy-preserving step also varies in its length.
//!
//! With constraints, tangent vectors satisfy the derivative of the constraints, `A δq + g_t δt + g_θ δθ = 0`, and of
//! their rates. [`Tangent::project`] moves them there. They have 2(n − k) dimensions with k holonomic constraints, and
//! 2n − k with k nonholonomic ones.
//!
//! | file | contents |
//! |---|---|
//! | `variation` | tangent vectors, and their dual numbers |
//! | `steps` | tangent vectors of one step, for each method |
//! | `splitting` | tangent vectors of a splitting step |
//! | `tangent` | tangent vectors along a run, to times, events and across changes |
//! | `curvature` | second derivatives of a step |
//! | `adjoint` | the gradient of an objective, by one backward pass |
//! | `lyapunov` | Lyapunov exponents |

mod adjoint;
pub(crate) mod curvature;
mod lyapunov;
mod splitting;
mod steps;
mod tangent;
mod variation;

pub use adjoint::{Gradient, Objective, gradient};
pub use curvature::velocity_curvature;
pub use lyapunov::Lyapunov;
pub use steps::Differentiable;
pub(crate) use steps::{Sought, check_fallback, not_last};
pub use tangent::Tangent;
pub(crate) use variation::along_parameters;
pub use variation::{Covector, Variation};
pub(crate) use variation::{TOGETHER, Varied, changes_of_energy, more_parameters, not_finite, singular};
