//! Handwritten systems, so that tests of the steppers do not depend on the generator.
//!
//! In: a potential `V(t, q)` and a force `f(t, q, v)` with their derivatives. Out: the system `L = v·v/2 − V` with the
//! midpoint rule. With everything at `t̄ = t0 + h/2`, `q̄ = q0 + h v/2`:
//!
//!     r = v + (h/2)(V_q − f) − p0
//!     c = −v·v/2 + V − (h/2)(V_t + v·V_q) + v·p0 − E0
//!     A = 1 + (h/2)((h/2)(V_qq − f_q) − f_v)
//!     ∂r/∂h = (V_q − f)/2 + (h/4)(V_tq − f_t + (V_qq − f_q) v)
//!     energy_dv = (V_q − f)/2 − (h/4)(V_tq + V_qq v)
//!     energy_dh = −(V_tt + 2 v·V_tq + v·V_qq v)/4
//!     D = |V_q − f|² + v·V_qq v + 2 v·V_tq + V_tt          for f = 0

use vi_core::lagrangian::{Flow, Undefined};
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::real::Rounded;
use vi_core::real::{Number, Real};
use vi_core::stepping::{
    EnergyStepping, ExtendedDerivatives, ExtendedResidual, ExtendedSystem, FixedStepping, Increment,
    MomentumDerivatives, MomentumEquation, MomentumResidual, Rounding,
};
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector, StepError, support};

/// A potential and a force at one point, with their derivatives.
pub(crate) struct Fields<const N: usize, T> {
    pub(crate) potential: T,
    /// Sum of the absolute values of the terms of V.
    pub(crate) potential_magnitude: T,
    pub(crate) potential_t: T,
    pub(crate) potential_tt: T,
    pub(crate) gradient: SVector<T, N>,
    pub(crate) gradient_t: SVector<T, N>,
    pub(crate) hessian: SMatrix<T, N, N>,
    pub(crate) force: SVector<T, N>,
    pub(crate) force_t: SVector<T, N>,
    pub(crate) force_q: SMatrix<T, N, N>,
    pub(crate) force_v: SMatrix<T, N, N>,
}

impl<const N: usize, T: Real> Fields<N, T> {
    /// An autonomous potential without force.
    pub(crate) fn potential(potential: T, magnitude: T, gradient: SVector<T, N>, hessian: SMatrix<T, N, N>) -> Self {
        let (zero, zeros, square) = (T::zero(), SVector::zeros(), SMatrix::zeros());
        Self {
            potential,
            potential_magnitude: magnitude,
            potential_t: zero,
            potential_tt: zero,
            gradient,
            gradient_t: zeros,
            hessian,
            force: zeros,
            force_t: zeros,
            force_q: square,
            force_v: square,
        }
    }
}

