//! A system that counts how often its equations are evaluated.
//!
//! In: a system. Out: the same system, and a count of the calls that an integrator pays for: a residual with its
//! Jacobian, with or without the gain, the gain of a step, an acceleration; each counts one. Everything else is passed on uncounted.

use core::cell::Cell;
use vi_core::lagrangian::Flow;
use vi_core::node::Node;
use vi_core::stepping::{
    EnergyStepping, ExtendedDerivatives, ExtendedResidual, ExtendedSystem, FixedStepping, MomentumDerivatives,
    MomentumEquation, MomentumResidual, Rounding,
};
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector, StepError};

/// A system, and the evaluations so far: its copies count together.
#[derive(Clone, Copy, Debug)]
pub struct Counting<'a, S> {
    system: S,
    evaluations: &'a Cell<u64>,
}

impl<'a, S> Counting<'a, S> {
    /// The system, and where its evaluations are added.
    pub fn new(system: S, evaluations: &'a Cell<u64>) -> Self {
        Self { system, evaluations }
    }

    /// The system, for a call that counts.
    fn counted(&self) -> &S {
        self.evaluations.update(|count| count + 1);
        &self.system
    }
}

impl<S: Lagrangian<N>, const N: usize> Lagrangian<N> for Counting<'_, S> {
    const NAME: &'static str = S::NAME;
    const COORDINATES: [&'static str; N] = S::COORDINATES;
    const AUTONOMOUS: bool = S::AUTONOMOUS;
    const FORCED: bool = S::FORCED;
    const CYCLIC: [bool; N] = S::CYCLIC;

    fn lagrangian(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.system.lagrangian(t, q, v)
    }

    fn energy(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.system.energy(t, q, v)
    }

    fn momentum(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.system.momentum(t, q, v)
    }

    fn force(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.system.force(t, q, v)
    }

    fn acceleration(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Result<SVector<f64, N>, StepError> {
        self.counted().acceleration(t, q, v)
    }

    fn flow(&self, t: f64, q: &SVector<f64, N>, p: &SVector<f64, N>) -> Result<Flow<N>, StepError> {
        self.system.flow(t, q, p)
    }

    fn non_finite(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Option<&'static str> {
        self.system.non_finite(t, q, v)
    }
}

impl<S: DiscreteLagrangian<N>, const N: usize> DiscreteLagrangian<N> for Counting<'_, S> {
    fn ld(&self, interval: &Interval<N>) -> f64 {
        self.system.ld(interval)
    }

    fn d1_ld(&self, interval: &Interval<N>) -> f64 {
        self.system.d1_ld(interval)
    }

    fn d2_ld(&self, interval: &Interval<N>) -> SVector<f64, N> {
        self.system.d2_ld(interval)
    }

    fn d3_ld(&self, interval: &Interval<N>) -> f64 {
        self.system.d3_ld(interval)
    }

    fn d4_ld(&self, interval: &Interval<N>) -> SVector<f64, N> {
        self.system.d4_ld(interval)
    }

    fn fd_minus(&self, interval: &Interval<N>) -> SVector<f64, N> {
        self.system.fd_minus(interval)
    }

    fn fd_plus(&self, interval: &Interval<N>) -> SVector<f64, N> {
        self.system.fd_plus(interval)
    }

    fn gd_minus(&self, interval: &Interval<N>) -> f64 {
        self.system.gd_minus(interval)
    }

    fn gd_plus(&self, interval: &Interval<N>) -> f64 {
        self.system.gd_plus(interval)
    }
}

impl<S: FixedStepping<N>, const N: usize> FixedStepping<N> for Counting<'_, S> {
    type Jacobian = S::Jacobian;
    type StepMatrix = S::StepMatrix;
    const CONSTANT_JACOBIAN: bool = S::CONSTANT_JACOBIAN;
    const CLOSED_FORM: bool = S::CLOSED_FORM;
    const INLINED: bool = S::INLINED;

    fn momentum_equation(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> MomentumEquation<N, f64, S::Jacobian> {
        self.counted().momentum_equation(node, h, v)
    }

    fn momentum_residual(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> MomentumResidual<N> {
        self.counted().momentum_residual(node, h, v)
    }

    fn momentum_derivatives(
        &self,
        node: &Node<N>,
        h: f64,
        v: &SVector<f64, N>,
    ) -> MomentumDerivatives<S::Jacobian, S::StepMatrix> {
        self.system.momentum_derivatives(node, h, v)
    }

    fn momentum_rounding(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> SVector<f64, N> {
        self.system.momentum_rounding(node, h, v)
    }

    fn discrete_energy(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> f64 {
        self.system.discrete_energy(node, h, v)
    }
}

impl<S: EnergyStepping<N>, const N: usize> EnergyStepping<N> for Counting<'_, S> {
    fn step_density(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Result<f64, StepError> {
        self.system.step_density(t, q, v)
    }

    fn extended_system(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> ExtendedSystem<N, f64, S::Jacobian> {
        self.counted().extended_system(node, h, v)
    }

    fn extended_residual(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> ExtendedResidual<N> {
        self.counted().extended_residual(node, h, v)
    }

    fn extended_derivatives(
        &self,
        node: &Node<N>,
        h: f64,
        v: &SVector<f64, N>,
    ) -> ExtendedDerivatives<N, f64, S::Jacobian, S::StepMatrix> {
        self.system.extended_derivatives(node, h, v)
    }

    fn extended_rounding(&self, node: &Node<N>, h: f64, v: &SVector<f64, N>) -> Rounding<N> {
        self.system.extended_rounding(node, h, v)
    }
}
