//! The discrete system: the discrete Lagrangian of a rule, its slot derivatives, discrete forces and powers.
//!
//! Signs and slots are those of `docs/mathematics.md`. Over one interval `(t0, q0) → (t1, q1)`, `h = t1 − t0`:
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0          momentum equation
//!  D1 L_d + g_d⁻ = E0          energy equation
//!  p1 =  D4 L_d + f_d⁺
//!  E1 = −D3 L_d − g_d⁺
//! ```

use crate::lagrangian::Lagrangian;
use crate::real::Real;
use crate::rules::Own;
use crate::state::Interval;
use nalgebra::SVector;

/// The discrete Lagrangian of the rule R, its slot derivatives, discrete forces and powers.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no discrete Lagrangian of the rule `{R}`",
    note = "add `discretize midpoint;` to `{Self}`; `Own` is the first rule of that clause"
)]
pub trait DiscreteLagrangian<const N: usize, T: Real = f64, R = Own>: Lagrangian<N, T> {
    /// Discrete Lagrangian `L_d(t0, q0, t1, q1)`.
    fn ld(&self, interval: &Interval<N, T>) -> T;
    /// `∂L_d/∂t0`.
    fn d1_ld(&self, interval: &Interval<N, T>) -> T;
    /// `∂L_d/∂q0`.
    fn d2_ld(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// `∂L_d/∂t1`.
    fn d3_ld(&self, interval: &Interval<N, T>) -> T;
    /// `∂L_d/∂q1`.
    fn d4_ld(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// Discrete force on `δq0`.
    fn fd_minus(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// Discrete force on `δq1`.
    fn fd_plus(&self, interval: &Interval<N, T>) -> SVector<T, N>;
    /// Discrete power on `δt0`.
    fn gd_minus(&self, interval: &Interval<N, T>) -> T;
    /// Discrete power on `δt1`.
    fn gd_plus(&self, interval: &Interval<N, T>) -> T;
}