/// The parts of a system of unit mass.
pub(crate) trait Potential<const N: usize, T: Real>: Copy {
    fn fields(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Fields<N, T>;
    fn undefined(&self, _: &SVector<T, N>, _: &SVector<T, N>) -> Option<Undefined> {
        None
    }
}

/// The requirements on such a system: its equations in its own numbers, and in numbers with a rounding bound.
pub(crate) trait Steppable<const N: usize>: Potential<N, f64> + Potential<N, Rounded> {}

impl<const N: usize, P: Potential<N, f64> + Potential<N, Rounded>> Steppable<N> for P {}

/// `V = (q⁴ − q²)/2`.
#[derive(Clone, Copy)]
pub(crate) struct DoubleWell;

impl<T: Real> Potential<1, T> for DoubleWell {
    fn fields(&self, _: T, q: &SVector<T, 1>, _: &SVector<T, 1>) -> Fields<1, T> {
        let (x, half) = (q[0], T::real(0.5));
        let x2 = x * x;
        Fields::potential(
            (x2 * x2 - x2) * half,
            (x2 * x2 + x2) * half,
            SVector::repeat((x2 + x2 - T::one()) * x),
            SMatrix::repeat(T::real(6.0) * x2 - T::one()),
        )
    }
}

/// `V = k q²/2`, `f = −c v`.
#[derive(Clone, Copy)]
pub(crate) struct DampedOscillator {
    pub(crate) k: f64,
    pub(crate) c: f64,
}

impl<T: Real> Potential<1, T> for DampedOscillator {
    fn fields(&self, _: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> Fields<1, T> {
        let (k, c, half) = (T::real(self.k), T::real(self.c), T::real(0.5));
        let potential = k * q[0] * q[0] * half;
        let fields = Fields::potential(potential, potential, q * k, SMatrix::repeat(k));
        Fields { force: -(v * c), force_v: SMatrix::repeat(-c), ..fields }
    }
}

/// `V = −μ/|q|`.
#[derive(Clone, Copy)]
pub(crate) struct Kepler {
    pub(crate) mu: f64,
}

impl<T: Real> Potential<2, T> for Kepler {
    fn fields(&self, _: T, q: &SVector<T, 2>, _: &SVector<T, 2>) -> Fields<2, T> {
        let mu = T::real(self.mu);
        let inverse = q[0].hypot(q[1]).recip();
        let cube = mu * inverse * inverse * inverse;
        let fifth = T::real(3.0) * cube * inverse * inverse;
        let hessian = SMatrix::<T, 2, 2>::identity() * cube - (q * q.transpose()) * fifth;
        Fields::potential(-(mu * inverse), mu * inverse, q * cube, hessian)
    }
}

/// `V = q²/2 + q⁴/4`, `f = −0.1 v + 0.3 cos 1.2 t`.
#[derive(Clone, Copy)]
pub(crate) struct ForcedDuffing;

impl<T: Real> Potential<1, T> for ForcedDuffing {
    fn fields(&self, t: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> Fields<1, T> {
        let (x, half, damping, frequency) = (q[0], T::real(0.5), T::real(0.1), T::real(1.2));
        let x2 = x * x;
        let potential = x2 * half + x2 * x2 * T::real(0.25);
        let (sin, cos) = (frequency * t).sin_cos();
        let fields = Fields::potential(
            potential,
            potential,
            SVector::repeat(x + x2 * x),
            SMatrix::repeat(T::one() + T::real(3.0) * x2),
        );
        Fields {
            force: SVector::repeat(T::real(0.3) * cos - damping * v[0]),
            force_t: SVector::repeat(-(T::real(0.3) * frequency * sin)),
            force_v: SMatrix::repeat(-damping),
            ..fields
        }
    }
}

/// `V = −(1 + cos(2t)/2) cos q` and the force `f = −0.2 q v`: every derivative in the rule is nonzero.
#[derive(Clone, Copy)]
pub(crate) struct PumpedPendulum;

impl<T: Real> Potential<1, T> for PumpedPendulum {
    fn fields(&self, t: T, q: &SVector<T, 1>, v: &SVector<T, 1>) -> Fields<1, T> {
        let (two, friction) = (T::real(2.0), T::real(0.2));
        let (sin_t, cos_t) = (two * t).sin_cos();
        let (sin, cos) = q[0].sin_cos();
        let strength = T::one() + T::real(0.5) * cos_t;
        let potential = -(strength * cos);
        let fields = Fields::potential(
            potential,
            potential.abs(),
            SVector::repeat(strength * sin),
            SMatrix::repeat(strength * cos),
        );
        Fields {
            potential_t: sin_t * cos,
            potential_tt: two * cos_t * cos,
            gradient_t: SVector::repeat(-(sin_t * sin)),
            force: SVector::repeat(-(friction * q[0] * v[0])),
            force_q: SMatrix::repeat(-(friction * v[0])),
            force_v: SMatrix::repeat(-(friction * q[0])),
            ..fields
        }
    }
}

/// `V = 0`: every step length solves the equations.
#[derive(Clone, Copy)]
pub(crate) struct FreeParticle;

impl<T: Real> Potential<1, T> for FreeParticle {
    fn fields(&self, _: T, _: &SVector<T, 1>, _: &SVector<T, 1>) -> Fields<1, T> {
        Fields::potential(T::zero(), T::zero(), SVector::zeros(), SMatrix::zeros())
    }
}

/// A particle of unit mass in a potential.
#[derive(Clone, Copy)]
pub(crate) struct UnitMass<P>(pub(crate) P);

fn magnitude<const N: usize, T: Real>(a: &SVector<T, N>, b: &SVector<T, N>) -> T {
    a.iter().zip(b.iter()).fold(T::zero(), |sum, (a, b)| sum + (*a * *b).abs())
}

impl<const N: usize, T: Real, P: Potential<N, T>> Lagrangian<N, T> for UnitMass<P> {
    const NAME: &'static str = "UnitMass";
    const COORDINATES: [&'static str; N] = ["q"; N];
    const AUTONOMOUS: bool = false;
    const FORCED: bool = true;
    const CYCLIC: [bool; N] = [false; N];

    fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        v.dot(v) * T::real(0.5) - self.0.fields(t, q, v).potential
    }

    fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        v.dot(v) * T::real(0.5) + self.0.fields(t, q, v).potential
    }

