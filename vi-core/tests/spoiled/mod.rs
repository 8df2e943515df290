//! A correct system with one wrong function, as a faulty generator would print it, in every numeric type. Each file
//! uses its part of the faults.

use vi_core::lagrangian::{Flow, Parameters};
use vi_core::linear::Matrix;
use vi_core::motion::{Motion, Point, PointDerivatives, ScaledPoint};
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::real::Real;
use vi_core::stepping::{
    Convertible, Discretized, EnergyStepping, ExtendedDerivatives, ExtendedResidual, ExtendedSystem, FixedStepping,
    Increment, MomentumDerivatives, MomentumEquation, MomentumResidual, Rounding,
};
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector, StepError, forward};

/// The damping of [`Fault::Damping`].
const DAMPING: f64 = 0.01;

/// The fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// No fault.
    None,
    /// The momentum of the first coordinate has the wrong sign.
    Momentum,
    /// The energy is v·p + L.
    Energy,
    /// The acceleration is 1e-3 too large.
    Acceleration,
    /// A term of the step density is missing.
    StepDensity,
    /// The step density is 1e-3 too large.
    Density,
    /// The discrete Lagrangian differs from that of the slots.
    Ld,
    /// D1 has the wrong sign.
    D1,
    /// D2 has the wrong sign.
    D2,
    /// D3 lacks a term.
    D3,
    /// D4 is D2.
    D4,
    /// The discrete force on δq0 is missing.
    FdMinus,
    /// The discrete force on δq1 is double.
    FdPlus,
    /// The discrete power on δt1 has the wrong sign.
    GdPlus,
    /// The force is missing in the residual.
    Residual,
    /// An undeclared damping in the residual, its Jacobian and the increment.
    Damping,
    /// The rounding is too small.
    Rounding,
    /// The last entry of the Jacobian is 1e-6 too large.
    Jacobian,
    /// The first momentum at a point is 1e-3 too large.
    PointMomentum,
    /// An undeclared damping in the force at a point.
    PointForce,
    /// The power is too large.
    Power,
    /// The force of steps in transformed time is 1e-3 too large.
    ScaledForce,
    /// The power of steps in transformed time is too large.
    ScaledPower,
    /// The first derivative of the time scale is 1e-6 too large.
    TimeScaleDq,
    /// The derivative of the time scale with respect to time is 1e-6 too large.
    TimeScaleDt,
    /// The last entry of ∂(L_q + f)/∂q is 1e-6 too large.
    PointDerivatives,
    /// The last entry of ∂(p1 − p0)/∂v is 1e-6 too large.
    MomentumDerivatives,
    /// ∂(p1 − p0)/∂h has the wrong sign.
    ExtendedDerivatives,
    /// ∂r/∂h has the wrong sign.
    ResidualDh,
    /// The energy residual lacks the energy of the node.
    EnergyResidual,
    /// The derivative of the energy row with respect to h has the wrong sign.
    EnergyDh,
    /// The last momentum increases slightly.
    MomentumGain,
    /// Every momentum increment is 1e-3 too large.
    Gain,
    /// Every momentum decreases by 1e-6 of itself.
    Loss,
    /// The increment of the first momentum depends on the direction of time.
    DirectedGain,
    /// The energy increases.
    EnergyGain,
    /// The discrete energy is 1e-3 too large.
    DiscreteEnergy,
}

/// A system with a fault.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spoiled<S> {
    pub(crate) system: S,
    pub(crate) fault: Fault,
}

impl<S> Spoiled<S> {
    /// The correct value, or the wrong one if the fault is active.
    fn unless<P>(&self, fault: Fault, right: P, wrong: impl FnOnce(P) -> P) -> P {
        if self.fault == fault { wrong(right) } else { right }
    }
}

impl<T: Real, S: Parameters<T>> Parameters<T> for Spoiled<S> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        self.system.parameter_mut(name)
    }
}

