//! The discrete Lagrangian of a rule, its slot derivatives, discrete forces and powers.

use super::{FirstDerivatives, Indexed, share, sum};
use crate::real::Real;
use crate::rules::Quadrature;
use crate::state::Interval;
use core::ops::Add;
use nalgebra::SVector;

/// The length of an interval.
#[inline]
fn length<const N: usize, T: Real>(interval: &Interval<N, T>) -> T {
    interval.t1 - interval.t0
}

/// The velocity of an interval.
#[inline]
fn velocity<const N: usize, T: Real>(interval: &Interval<N, T>) -> SVector<T, N> {
    let h = length(interval);
    (interval.q1 - interval.q0).map(|entry| entry / h)
}

/// The point at the part c of an interval.
#[inline]
fn within<const N: usize, T: Real>(interval: &Interval<N, T>, c: f64) -> (T, SVector<T, N>) {
    let Interval { t0, q0, t1, q1 } = interval;
    let (before, after) = (T::real(1.0 - c), T::real(c));
    (*t0 * before + *t1 * after, q0 * before + q1 * after)
}

/// The sum over the points of a rule; `of` takes c, h, the velocity and the weighted first derivatives.
#[inline]
fn summed<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature, V: Add<Output = V>>(
    system: &S,
    _rule: R,
    interval: &Interval<N, T>,
    of: impl Fn(f64, T, &SVector<T, N>, &FirstDerivatives<N, T>) -> V,
) -> V {
    let (h, v) = (length(interval), velocity(interval));
    sum::<R, _>(|[c, weight]| {
        let (t, q) = within(interval, c);
        of(c, h, &v, &system.first_derivatives(t, &q, &v).weighted(weight))
    })
}

/// `L_d = h Σ w L`, for [`DiscreteLagrangian::ld`](crate::DiscreteLagrangian::ld).
#[inline]
pub fn ld<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    _rule: R,
    interval: &Interval<N, T>,
) -> T {
    let v = velocity(interval);
    let value = |[c, weight]: [f64; 2]| {
        let (t, q) = within(interval, c);
        system.lagrangian(t, &q, &v) * T::real(weight)
    };
    length(interval) * sum::<R, _>(value)
}

/// `∂L_d/∂t0 = Σ w (v·L_v − L + (1 − c) h L_t)`, for [`DiscreteLagrangian::d1_ld`](crate::DiscreteLagrangian::d1_ld).
#[inline]
pub fn d1_ld<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    rule: R,
    interval: &Interval<N, T>,
) -> T {
    summed(system, rule, interval, |c, h, v, first| first.energy(v) + h * T::real(1.0 - c) * first.dt)
}

/// `∂L_d/∂q0 = Σ w ((1 − c) h L_q − L_v)`, for [`DiscreteLagrangian::d2_ld`](crate::DiscreteLagrangian::d2_ld).
#[inline]
pub fn d2_ld<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    rule: R,
    interval: &Interval<N, T>,
) -> SVector<T, N> {
    summed(system, rule, interval, |c, h, _, first| share(1.0 - c, &first.dq) * h - first.dv)
}

/// `∂L_d/∂t1 = Σ w (L − v·L_v + c h L_t)`, for [`DiscreteLagrangian::d3_ld`](crate::DiscreteLagrangian::d3_ld).
#[inline]
pub fn d3_ld<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    rule: R,
    interval: &Interval<N, T>,
) -> T {
    summed(system, rule, interval, |c, h, v, first| h * T::real(c) * first.dt - first.energy(v))
}

/// `∂L_d/∂q1 = Σ w (c h L_q + L_v)`, for [`DiscreteLagrangian::d4_ld`](crate::DiscreteLagrangian::d4_ld).
#[inline]
pub fn d4_ld<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    rule: R,
    interval: &Interval<N, T>,
) -> SVector<T, N> {
    summed(system, rule, interval, |c, h, _, first| first.dv + share(c, &first.dq) * h)
}

/// `h Σ w part(c) f`.
#[inline]
fn force<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    interval: &Interval<N, T>,
    part: impl Fn(f64) -> f64,
) -> SVector<T, N> {
    if !S::FORCED {
        return SVector::zeros();
    }
    let (h, v) = (length(interval), velocity(interval));
    sum::<R, _>(|[c, weight]| {
        let (t, q) = within(interval, c);
        share(weight * part(c), &system.force(t, &q, &v)) * h
    })
}

/// Discrete force on `δq0`, `h Σ w (1 − c) f`, for [`DiscreteLagrangian::fd_minus`](crate::DiscreteLagrangian::fd_minus).
#[inline]
pub fn fd_minus<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    _rule: R,
    interval: &Interval<N, T>,
) -> SVector<T, N> {
    force::<N, T, S, R>(system, interval, |c| 1.0 - c)
}

/// Discrete force on `δq1`, `h Σ w c f`, for [`DiscreteLagrangian::fd_plus`](crate::DiscreteLagrangian::fd_plus).
#[inline]
pub fn fd_plus<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    _rule: R,
    interval: &Interval<N, T>,
) -> SVector<T, N> {
    force::<N, T, S, R>(system, interval, |c| c)
}

/// Discrete power on `δt0`, `−v·f_d⁻`, for [`DiscreteLagrangian::gd_minus`](crate::DiscreteLagrangian::gd_minus).
#[inline]
pub fn gd_minus<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    rule: R,
    interval: &Interval<N, T>,
) -> T {
    if S::FORCED { -fd_minus(system, rule, interval).dot(&velocity(interval)) } else { T::zero() }
}

/// Discrete power on `δt1`, `−v·f_d⁺`, for [`DiscreteLagrangian::gd_plus`](crate::DiscreteLagrangian::gd_plus).
#[inline]
pub fn gd_plus<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    rule: R,
    interval: &Interval<N, T>,
) -> T {
    if S::FORCED { -fd_plus(system, rule, interval).dot(&velocity(interval)) } else { T::zero() }
}
