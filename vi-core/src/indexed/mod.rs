//! Large systems: all functions of a system from a few primitives.
//!
//! The code of a system with many coordinates is emitted as loops, and only for the primitives of [`Indexed`]: L, its
//! first derivatives, and weighted sums of its second derivatives. The functions of this module derive everything else
//! from them. Each returns what the trait method of the same name returns; the macro `system!` implements these traits.
//!
//! A derivative along a direction, as `d/dt(L_q)`, is one evaluation of the first derivatives over dual numbers. Fixed
//! steps are those of a [`Quadrature`], energy-preserving ones those of the midpoint rule.

#[cfg(feature = "alloc")]
mod constraints;
mod slots;
mod step;
mod system;

#[cfg(feature = "alloc")]
pub use constraints::{
    IndexedConstraints, constraint_gradients, constraint_rate_derivatives, constraints, reaction_derivatives,
};
pub use slots::{d1_ld, d2_ld, d3_ld, d4_ld, fd_minus, fd_plus, gd_minus, gd_plus, ld};
pub use step::{
    discrete_energy, extended_derivatives, extended_residual, extended_system, jacobian, momentum_derivatives,
    momentum_equation, momentum_residual, step_density,
};

#[doc(hidden)]
pub use crate::indexed_system as system;

use crate::error::StepError;
use crate::lagrangian::{Flow, Lagrangian};
use crate::legendre;
use crate::motion::{Point, PointDerivatives, ScaledPoint, Sides};
use crate::real::dual::{along, slopes};
use crate::real::{Dual, Real, Rounded};
use crate::rules::Quadrature;
use core::ops::Add;
use nalgebra::{SMatrix, SVector};

/// First derivatives of L, and the force, at a point (t, q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstDerivatives<const N: usize, T> {
    /// L.
    pub value: T,
    /// `L_t`.
    pub dt: T,
    /// `L_q`.
    pub dq: SVector<T, N>,
    /// `L_v`.
    pub dv: SVector<T, N>,
    /// f; zero if there is none.
    pub force: SVector<T, N>,
}

/// A large system: L with its derivatives, and f, computed by loops.
///
/// In the arguments `rows` and `columns` the first number belongs to q, the second to v.
pub trait Indexed<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// The same system over dual numbers.
    type Dual: Indexed<N, Dual<T>>;

    /// Converts the system to dual numbers; the parameters are constants.
    fn dual(&self) -> Self::Dual;
    /// L, its first derivatives and f at a point, by one backward pass.
    fn first_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> FirstDerivatives<N, T>;
    /// L, its first derivatives and f, and the same sums with the absolute value of each term. The rounding error of a
    /// first derivative is of the order of an ulp of the latter.
    fn measured_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> [FirstDerivatives<N, T>; 2];
    /// Second derivatives of L. For `rows = [r_q, r_v]` and `columns = [c_q, c_v]`, row i, column j is
    /// `(r_v ∂/∂v_i + r_q ∂/∂q_i) (c_v ∂/∂v_j + c_q ∂/∂q_j) L`.
    fn second_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        rows: [T; 2],
        columns: [T; 2],
    ) -> SMatrix<T, N, N>;
    /// Adds derivatives of the force to a matrix. For `columns = [c_q, c_v]`, row i, column j increases by
    /// `weight (c_v ∂/∂v_j + c_q ∂/∂q_j) f_i`.
    #[allow(clippy::too_many_arguments)] // a point, and the weights of rows and columns
    fn add_force_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        weight: T,
        columns: [T; 2],
        matrix: &mut SMatrix<T, N, N>,
    );
    /// The time scale g at a point, ∂g/∂q and ∂g/∂t; 1 without a time scale.
    fn time_scale(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> (T, SVector<T, N>, T) {
        (T::one(), SVector::zeros(), T::zero())
    }
}

impl<const N: usize, T: Real> FirstDerivatives<N, T> {
    /// These derivatives times a weight. A weight of 1, that of a rule of one point, changes no bit.
    #[inline]
    fn weighted(self, weight: f64) -> Self {
        if weight - 1.0 == 0.0 {
            return self;
        }
        let weight = T::real(weight);
        Self {
            value: self.value * weight,
            dt: self.dt * weight,
            dq: self.dq * weight,
            dv: self.dv * weight,
            force: self.force * weight,
        }
    }

