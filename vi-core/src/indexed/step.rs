//! The momentum equation of one step by a rule, the energy equation of one by the midpoint rule, and their derivatives.
//!
//! With sums over the points of the rule, at the part c of the step with the weight w, `b = 1 − c`, and `D = d/dt` along
//! `(1, v, 0)`,
//!
//! ```text
//! r     = Σ w (L_v − b h (L_q + f)) − p0                p1 − p0 = h Σ w (L_q + f)
//! ∂r/∂v = Σ w (L_vv + c h L_vq − b h (L_qv + f_v) − b c h² (L_qq + f_q))
//! E1    = Σ w (v·L_v − L + c h (f·v − L_t))
//! ```
//!
//! At the midpoint of the step,
//!
//! ```text
//! c      = e − v·r = v·p0 − E0 − L + (h/2)(L_t + v·L_q)           ∂c/∂q0 = −L_q + (h/2) D L_q
//! ∂r/∂h  = D L_v/2 − (L_q + f)/2 − (h/4) D(L_q + f)
//! (∂e/∂v − v·A)/h = (D L_v − (L_q + f) + (h/2) D L_q)/2     (∂e/∂h − v·∂r/∂h)/h = (D L_t + v·D L_q)/4
//! ```

use super::{FirstDerivatives, Indexed, along_direction, share, sum};
use crate::error::StepError;
use crate::legendre;
use crate::node::Node;
use crate::real::Real;
use crate::rules::{Midpoint, Quadrature};
use crate::stepping::{
    ExtendedDerivatives, ExtendedResidual, ExtendedSystem, Increment, MomentumDerivatives, MomentumEquation,
    MomentumResidual,
};
use core::ops::Add;
use nalgebra::{SMatrix, SVector};

/// Sums over the points of a rule.
struct Sums<const N: usize, T> {
    /// `Σ w L_v`.
    momentum: SVector<T, N>,
    /// `Σ w (1 − c) (L_q + f)`.
    before: SVector<T, N>,
    /// `Σ w (L_q + f)`.
    force: SVector<T, N>,
}

impl<const N: usize, T: Real> Add for Sums<N, T> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            momentum: self.momentum + other.momentum,
            before: self.before + other.before,
            force: self.force + other.force,
        }
    }
}

impl<const N: usize, T: Real> Sums<N, T> {
    /// The share of a point, from its weighted derivatives.
    #[inline]
    fn of<S: Indexed<N, T>>(c: f64, first: &FirstDerivatives<N, T>) -> Self {
        let force = first.total_force::<S>();
        Self { momentum: first.dv, before: share(1.0 - c, &force), force }
    }

    /// The residual r of the momentum row. Small terms are summed first.
    #[inline]
    fn residual(&self, node: &Node<N, T>, h: T) -> SVector<T, N> {
        self.momentum - node.p - (node.p_low + self.before * h)
    }

    /// The sums of the absolute values of the terms of r, from such sums.
    #[inline]
    fn scale(&self, node: &Node<N, T>, h: T) -> SVector<T, N> {
        node.p.map(T::abs) + self.momentum + self.before * h.abs()
    }
}

/// The sums at the midpoint of a step.
#[inline]
fn of_midpoint<const N: usize, T: Real, S: Indexed<N, T>>(first: &FirstDerivatives<N, T>) -> Sums<N, T> {
    Sums::of::<S>(0.5, first)
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

/// The derivatives of `r_v L_v + r_q (L_q + f)` at a point: with respect to v times c_v, plus those with respect to q
/// times c_q.
#[inline]
fn moved<const N: usize, T: Real, S: Indexed<N, T>>(
    system: &S,
    (t, q, v): (T, &SVector<T, N>, &SVector<T, N>),
    rows: [T; 2],
    columns: [T; 2],
) -> SMatrix<T, N, N> {
    let mut matrix = system.second_derivatives(t, q, v, rows, columns);
    if S::FORCED && !rows[0].is_zero() {
        system.add_force_derivatives(t, q, v, rows[0], columns, &mut matrix);
    }
    matrix
}

/// `A = ∂r/∂v`, for systems without a simpler form of it.
#[inline]
pub fn jacobian<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    _rule: R,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> SMatrix<T, N, N> {
    sum::<R, _>(|[c, weight]| {
        let (t, q) = node.within(c, h, v);
        moved(system, (t, &q, v), of_residual([c, weight], h), [h * T::real(c), T::one()])
    })
}

/// The factors of L_q + f and of L_v in the residual.
#[inline]
fn of_residual<T: Real>([c, weight]: [f64; 2], h: T) -> [T; 2] {
    [-(h * T::real(weight * (1.0 - c))), T::real(weight)]
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

/// The momentum equation at a trial velocity with this Jacobian, for
/// [`FixedStepping::momentum_equation`](crate::stepping::FixedStepping::momentum_equation).
#[inline]
pub fn momentum_equation<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature, J>(
    system: &S,
    _rule: R,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
    jacobian: J,
) -> MomentumEquation<N, T, J> {
    let sums = sum::<R, _>(|[c, weight]| {
        let (t, q) = node.within(c, h, v);
        if 1.0 - c == 0.0 {
            // The end contributes its momentum only.
            let momentum = system.momentum(t, &q, v) * T::real(weight);
            return Sums { momentum, before: SVector::zeros(), force: SVector::zeros() };
        }
        Sums::of::<S>(c, &system.first_derivatives(t, &q, v).weighted(weight))
    });
    MomentumEquation { residual: sums.residual(node, h), jacobian }
}

/// The residual of the momentum equation with its scale, and `p1 − p0`, for
/// [`FixedStepping::momentum_residual`](crate::stepping::FixedStepping::momentum_residual).
#[inline]
pub fn momentum_residual<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    _rule: R,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> MomentumResidual<N, T> {
    let Both([sums, magnitudes]) = sum::<R, _>(|[c, weight]| {
        let (t, q) = node.within(c, h, v);
        Both(system.measured_derivatives(t, &q, v).map(|first| Sums::of::<S>(c, &first.weighted(weight))))
    });
    MomentumResidual { residual: sums.residual(node, h), scale: magnitudes.scale(node, h), increment: sums.force * h }
}

/// Sums, and the same sums of absolute values.
struct Both<V>([V; 2]);

impl<V: Add<Output = V>> Add for Both<V> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let ([sum, size], [other, other_size]) = (self.0, other.0);
        Self([sum + other, size + other_size])
    }
}

