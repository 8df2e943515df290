//! The momentum and energy equations of one step by the midpoint rule, and their derivatives.
//!
//! Everything is evaluated at the midpoint `(t, q, v)` of the step. With `D = d/dt` along `(1, v, 0)`,
//!
//! ```text
//! r      = L_v − (h/2)(L_q + f) − p0                    c = e − v·r = v·p0 − E0 − L + (h/2)(L_t + v·L_q)
//! ∂r/∂v  = L_vv + (h/2)(L_vq − L_qv − f_v) − (h²/4)(L_qq + f_q)
//! ∂r/∂h  = D L_v/2 − (L_q + f)/2 − (h/4) D(L_q + f)     ∂c/∂q0 = −L_q + (h/2) D L_q
//! (∂e/∂v − v·A)/h = (D L_v − (L_q + f) + (h/2) D L_q)/2     (∂e/∂h − v·∂r/∂h)/h = (D L_t + v·D L_q)/4
//! ```

use super::{FirstDerivatives, Indexed, along_direction};
use crate::error::StepError;
use crate::legendre;
use crate::node::Node;
use crate::real::Real;
use crate::stepping::{
    ExtendedDerivatives, ExtendedResidual, ExtendedSystem, Increment, MomentumDerivatives, MomentumEquation,
    MomentumResidual,
};
use nalgebra::{SMatrix, SVector};

/// The residual r of the momentum row. Small terms are summed first.
#[inline]
fn residual<const N: usize, T: Real, S: Indexed<N, T>>(
    node: &Node<N, T>,
    h: T,
    first: &FirstDerivatives<N, T>,
) -> SVector<T, N> {
    first.dv - node.p - (node.p_low + first.total_force::<S>() * (h * T::real(0.5)))
}

/// Sums of the absolute values of the terms of r.
#[inline]
fn scale<const N: usize, T: Real, S: Indexed<N, T>>(
    node: &Node<N, T>,
    h: T,
    magnitudes: &FirstDerivatives<N, T>,
) -> SVector<T, N> {
    node.p.map(T::abs) + magnitudes.dv + magnitudes.total_force::<S>() * (h.abs() * T::real(0.5))
}

/// The combined residual c of the energy row. Small terms are summed first.
#[inline]
fn energy_residual<const N: usize, T: Real, S: Indexed<N, T>>(
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
    first: &FirstDerivatives<N, T>,
) -> T {
    let small = v.dot(&node.p_low) - node.energy_low + h * T::real(0.5) * rate::<N, T, S>(v, first);
    v.dot(&node.p) - (node.energy + first.value) + small
}

/// `L_t + v·L_q`.
#[inline]
fn rate<const N: usize, T: Real, S: Indexed<N, T>>(v: &SVector<T, N>, first: &FirstDerivatives<N, T>) -> T {
    let along_q = v.dot(&first.dq);
    if S::AUTONOMOUS { along_q } else { first.dt + along_q }
}

/// `A = ∂r/∂v`.
#[inline]
fn jacobian<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    h: T,
) -> SMatrix<T, N, N> {
    let (half, one) = (h * T::real(0.5), T::one());
    let mut matrix = system.second_derivatives(t, q, v, [-half, one], [half, one]);
    if S::FORCED {
        system.add_force_derivatives(t, q, v, -half, [half, one], &mut matrix);
    }
    matrix
}

/// Derivatives of the equations with respect to h, and of the energy row.
struct AlongStep<const N: usize, T> {
    residual_dh: SVector<T, N>,
    energy_dv: SVector<T, N>,
    energy_dh: T,
}

impl<const N: usize, T: Real> AlongStep<N, T> {
    /// From the first derivatives and `rates`, their derivatives along `(1, v, 0)`.
    #[inline]
    fn new<S: Indexed<N, T>>(
        h: T,
        v: &SVector<T, N>,
        first: &FirstDerivatives<N, T>,
        rates: &FirstDerivatives<N, T>,
    ) -> Self {
        let (half, quarter) = (T::real(0.5), h * T::real(0.25));
        let bare = (rates.dv - first.total_force::<S>()) * half;
        Self {
            residual_dh: bare - rates.total_force::<S>() * quarter,
            energy_dv: bare + rates.dq * quarter,
            energy_dh: rate::<N, T, S>(v, rates) * T::real(0.25),
        }
    }
}