    /// `L_q + f`. It skips an absent force, which would add a rounding to the bounds of running error analysis.
    #[inline]
    fn total_force<S: Lagrangian<N, T>>(&self) -> SVector<T, N> {
        if S::FORCED { self.dq + self.force } else { self.dq }
    }

    /// `f·v − L_t`.
    #[inline]
    fn power<S: Lagrangian<N, T>>(&self, v: &SVector<T, N>) -> T {
        let work = if S::FORCED { self.force.dot(v) } else { T::zero() };
        if S::AUTONOMOUS { work } else { work - self.dt }
    }

    /// `v·L_v − L`.
    #[inline]
    fn energy(&self, v: &SVector<T, N>) -> T {
        v.dot(&self.dv) - self.value
    }
}

/// The sum over the points of a rule; `of` takes c and w of a point.
#[inline]
fn sum<R: Quadrature, V: Add<Output = V>>(mut of: impl FnMut([f64; 2]) -> V) -> V {
    let mut sum = of(R::POINTS[0]);
    for point in &R::POINTS[1..] {
        sum = sum + of(*point);
    }
    sum
}

/// A vector times `part`. With a part of zero the vector may be NaN.
#[inline]
fn share<const N: usize, T: Real>(part: f64, of: &SVector<T, N>) -> SVector<T, N> {
    if part == 0.0 { SVector::zeros() } else { of * T::real(part) }
}

/// The first derivatives at `(t, q, v)`, and their derivatives along the direction `(t', q', v')`.
#[inline]
fn along_direction<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    (dt, dq, dv): (T, &SVector<T, N>, &SVector<T, N>),
) -> [FirstDerivatives<N, T>; 2] {
    let found = system.dual().first_derivatives(Dual { value: t, slope: dt }, &along(q, dq), &along(v, dv));
    let values = |vector: &SVector<Dual<T>, N>| vector.map(|entry| entry.value);
    [
        FirstDerivatives {
            value: found.value.value,
            dt: found.dt.value,
            dq: values(&found.dq),
            dv: values(&found.dv),
            force: values(&found.force),
        },
        FirstDerivatives {
            value: found.value.slope,
            dt: found.dt.slope,
            dq: slopes(&found.dq),
            dv: slopes(&found.dv),
            force: slopes(&found.force),
        },
    ]
}

/// The mass matrix `L_vv`.
#[inline]
pub fn mass<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> SMatrix<T, N, N> {
    let of_v = [T::zero(), T::one()];
    system.second_derivatives(t, q, v, of_v, of_v)
}

/// Energy `v·L_v − L`, for [`Lagrangian::energy`].
#[inline]
pub fn energy<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
    system.first_derivatives(t, q, v).energy(v)
}

/// Acceleration `a = (L_vv)⁻¹ (L_q + f − L_vt − L_vq v)`, for [`Lagrangian::acceleration`].
///
/// # Errors
/// As [`Lagrangian::acceleration`].
#[inline]
pub fn acceleration<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    legendre::acceleration(t, &mass(system, t, q, v), &applied(system, t, q, v))
}

/// `L_q + f − L_vt − L_vq v`, for [`Motion::applied`](crate::motion::Motion::applied).
#[inline]
pub fn applied<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> SVector<T, N> {
    let [first, rates] = along_direction(system, (t, q, v), (T::one(), v, &SVector::zeros()));
    first.total_force::<S>() - rates.dv
}

/// The flow at `(t, q, p)` if L is quadratic in the velocities, for [`Lagrangian::flow`].
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix is singular, [`StepError::NonFinite`] if it or the momentum at rest is not
/// finite.
#[inline]
pub fn flow<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    p: &SVector<T, N>,
) -> Result<Flow<N, T>, StepError> {
    let rest = SVector::zeros();
    let at_rest = system.first_derivatives(t, q, &rest);
    let v = legendre::velocity_by_mass(t, &mass(system, t, q, &rest), &(p - at_rest.dv))?;
    Ok(flow_of_velocity(system, t, q, v))
}

/// The flow at `(t, q, p)` of any system, with the velocity by Newton iteration, for [`Lagrangian::flow`]. `rounded` is
/// the system over numbers with rounding-error bounds.
///
/// # Errors
/// As [`Lagrangian::flow`]; [`StepError::Ambiguous`] if another velocity has the same momenta.
#[inline]
pub fn flow_by_iteration<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    rounded: &impl Lagrangian<N, Rounded>,
    t: T,
    q: &SVector<T, N>,
    p: &SVector<T, N>,
) -> Result<Flow<N, T>, StepError> {
    let v = legendre::velocity(system, rounded, |v: &SVector<T, N>| mass(system, t, q, v), (t, q, p))?;
    Ok(flow_of_velocity(system, t, q, v))
}

