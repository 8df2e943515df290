//! The equations of motion at one point, in the form that collocation needs: `q' = v, p' = L_q + f, p = L_v`.
//!
//! One evaluation at a point (t, q, v) gives both sides of `p = L_v` and of `p' = L_q + f`, and the mass matrix:
//!
//! ```text
//! momentum   L_v(t, q, v)          mass   M = L_vv(t, q, v)          force   L_q + f          power   dE/dt = f·v − L_t
//! ```
//!
//! Sensitivities and Newton iteration also need the derivatives with respect to q and v ([`PointDerivatives`]).
//!
//! A system with the clause `time_scale = g;` also gives g of the time transformation `dt = g(t, q) dτ`
//! ([`TimeScale`]).
//!
//! The velocity of given momenta follows from `v + M⁻¹ (p − L_v(v))`. One correction is exact if L is quadratic in v;
//! otherwise iterate.

use crate::lagrangian::Lagrangian;
use crate::linear::Matrix;
use crate::real::Real;
use nalgebra::SVector;

/// The equations of motion in first order; see the [module](self).
///
/// Systems are small and `Copy`. Cold paths get a copy, so that the hot loop stays in registers.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no equations of motion without constraints",
    note = "`GaussLobatto` integrates a system with constraints; `Gauss`, `FixedStep` and the other methods would ignore them"
)]
pub trait Collocation<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// Matrix type of M, with its zero pattern.
    type Mass: Matrix<N, T>;
    /// Matrix type of [`PointDerivatives`], with the joint zero pattern of all its matrices.
    type PointMatrix: Matrix<N, T>;
    /// Whether M depends on the parameters only.
    const CONSTANT_MASS: bool;
    /// Whether `L_v = M v` with constant M, and neither L_q nor f depends on v. The system is then `q'' = M⁻¹ (L_q +
    /// f)`.
    const SEPARABLE: bool;
    /// Whether the system has a time scale g. It is then a [`TimeScale`], and [`Collocation::scaled_point`] returns g.
    const SCALES_TIME: bool = false;

    /// Evaluates the equations at a point.
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass>;
    /// The same without M.
    #[inline(always)]
    fn sides(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Sides<N, T> {
        self.point(t, q, v).sides()
    }
    /// Evaluates their derivatives at a point.
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix>;
    /// Rate of change of the energy: `f·v − L_t`.
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// Evaluates everything that a step in transformed time needs at a point. Without a time scale, g = 1.
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

/// A system with a time scale, `dt = g(t, q) dτ`, from the clause `time_scale = g;` of `lagrangian!`.
/// [`Collocation::scaled_point`] returns g.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no time scale",
    label = "this system declares no time scale",
    note = "write the clause `time_scale = …;` in its `lagrangian!`, as `time_scale = r^(3/2);`",
    note = "`Gauss` takes steps of a given length in time without it"
)]
pub trait TimeScale<const N: usize, T: Real = f64>: Collocation<N, T> {}

/// A system with [`Collocation::SEPARABLE`] equations, whose motion splits into kicks and drifts
/// ([`Splitting`](crate::Splitting)). Generated systems with this form implement it.
#[diagnostic::on_unimplemented(
    message = "the motion of `{Self}` does not split into kicks and drifts",
    label = "this system has no constant mass matrix, or forces that depend on velocities",
    note = "`Splitting` takes `L = v·M v/2 − V(t, q)` with a constant M, and forces of time and coordinates alone",
    note = "`Gauss` integrates every system without constraints"
)]
pub trait Separable<const N: usize, T: Real = f64>: Collocation<N, T> {}

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

/// Both sides of the equations of motion at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides<const N: usize, T> {
    /// `L_v`.
    pub momentum: SVector<T, N>,
    /// `L_q + f`.
    pub force: SVector<T, N>,
}

impl<const N: usize, T, M> Point<N, T, M> {
    /// The point without its mass matrix.
    #[inline(always)]
    pub fn sides(self) -> Sides<N, T> {
        Sides { momentum: self.momentum, force: self.force }
    }
}

/// Derivatives of the equations of motion at a point (t, q, v). Row i, column j is the derivative of entry i with
/// respect to coordinate or velocity j.
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

/// The equations of motion and the time scale at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledPoint<const N: usize, T, M> {
    /// The point.
    pub point: Point<N, T, M>,
    /// `v·L_v − L`.
    pub energy: T,
    /// `f·v − L_t`.
    pub power: T,
    /// g = dt/dτ.
    pub g: T,
    /// `∂g/∂q`.
    pub g_dq: SVector<T, N>,
    /// `∂g/∂t`.
    pub g_dt: T,
}