    fn momentum(&self, _: T, _: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        *v
    }

    fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.0.fields(t, q, v).force
    }

    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        let fields = self.0.fields(t, q, v);
        Ok(fields.force - fields.gradient)
    }

    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        let fields = self.0.fields(t, q, p);
        Ok(Flow { v: *p, force: fields.force - fields.gradient, power: fields.potential_t + fields.force.dot(p) })
    }

    fn undefined(&self, _: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<Undefined> {
        self.0.undefined(q, v)
    }
}

/// Midpoint of an interval: `(h, t̄, q̄, v)`.
fn middle<const N: usize, T: Real>(interval: &Interval<N, T>) -> (T, T, SVector<T, N>, SVector<T, N>) {
    let (h, half) = (interval.t1 - interval.t0, T::real(0.5));
    let v = (interval.q1 - interval.q0) * h.recip();
    (h, (interval.t0 + interval.t1) * half, (interval.q0 + interval.q1) * half, v)
}

impl<const N: usize, T: Real, P: Potential<N, T>> DiscreteLagrangian<N, T> for UnitMass<P> {
    fn ld(&self, interval: &Interval<N, T>) -> T {
        let (h, t, q, v) = middle(interval);
        h * self.lagrangian(t, &q, &v)
    }

    fn d1_ld(&self, interval: &Interval<N, T>) -> T {
        let (h, t, q, v) = middle(interval);
        self.energy(t, &q, &v) - h * T::real(0.5) * self.0.fields(t, &q, &v).potential_t
    }

    fn d2_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        let (h, t, q, v) = middle(interval);
        -(self.0.fields(t, &q, &v).gradient * (h * T::real(0.5))) - v
    }

    fn d3_ld(&self, interval: &Interval<N, T>) -> T {
        let (h, t, q, v) = middle(interval);
        -self.energy(t, &q, &v) - h * T::real(0.5) * self.0.fields(t, &q, &v).potential_t
    }

    fn d4_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        let (h, t, q, v) = middle(interval);
        v - self.0.fields(t, &q, &v).gradient * (h * T::real(0.5))
    }

    fn fd_minus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        let (h, t, q, v) = middle(interval);
        self.force(t, &q, &v) * (h * T::real(0.5))
    }

    fn fd_plus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        self.fd_minus(interval)
    }

    fn gd_minus(&self, interval: &Interval<N, T>) -> T {
        let (_, _, _, v) = middle(interval);
        -self.fd_minus(interval).dot(&v)
    }

    fn gd_plus(&self, interval: &Interval<N, T>) -> T {
        self.gd_minus(interval)
    }
}

impl<const N: usize, T: Real, P: Potential<N, T> + Potential<N, Rounded>> FixedStepping<N, T> for UnitMass<P> {
    type Jacobian = SMatrix<T, N, N>;
    type StepMatrix = SMatrix<T, N, N>;
    const CONSTANT_JACOBIAN: bool = false;

    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T> {
        let (t, q) = node.midpoint(h, v);
        let fields = self.0.fields(t, &q, v);
        let half = h * T::real(0.5);
        let slope = fields.gradient - fields.force;
        MomentumEquation {
            residual: *v + slope * half - node.p - node.p_low,
            jacobian: SMatrix::identity() + ((fields.hessian - fields.force_q) * half - fields.force_v) * half,
        }
    }

    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
        let both = self.extended_residual(node, h, v);
        let ExtendedResidual { residual, scale, increment, .. } = both;
        MomentumResidual { residual, scale, increment: increment.momentum }
    }

    fn momentum_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumDerivatives<SMatrix<T, N, N>, SMatrix<T, N, N>> {
        let (t, q) = node.midpoint(h, v);
        let fields = self.0.fields(t, &q, v);
        let half = h * T::real(0.5);
        let slope = fields.force_q - fields.hessian;
        MomentumDerivatives {
            residual_dq: -slope * half,
            residual_dv: self.momentum_equation(node, h, v).jacobian,
            increment_dq: slope * h,
            increment_dv: (slope * half + fields.force_v) * h,
        }
    }

    fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N> {
        support::momentum_rounding(self, node, h, v)
    }

    fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T {
        let (t, q) = node.midpoint(h, v);
        let fields = self.0.fields(t, &q, v);
        self.energy(t, &q, v) + h * T::real(0.5) * (fields.potential_t + fields.force.dot(v))
    }
}