/// The rates of change at the velocity of the momenta.
#[inline]
fn flow_of_velocity<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: SVector<T, N>,
) -> Flow<N, T> {
    let first = system.first_derivatives(t, q, &v);
    Flow { v, force: first.total_force::<S>(), power: first.power::<S>(&v) }
}

/// The equations of motion at a point with this mass matrix, for
/// [`Motion::point`](crate::motion::Motion::point).
#[inline]
pub fn point<const N: usize, T: Real, S: Indexed<N, T>, M>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
    mass: M,
) -> Point<N, T, M> {
    let Sides { momentum, force } = sides(system, t, q, v);
    Point { momentum, force, mass }
}

/// The equations of motion at a point with the energy, its rate of change and a time scale, for
/// [`Motion::scaled_point`](crate::motion::Motion::scaled_point).
#[inline]
pub fn scaled_point<const N: usize, T: Real, S: Indexed<N, T>, M>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
    mass: M,
) -> ScaledPoint<N, T, M> {
    let first = system.first_derivatives(t, q, v);
    let (g, g_dq, g_dt) = system.time_scale(t, q, v);
    ScaledPoint {
        point: Point { momentum: first.dv, force: first.total_force::<S>(), mass },
        energy: first.energy(v),
        power: first.power::<S>(v),
        g,
        g_dq,
        g_dt,
    }
}

/// The equations without the mass matrix, for [`Motion::sides`](crate::motion::Motion::sides).
#[inline]
pub fn sides<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> Sides<N, T> {
    let first = system.first_derivatives(t, q, v);
    Sides { momentum: first.dv, force: first.total_force::<S>() }
}

/// Derivatives of the equations of motion at a point, for
/// [`Motion::point_derivatives`](crate::motion::Motion::point_derivatives).
#[inline]
pub fn point_derivatives<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> PointDerivatives<SMatrix<T, N, N>> {
    let (of_q, of_v) = ([T::one(), T::zero()], [T::zero(), T::one()]);
    let momentum_dq = system.second_derivatives(t, q, v, of_v, of_q);
    let mut force_dq = system.second_derivatives(t, q, v, of_q, of_q);
    let mut force_dv = momentum_dq.transpose();
    if S::FORCED {
        system.add_force_derivatives(t, q, v, T::one(), of_q, &mut force_dq);
        system.add_force_derivatives(t, q, v, T::one(), of_v, &mut force_dv);
    }
    PointDerivatives { momentum_dq, mass: mass(system, t, q, v), force_dq, force_dv }
}

/// Rate of change of the energy, `f·v − L_t`, for
/// [`Motion::power`](crate::motion::Motion::power).
#[inline]
pub fn power<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
    if S::AUTONOMOUS && !S::FORCED {
        return T::zero();
    }
    system.first_derivatives(t, q, v).power::<S>(v)
}

/// A derivative times its weight; zero for a weight of zero, even if the derivative is infinite.
#[doc(hidden)]
#[inline(always)]
pub fn weighted<T: Real>(derivative: T, weight: T) -> T {
    (derivative * weight).zero_where(weight, u8::MAX)
}

/// Adds a row to another one.
#[doc(hidden)]
#[inline(always)]
pub fn add_row<const N: usize, T: Real>(to: &mut [T; N], row: &[T; N]) {
    for (to, number) in to.iter_mut().zip(row) {
        *to += *number;
    }
}

/// Adds `factor` times a row to another one.
#[doc(hidden)]
#[inline(always)]
pub fn add<const N: usize, T: Real>(factor: T, to: &mut [T; N], row: &[T; N]) {
    for (to, number) in to.iter_mut().zip(row) {
        *to += factor * *number;
    }
}

/// Adds `factor` times a row to a row of a matrix.
#[doc(hidden)]
#[inline(always)]
pub fn add_to_row<const N: usize, T: Real>(matrix: &mut SMatrix<T, N, N>, row: usize, factor: T, numbers: &[T; N]) {
    for (to, number) in matrix.row_mut(row).iter_mut().zip(numbers) {
        *to += factor * *number;
    }
}