impl<const N: usize, S: Convertible<N>> Convertible<N> for Spoiled<S> {
    type In<T: Real> = Spoiled<S::In<T>>;
    fn convert<T: Real>(&self) -> Self::In<T> {
        Spoiled { system: self.system.convert(), fault: self.fault }
    }
}

impl<const N: usize, S: Discretized<N>> Discretized<N> for Spoiled<S> {
    type Steps<T: Real> = Spoiled<S::Steps<T>>;
    fn steps<T: Real>(&self) -> Self::Steps<T> {
        Spoiled { system: self.system.steps(), fault: self.fault }
    }
}

impl<const N: usize, T: Real, S: Lagrangian<N, T>> Lagrangian<N, T> for Spoiled<S> {
    forward! { [N T S] self => &self.system; [] lagrangian_facts }

    fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        self.system.lagrangian(t, q, v)
    }
    fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.system.force(t, q, v)
    }
    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        self.system.flow(t, q, p)
    }
    fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        let lagrangian = self.lagrangian(t, q, v);
        self.unless(Fault::Energy, self.system.energy(t, q, v), |energy| energy + lagrangian + lagrangian)
    }
    fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        self.unless(Fault::Momentum, self.system.momentum(t, q, v), |p| {
            SVector::from_fn(|i, _| if i == 0 { -p[i] } else { p[i] })
        })
    }
    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        let right = self.system.acceleration(t, q, v)?;
        Ok(self.unless(Fault::Acceleration, right, |a| a * T::real(1.001)))
    }
}

impl<const N: usize, T: Real, S: Motion<N, T>> Motion<N, T> for Spoiled<S> {
    type Kind = S::Kind;
    type Mass = S::Mass;
    type PointMatrix = SMatrix<T, N, N>;
    const CONSTANT_MASS: bool = S::CONSTANT_MASS;
    const SEPARABLE: bool = S::SEPARABLE;
    const SCALES_TIME: bool = S::SCALES_TIME;

    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, S::Mass> {
        let Point { mut momentum, mut force, mass } = self.system.point(t, q, v);
        match self.fault {
            Fault::PointMomentum => momentum[0] *= T::real(1.001),
            Fault::PointForce => force -= v * T::real(DAMPING),
            _ => {}
        }
        Point { momentum, force, mass }
    }
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<SMatrix<T, N, N>> {
        let PointDerivatives { momentum_dq, mass, force_dq, force_dv } = self.system.point_derivatives(t, q, v);
        let [momentum_dq, mass, mut force_dq, force_dv] = [momentum_dq, mass, force_dq, force_dv].map(|of| of.dense());
        if self.fault == Fault::PointDerivatives {
            force_dq[(N - 1, N - 1)] *= T::real(1.0 + 1e-6);
        }
        PointDerivatives { momentum_dq, mass, force_dq, force_dv }
    }
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        self.unless(Fault::Power, self.system.power(t, q, v), |power| power + T::real(1e-6))
    }
    fn scaled_point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> ScaledPoint<N, T, S::Mass> {
        let mut right = self.system.scaled_point(t, q, v);
        match self.fault {
            Fault::ScaledForce => right.point.force *= T::real(1.001),
            Fault::ScaledPower => right.power += T::real(1e-6),
            Fault::TimeScaleDq => right.g_dq[0] *= T::real(1.0 + 1e-6),
            Fault::TimeScaleDt => right.g_dt *= T::real(1.0 + 1e-6),
            _ => {}
        }
        right
    }
}

