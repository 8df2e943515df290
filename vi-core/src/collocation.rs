//! What collocation asks of a system: the equations `q' = v, p' = L_q + f, p = L_v` at one point.
//!
//! In: a point (t, q, v). Out: both sides of `p = L_v` and of `p' = L_q + f`, and the mass matrix, from one evaluation:
//!
//! ```text
//! momentum   L_v(t, q, v)          mass   M = L_vv(t, q, v)          force   L_q + f          power   dE/dt = f·v − L_t
//! ```
//!
//! and, where a motion is differentiated or Newton's iteration solves a step, how they change with q and v ([`PointDerivatives`]).
//!
//! A system with the clause `time_scale = g;` gives g of the time transformation `dt = g(t, q) dτ` besides ([`TimeScale`]).
//!
//! The velocity that belongs to p follows by `v + M⁻¹ (p − L_v(v))`, at once where L is quadratic in v, else again and again.

use crate::lagrangian::Lagrangian;
use crate::linear::Matrix;
use crate::real::Real;
use nalgebra::SVector;

/// The equations of motion in first order; see the [module](self).
///
/// Systems are small and `Copy`. Cold paths get a copy, so that the hot loop stays in registers.
pub trait Collocation<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// The form of M, by its zero pattern.
    type Mass: Matrix<N, T>;
    /// The form of [`PointDerivatives`], by the zero pattern of all of its matrices.
    type PointMatrix: Matrix<N, T>;
    /// Whether M is a constant of the parameters.
    const CONSTANT_MASS: bool;
    /// Whether `L_v = M v` with constant M, and neither L_q nor f depends on v: then `q'' = M⁻¹ (L_q + f)` is all there is.
    const SEPARABLE: bool;
    /// Whether the system has a time scale g: then it is a [`TimeScale`], and [`Collocation::scaled_point`] gives g.
    const SCALES_TIME: bool = false;

    /// The equations at a point.
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass>;
    /// How the equations change at a point.
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix>;
    /// What the motion gains of energy by time: `f·v − L_t`.
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// All that a step in transformed time takes at a point, from one evaluation; g = 1 for a system without a time scale.
    #[inline(always)]
    fn scaled_point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ScaledPoint<N, T, Self::Mass> {
        ScaledPoint {
            point: self.point(t, q, v),
            energy: self.energy(t, q, v),
            power: self.power(t, q, v),
            g: T::one(),
            g_dq: SVector::zeros(),
            g_dt: T::zero(),
        }
    }
}

/// A system with a time scale, `dt = g(t, q) dτ`: the clause `time_scale = g;` of `lagrangian!`. Its g is that of
/// [`Collocation::scaled_point`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no time scale",
    label = "nothing says how this system scales its time",
    note = "write the clause `time_scale = …;` in its `lagrangian!`, as `time_scale = r^(3/2);`",
    note = "`Gauss` takes steps of a given length in time without it"
)]
pub trait TimeScale<const N: usize, T: Real = f64>: Collocation<N, T> {}

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

/// How the equations of motion change at a point (t, q, v): row i, column j is the derivative of entry i by coordinate or velocity j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointDerivatives<D> {
    /// `∂L_v/∂q`.
    pub momentum_dq: D,
    /// `∂L_v/∂v = L_vv`.
    pub mass: D,
    /// `∂(L_q + f)/∂q`.
    pub force_dq: D,
    /// `∂(L_q + f)/∂v`.
    pub force_dv: D,
}

/// The equations of motion at a point (t, q, v), with what scales the time there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledPoint<const N: usize, T, M> {
    /// The point.
    pub point: Point<N, T, M>,
    /// `v·L_v − L`.
    pub energy: T,
    /// `f·v − L_t`.
    pub power: T,
    /// g, dt/dτ.
    pub g: T,
    /// `∂g/∂q`.
    pub g_dq: SVector<T, N>,
    /// `∂g/∂t`.
    pub g_dt: T,
}
