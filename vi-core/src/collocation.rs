//! What collocation asks of a system: the equations `q' = v, p' = L_q + f, p = L_v` at one point.
//!
//! In: a point (t, q, v). Out: both sides of `p = L_v` and of `p' = L_q + f`, and the mass matrix, from one evaluation:
//!
//! ```text
//! momentum   L_v(t, q, v)          mass   M = L_vv(t, q, v)          force   L_q + f          power   dE/dt = f·v − L_t
//! ```
//!
//! The velocity that belongs to p follows by `v + M⁻¹ (p − L_v(v))`, at once where L is quadratic in v, else again and again.

use crate::lagrangian::Lagrangian;
use crate::linear::Matrix;
use crate::real::Real;
use nalgebra::SVector;

/// The equations of motion in first order; see the [module](self).
pub trait Collocation<const N: usize, T: Real = f64>: Lagrangian<N, T> {
    /// The form of M, by its zero pattern.
    type Mass: Matrix<N, T>;
    /// Whether M is a constant of the parameters.
    const CONSTANT_MASS: bool;
    /// Whether `L_v = M v` with constant M, and neither L_q nor f depends on v: then `q'' = M⁻¹ (L_q + f)` is all there is.
    const SEPARABLE: bool;

    /// The equations at a point.
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass>;
    /// What the motion gains of energy by time: `f·v − L_t`.
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
}

/// The equations of motion at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<const N: usize, T, M> {
    /// `L_v`.
    pub momentum: SVector<T, N>,
    /// `L_q + f`.
    pub force: SVector<T, N>,
    /// `M = L_vv`.
    pub mass: M,
}
