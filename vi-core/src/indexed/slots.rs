//! The discrete Lagrangian of the midpoint rule, its slot derivatives, discrete forces and powers.

use super::{FirstDerivatives, Indexed};
use crate::real::Real;
use crate::state::Interval;
use nalgebra::SVector;

/// The length of an interval, and its midpoint (t, q, v).
#[inline]
fn midpoint<const N: usize, T: Real>(interval: &Interval<N, T>) -> (T, (T, SVector<T, N>, SVector<T, N>)) {
    let Interval { t0, q0, t1, q1 } = interval;
    let (h, half) = (*t1 - *t0, T::real(0.5));
    (h, ((*t0 + *t1) * half, (q0 + q1) * half, (q1 - q0).map(|entry| entry / h)))
}

/// Half the length of an interval, its velocity, and the first derivatives at its midpoint.
#[inline]
fn evaluated<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    interval: &Interval<N, T>,
) -> (T, SVector<T, N>, FirstDerivatives<N, T>) {
    let (h, (t, q, v)) = midpoint(interval);
    (h * T::real(0.5), v, system.first_derivatives(t, &q, &v))
}

/// `L_d = h L`, for [`DiscreteLagrangian::ld`](crate::DiscreteLagrangian::ld).
#[inline]
pub fn ld<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> T {
    let (h, (t, q, v)) = midpoint(interval);
    h * system.lagrangian(t, &q, &v)
}

/// `∂L_d/∂t0 = v·L_v − L + (h/2) L_t`, for [`DiscreteLagrangian::d1_ld`](crate::DiscreteLagrangian::d1_ld).
#[inline]
pub fn d1_ld<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> T {
    let (half, v, first) = evaluated(system, interval);
    first.energy(&v) + half * first.dt
}

/// `∂L_d/∂q0 = (h/2) L_q − L_v`, for [`DiscreteLagrangian::d2_ld`](crate::DiscreteLagrangian::d2_ld).
#[inline]
pub fn d2_ld<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> SVector<T, N> {
    let (half, _, first) = evaluated(system, interval);
    first.dq * half - first.dv
}

/// `∂L_d/∂t1 = L − v·L_v + (h/2) L_t`, for [`DiscreteLagrangian::d3_ld`](crate::DiscreteLagrangian::d3_ld).
#[inline]
pub fn d3_ld<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> T {
    let (half, v, first) = evaluated(system, interval);
    half * first.dt - first.energy(&v)
}

/// `∂L_d/∂q1 = (h/2) L_q + L_v`, for [`DiscreteLagrangian::d4_ld`](crate::DiscreteLagrangian::d4_ld).
#[inline]
pub fn d4_ld<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> SVector<T, N> {
    let (half, _, first) = evaluated(system, interval);
    first.dv + first.dq * half
}

/// Discrete force on `δq0`, `(h/2) f`, for [`DiscreteLagrangian::fd_minus`](crate::DiscreteLagrangian::fd_minus).
#[inline]
pub fn fd_minus<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> SVector<T, N> {
    let (h, (t, q, v)) = midpoint(interval);
    if S::FORCED { system.force(t, &q, &v) * (h * T::real(0.5)) } else { SVector::zeros() }
}

/// Discrete force on `δq1`, `(h/2) f`, for [`DiscreteLagrangian::fd_plus`](crate::DiscreteLagrangian::fd_plus).
#[inline]
pub fn fd_plus<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> SVector<T, N> {
    fd_minus(system, interval)
}

/// Discrete power on `δt0`, `−(h/2) f·v`, for [`DiscreteLagrangian::gd_minus`](crate::DiscreteLagrangian::gd_minus).
#[inline]
pub fn gd_minus<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> T {
    let (_, (_, _, v)) = midpoint(interval);
    if S::FORCED { -fd_minus(system, interval).dot(&v) } else { T::zero() }
}

/// Discrete power on `δt1`, `−(h/2) f·v`, for [`DiscreteLagrangian::gd_plus`](crate::DiscreteLagrangian::gd_plus).
#[inline]
pub fn gd_plus<const N: usize, T: Real, S: Indexed<N, T>>(system: &S, interval: &Interval<N, T>) -> T {
    gd_minus(system, interval)
}