impl<const N: usize, T: Real, P: Potential<N, T> + Potential<N, Rounded>> EnergyStepping<N, T> for UnitMass<P> {
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError> {
        let fields = self.0.fields(t, q, v);
        let a = fields.force - fields.gradient;
        let along = v.dot(&fields.gradient_t);
        Ok(a.dot(&a) + v.dot(&(fields.hessian * v)) + along + along + fields.potential_tt)
    }

    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T> {
        let momentum = self.momentum_equation(node, h, v);
        let (t, q) = node.midpoint(h, v);
        let fields = self.0.fields(t, &q, v);
        let (half, quarter) = (T::real(0.5), T::real(0.25));
        let curvature = fields.gradient_t + fields.hessian * v;
        let kinetic = v.dot(v) * half;
        ExtendedSystem {
            momentum,
            residual_dh: (fields.gradient - fields.force) * half
                + (curvature - fields.force_t - fields.force_q * v) * (h * quarter),
            energy_residual: v.dot(&node.p) - kinetic + fields.potential
                - node.energy
                - h * half * (fields.potential_t + v.dot(&fields.gradient))
                + v.dot(&node.p_low)
                - node.energy_low,
            energy_dv: (fields.gradient - fields.force) * half - curvature * (h * quarter),
            energy_dh: -(quarter * (fields.potential_tt + v.dot(&fields.gradient_t) + v.dot(&curvature))),
        }
    }

    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
        let system = self.extended_system(node, h, v);
        let (t, q) = node.midpoint(h, v);
        let fields = self.0.fields(t, &q, v);
        ExtendedResidual {
            residual: system.momentum.residual,
            scale: v.map(Number::abs)
                + (fields.gradient.map(Number::abs) + fields.force.map(Number::abs)) * (h * T::real(0.5)).abs()
                + node.p.map(Number::abs),
            energy_residual: system.energy_residual,
            energy_scale: v.dot(v) * T::real(0.5)
                + fields.potential_magnitude
                + (h * T::real(0.5)).abs() * (fields.potential_t.abs() + magnitude(v, &fields.gradient))
                + magnitude(v, &node.p)
                + node.energy.abs(),
            increment: Increment {
                momentum: (fields.force - fields.gradient) * h,
                energy: h * (fields.potential_t + fields.force.dot(v)),
            },
        }
    }

    fn extended_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> ExtendedDerivatives<N, T, SMatrix<T, N, N>, SMatrix<T, N, N>> {
        let ExtendedSystem { residual_dh, energy_dv, energy_dh, .. } = self.extended_system(node, h, v);
        let (t, q) = node.midpoint(h, v);
        let fields = self.0.fields(t, &q, v);
        let half = h * T::real(0.5);
        let forward = (fields.force_t - fields.gradient_t + (fields.force_q - fields.hessian) * v) * half;
        // E1 − E0 = h (V_t + f·v)
        let power = fields.potential_t + fields.force.dot(v);
        let power_dq = fields.gradient_t + fields.force_q.transpose() * v;
        let power_dt = fields.potential_tt + fields.force_t.dot(v);
        ExtendedDerivatives {
            momentum: self.momentum_derivatives(node, h, v),
            residual_dh,
            increment_dh: fields.force - fields.gradient + forward,
            energy_dq: fields.gradient - (fields.gradient_t + fields.hessian * v) * half,
            energy_dv,
            energy_dh,
            energy_increment_dq: power_dq * h,
            energy_increment_dv: (power_dq * half + fields.force + fields.force_v.transpose() * v) * h,
            energy_increment_dh: power + (power_dt + power_dq.dot(v)) * half,
        }
    }

    fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
        support::extended_rounding(self, node, h, v)
    }
}

/// Position at time `h` of the motion from rest at `q0`: classical Runge–Kutta of order 4 in 1000 steps, with an error
/// below rounding for h ≤ 0.1.
pub(crate) fn point_after<P: Potential<1, f64>>(potential: &P, q0: f64, h: f64) -> f64 {
    let d = h / 1000.0;
    let a = |q: f64| -potential.fields(0.0, &SVector::repeat(q), &SVector::zeros()).gradient[0];
    let (mut q, mut v) = (q0, 0.0);
    for _ in 0..1000 {
        let (q1, v1) = (v, a(q));
        let (q2, v2) = (v + d / 2.0 * v1, a(q + d / 2.0 * q1));
        let (q3, v3) = (v + d / 2.0 * v2, a(q + d / 2.0 * q2));
        let (q4, v4) = (v + d * v3, a(q + d * q3));
        q += d / 6.0 * (q1 + 2.0 * q2 + 2.0 * q3 + q4);
        v += d / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    }
    q
}