impl<const N: usize, T: Real, S: DiscreteLagrangian<N, T>> DiscreteLagrangian<N, T> for Spoiled<S> {
    fn ld(&self, interval: &Interval<N, T>) -> T {
        self.unless(Fault::Ld, self.system.ld(interval), |ld| ld + ld)
    }
    fn d1_ld(&self, interval: &Interval<N, T>) -> T {
        self.unless(Fault::D1, self.system.d1_ld(interval), |d1| -d1)
    }
    fn d2_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        self.unless(Fault::D2, self.system.d2_ld(interval), |d2| -d2)
    }
    fn d3_ld(&self, interval: &Interval<N, T>) -> T {
        self.unless(Fault::D3, self.system.d3_ld(interval), |d3| d3 + (interval.t1 - interval.t0))
    }
    fn d4_ld(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        self.unless(Fault::D4, self.system.d4_ld(interval), |_| self.system.d2_ld(interval))
    }
    fn fd_minus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        self.unless(Fault::FdMinus, self.system.fd_minus(interval), |_| SVector::zeros())
    }
    fn fd_plus(&self, interval: &Interval<N, T>) -> SVector<T, N> {
        self.unless(Fault::FdPlus, self.system.fd_plus(interval), |force| force + force)
    }
    fn gd_minus(&self, interval: &Interval<N, T>) -> T {
        self.system.gd_minus(interval)
    }
    fn gd_plus(&self, interval: &Interval<N, T>) -> T {
        self.unless(Fault::GdPlus, self.system.gd_plus(interval), |power| -power)
    }
}

impl<S> Spoiled<S> {
    fn spoil_derivatives<const N: usize, T: Real>(
        &self,
        right: MomentumDerivatives<S::Jacobian, S::StepMatrix>,
    ) -> MomentumDerivatives<SMatrix<T, N, N>, SMatrix<T, N, N>>
    where
        S: FixedStepping<N, T>,
    {
        let MomentumDerivatives { residual_dq, residual_dv, increment_dq, increment_dv } = right;
        let [residual_dq, increment_dq, mut increment_dv] =
            [residual_dq, increment_dq, increment_dv].map(|of| of.dense());
        if self.fault == Fault::MomentumDerivatives {
            increment_dv[(N - 1, N - 1)] *= T::real(1.0 + 1e-6);
        }
        MomentumDerivatives { residual_dq, residual_dv: residual_dv.dense(), increment_dq, increment_dv }
    }