/// The momentum equation at a trial velocity, for
/// [`FixedStepping::momentum_equation`](crate::stepping::FixedStepping::momentum_equation).
#[inline]
pub fn momentum_equation<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> MomentumEquation<N, T, SMatrix<T, N, N>> {
    let (t, q) = node.midpoint(h, v);
    let first = system.first_derivatives(t, &q, v);
    MomentumEquation { residual: residual::<N, T, S>(node, h, &first), jacobian: jacobian(system, (t, &q, v), h) }
}

/// The residual of the momentum equation with its scale, and `p1 − p0`, for
/// [`FixedStepping::momentum_residual`](crate::stepping::FixedStepping::momentum_residual).
#[inline]
pub fn momentum_residual<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> MomentumResidual<N, T> {
    let (t, q) = node.midpoint(h, v);
    let [first, magnitudes] = system.measured_derivatives(t, &q, v);
    MomentumResidual {
        residual: residual::<N, T, S>(node, h, &first),
        scale: scale::<N, T, S>(node, h, &magnitudes),
        increment: first.total_force::<S>() * h,
    }
}

/// `h ∂f/∂q0` and `h ∂f/∂v`, f at the midpoint; `None` without a force.
#[inline]
fn force_derivatives<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    h: T,
) -> Option<[SMatrix<T, N, N>; 2]> {
    if !S::FORCED {
        return None;
    }
    let (mut of_q, mut of_v) = (SMatrix::zeros(), SMatrix::zeros());
    system.add_force_derivatives(t, q, v, h, [T::one(), T::zero()], &mut of_q);
    system.add_force_derivatives(t, q, v, h, [h * T::real(0.5), T::one()], &mut of_v);
    Some([of_q, of_v])
}

/// Derivatives of r and of `p1 − p0`; `force` is that of [`force_derivatives`].
#[inline]
fn derivatives<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    h: T,
    force: Option<&[SMatrix<T, N, N>; 2]>,
) -> MomentumDerivatives<SMatrix<T, N, N>, SMatrix<T, N, N>> {
    let (half, zero, one) = (h * T::real(0.5), T::zero(), T::one());
    let (of_residual, of_increment) = ([-half, one], [h, zero]);
    let (by_q, by_v) = ([one, zero], [half, one]);
    let mut found = MomentumDerivatives {
        residual_dq: system.second_derivatives(t, q, v, of_residual, by_q),
        residual_dv: system.second_derivatives(t, q, v, of_residual, by_v),
        increment_dq: system.second_derivatives(t, q, v, of_increment, by_q),
        increment_dv: system.second_derivatives(t, q, v, of_increment, by_v),
    };
    if let Some([force_dq, force_dv]) = force {
        found.residual_dq.zip_apply(force_dq, |entry, of_force| *entry -= of_force * T::real(0.5));
        found.residual_dv.zip_apply(force_dv, |entry, of_force| *entry -= of_force * T::real(0.5));
        found.increment_dq += force_dq;
        found.increment_dv += force_dv;
    }
    found
}

/// Derivatives of the residual and of `p1 − p0` with respect to q0 and v, for
/// [`FixedStepping::momentum_derivatives`](crate::stepping::FixedStepping::momentum_derivatives).
#[inline]
pub fn momentum_derivatives<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> MomentumDerivatives<SMatrix<T, N, N>, SMatrix<T, N, N>> {
    let (t, q) = node.midpoint(h, v);
    let force = force_derivatives(system, (t, &q, v), h);
    derivatives(system, (t, &q, v), h, force.as_ref())
}

/// Discrete energy `E1 = v·L_v − L + (h/2)(f·v − L_t)` at the end of a step, for
/// [`FixedStepping::discrete_energy`](crate::stepping::FixedStepping::discrete_energy).
#[inline]
pub fn discrete_energy<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> T {
    let (t, q) = node.midpoint(h, v);
    let first = system.first_derivatives(t, &q, v);
    if S::AUTONOMOUS && !S::FORCED {
        return first.energy(v);
    }
    first.energy(v) + h * T::real(0.5) * first.power::<S>(v)
}