/// Derivatives of the residual and of `p1 − p0` with respect to q0 and v, with this Jacobian, for
/// [`FixedStepping::momentum_derivatives`](crate::stepping::FixedStepping::momentum_derivatives).
#[inline]
pub fn momentum_derivatives<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature, J>(
    system: &S,
    _rule: R,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
    jacobian: J,
) -> MomentumDerivatives<J, SMatrix<T, N, N>> {
    let of_increment = |[_, weight]: [f64; 2], h: T| [h * T::real(weight), T::zero()];
    let by_q = |_: f64| [T::one(), T::zero()];
    let by_v = |c: f64| [h * T::real(c), T::one()];
    let sum = |rows: fn([f64; 2], T) -> [T; 2], columns: &dyn Fn(f64) -> [T; 2]| {
        sum::<R, _>(|[c, weight]| {
            let (t, q) = node.within(c, h, v);
            moved(system, (t, &q, v), rows([c, weight], h), columns(c))
        })
    };
    MomentumDerivatives {
        residual_dq: sum(of_residual, &by_q),
        residual_dv: jacobian,
        increment_dq: sum(of_increment, &by_q),
        increment_dv: sum(of_increment, &by_v),
    }
}

/// Discrete energy at the end of a step, for
/// [`FixedStepping::discrete_energy`](crate::stepping::FixedStepping::discrete_energy).
#[inline]
pub fn discrete_energy<const N: usize, T: Real, S: Indexed<N, T>, R: Quadrature>(
    system: &S,
    _rule: R,
    node: &Node<N, T>,
    h: T,
    v: &SVector<T, N>,
) -> T {
    sum::<R, _>(|[c, weight]| {
        let (t, q) = node.within(c, h, v);
        let first = system.first_derivatives(t, &q, v).weighted(weight);
        if S::AUTONOMOUS && !S::FORCED {
            return first.energy(v);
        }
        first.energy(v) + h * T::real(c) * first.power::<S>(v)
    })
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
            residual: of_midpoint::<N, T, S>(&first).residual(node, h),
            jacobian: jacobian(system, Midpoint, node, h, v),
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
        residual: of_midpoint::<N, T, S>(&first).residual(node, h),
        scale: of_midpoint::<N, T, S>(&magnitudes).scale(node, h),
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
    // E1 − E0 = h (f·v − L_t).
    let (mut energy_increment_dq, mut energy_increment_dv) = (zeros, zeros);
    if S::FORCED {
        let of_force = |columns: [T; 2]| {
            let mut matrix = SMatrix::<T, N, N>::zeros();
            system.add_force_derivatives(t, &q, v, h, columns, &mut matrix);
            matrix.tr_mul(v)
        };
        energy_increment_dq = of_force([T::one(), T::zero()]);
        energy_increment_dv = of_force([half, T::one()]) + first.force * h;
    }
    if !S::AUTONOMOUS {
        let [_, of_t] = along_direction(system, (t, &q, v), (T::one(), &zeros, &zeros));
        energy_increment_dq -= of_t.dq * h;
        energy_increment_dv -= (of_t.dv + of_t.dq * half) * h;
    }
    let AlongStep { residual_dh, energy_dv, energy_dh } = AlongStep::new::<S>(h, v, &first, &rates);
    ExtendedDerivatives {
        momentum: momentum_derivatives(system, Midpoint, node, h, v, jacobian(system, Midpoint, node, h, v)),
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