    fn spoil_momentum<const N: usize, T: Real>(
        &self,
        right: MomentumEquation<N, T, S::Jacobian>,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumEquation<N, T>
    where
        S: FixedStepping<N, T>,
    {
        let mut jacobian = right.jacobian.dense();
        match self.fault {
            Fault::Damping => (0..N).for_each(|i| jacobian[(i, i)] += T::real(DAMPING) * h * T::real(0.5)),
            Fault::Jacobian => jacobian[(N - 1, N - 1)] *= T::real(1.0 + 1e-6),
            _ => {}
        }
        MomentumEquation { residual: self.spoil_residual(right.residual, node, h, v), jacobian }
    }

    fn spoil_residual<const N: usize, T: Real>(
        &self,
        right: SVector<T, N>,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> SVector<T, N>
    where
        S: FixedStepping<N, T>,
    {
        let half = h * T::real(0.5);
        match self.fault {
            Fault::Residual => right + self.system.force(node.t + half, &(node.q + v * half), v) * half,
            Fault::Damping => right + v * (T::real(DAMPING) * half),
            _ => right,
        }
    }

    fn spoil_increment<const N: usize, T: Real>(
        &self,
        mut increment: Increment<N, T>,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> Increment<N, T> {
        match self.fault {
            Fault::Gain => increment.momentum *= T::real(1.001),
            Fault::Loss => increment.momentum -= node.p * T::real(1e-6),
            Fault::MomentumGain => increment.momentum[N - 1] += T::real(1e-6) * h,
            Fault::Damping => increment.momentum -= v * (T::real(DAMPING) * h),
            Fault::DirectedGain => increment.momentum[0] += h * h,
            Fault::EnergyGain => increment.energy += T::real(1e-6) * h,
            _ => {}
        }
        increment
    }
}

impl<const N: usize, T: Real, S: FixedStepping<N, T>> FixedStepping<N, T> for Spoiled<S> {
    type Jacobian = SMatrix<T, N, N>;
    type StepMatrix = SMatrix<T, N, N>;
    const CONSTANT_JACOBIAN: bool = S::CONSTANT_JACOBIAN;

    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T> {
        self.spoil_momentum(self.system.momentum_equation(node, h, v), node, h, v)
    }
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
        let right = self.system.momentum_residual(node, h, v);
        let increment = Increment { momentum: right.increment, energy: T::zero() };
        MomentumResidual {
            residual: self.spoil_residual(right.residual, node, h, v),
            scale: right.scale,
            increment: self.spoil_increment(increment, node, h, v).momentum,
        }
    }
    fn momentum_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> MomentumDerivatives<SMatrix<T, N, N>, SMatrix<T, N, N>> {
        self.spoil_derivatives(self.system.momentum_derivatives(node, h, v))
    }
    fn momentum_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> SVector<T, N> {
        let right = self.system.momentum_rounding(node, h, v);
        self.unless(Fault::Rounding, right, |rounding| rounding * T::real(1e-3))
    }
    fn discrete_energy(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> T {
        let right = self.system.discrete_energy(node, h, v);
        self.unless(Fault::DiscreteEnergy, right, |energy| energy * T::real(1.001))
    }
}

impl<const N: usize, T: Real, S: EnergyStepping<N, T>> EnergyStepping<N, T> for Spoiled<S> {
    fn step_density(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<T, StepError> {
        let right = self.system.step_density(t, q, v)?;
        let right = self.unless(Fault::StepDensity, right, |density| density - q[0] * v[0] * v[0]);
        Ok(self.unless(Fault::Density, right, |density| density * T::real(1.001)))
    }

    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T> {
        let right = self.system.extended_system(node, h, v);
        let mut found = ExtendedSystem {
            momentum: self.spoil_momentum(right.momentum, node, h, v),
            residual_dh: right.residual_dh,
            energy_residual: right.energy_residual,
            energy_dv: right.energy_dv,
            energy_dh: right.energy_dh,
        };
        match self.fault {
            Fault::ResidualDh => found.residual_dh = -found.residual_dh,
            Fault::EnergyResidual => found.energy_residual += node.energy,
            Fault::EnergyDh => found.energy_dh = -found.energy_dh,
            _ => {}
        }
        found
    }
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
        let right = self.system.extended_residual(node, h, v);
        let spoilt = self.unless(Fault::EnergyResidual, right.energy_residual, |residual| residual + node.energy);
        ExtendedResidual {
            residual: self.spoil_residual(right.residual, node, h, v),
            scale: right.scale,
            energy_residual: spoilt,
            energy_scale: right.energy_scale,
            increment: self.spoil_increment(right.increment, node, h, v),
        }
    }
    fn extended_derivatives(
        &self,
        node: &Node<N, T>,
        h: T,
        v: &SVector<T, N>,
    ) -> ExtendedDerivatives<N, T, SMatrix<T, N, N>, SMatrix<T, N, N>> {
        let right = self.system.extended_derivatives(node, h, v);
        let found = ExtendedDerivatives {
            momentum: self.spoil_derivatives(right.momentum),
            residual_dh: right.residual_dh,
            increment_dh: right.increment_dh,
            energy_dq: right.energy_dq,
            energy_dv: right.energy_dv,
            energy_dh: right.energy_dh,
            energy_increment_dq: right.energy_increment_dq,
            energy_increment_dv: right.energy_increment_dv,
            energy_increment_dh: right.energy_increment_dh,
        };
        self.unless(Fault::ExtendedDerivatives, found, |wrong| ExtendedDerivatives {
            increment_dh: -wrong.increment_dh,
            ..wrong
        })
    }
    fn extended_rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
        let right = self.system.extended_rounding(node, h, v);
        let spoil = |right: Rounding<N, T>| Rounding { residual: right.residual * T::real(1e-3), ..right };
        self.unless(Fault::Rounding, right, spoil)
    }
}