/// Step density `D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)`, for
/// [`EnergyStepping::step_density`](crate::stepping::EnergyStepping::step_density).
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix is singular, [`StepError::NonFinite`] if a derivative of L or f is not
/// finite.
#[inline]
pub fn step_density<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> Result<T, StepError> {
    let a = system.acceleration(t, q, v)?;
    let [first, rates] = along_direction(system, (t, q, v), (T::one(), v, &a));
    legendre::step_density(t, a.dot(&first.total_force::<S>()) - rate::<N, T, S>(v, &rates))
}

/// The momentum and energy equations at a trial `(v, h)`, for
/// [`EnergyStepping::extended_system`](crate::stepping::EnergyStepping::extended_system).
#[inline]
pub fn extended_system<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> ExtendedSystem<N, T, SMatrix<T, N, N>> {
    let (t, q) = node.midpoint(h, v);
    let [first, rates] = along_direction(system, (t, &q, v), (T::one(), v, &SVector::zeros()));
    let AlongStep { residual_dh, energy_dv, energy_dh } = AlongStep::new::<S>(h, v, &first, &rates);
    ExtendedSystem {
        momentum: MomentumEquation {
            residual: residual::<N, T, S>(node, h, &first),
            jacobian: jacobian(system, (t, &q, v), h),
        },
        residual_dh,
        energy_residual: energy_residual::<N, T, S>(node, h, v, &first),
        energy_dv,
        energy_dh,
    }
}

/// Both residuals with their scales, `p1 − p0` and `E1 − E0`, for
/// [`EnergyStepping::extended_residual`](crate::stepping::EnergyStepping::extended_residual).
#[inline]
pub fn extended_residual<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> ExtendedResidual<N, T> {
    let (t, q) = node.midpoint(h, v);
    let [first, magnitudes] = system.measured_derivatives(t, &q, v);
    let speeds = v.map(T::abs);
    let of_rate = h.abs() * T::real(0.5) * rate::<N, T, S>(&speeds, &magnitudes);
    ExtendedResidual {
        residual: residual::<N, T, S>(node, h, &first),
        scale: scale::<N, T, S>(node, h, &magnitudes),
        energy_residual: energy_residual::<N, T, S>(node, h, v, &first),
        energy_scale: node.energy.abs() + speeds.dot(&node.p.map(T::abs)) + magnitudes.value + of_rate,
        increment: Increment { momentum: first.total_force::<S>() * h, energy: h * first.power::<S>(v) },
    }
}

/// Derivatives of both residuals, of `p1 − p0` and of `E1 − E0` with respect to q0, v and h, for
/// [`EnergyStepping::extended_derivatives`](crate::stepping::EnergyStepping::extended_derivatives).
#[inline]
pub fn extended_derivatives<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> ExtendedDerivatives<N, T, SMatrix<T, N, N>, SMatrix<T, N, N>> {
    let (t, q) = node.midpoint(h, v);
    let (half, zeros) = (h * T::real(0.5), SVector::zeros());
    let [first, rates] = along_direction(system, (t, &q, v), (T::one(), v, &zeros));
    let force = force_derivatives(system, (t, &q, v), h);
    // E1 − E0 = h (f·v − L_t).
    let (mut energy_increment_dq, mut energy_increment_dv) = (zeros, zeros);
    if let Some([force_dq, force_dv]) = &force {
        energy_increment_dq = force_dq.tr_mul(v);
        energy_increment_dv = force_dv.tr_mul(v) + first.force * h;
    }
    if !S::AUTONOMOUS {
        let [_, of_t] = along_direction(system, (t, &q, v), (T::one(), &zeros, &zeros));
        energy_increment_dq -= of_t.dq * h;
        energy_increment_dv -= (of_t.dv + of_t.dq * half) * h;
    }
    let AlongStep { residual_dh, energy_dv, energy_dh } = AlongStep::new::<S>(h, v, &first, &rates);
    ExtendedDerivatives {
        momentum: derivatives(system, (t, &q, v), h, force.as_ref()),
        residual_dh,
        increment_dh: first.total_force::<S>() + rates.total_force::<S>() * half,
        energy_dq: rates.dq * half - first.dq,
        energy_dv,
        energy_dh,
        energy_increment_dq,
        energy_increment_dv,
        energy_increment_dh: first.power::<S>(v) + half * rates.power::<S>(v),
    }
}
