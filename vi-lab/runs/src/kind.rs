//! What the command can do with a system by the rules that it is declared with.
//!
//! In: a system of a known type. Out: its runs by a rule and its step density, or the error that it has none. A system without a rule has Gauss steps alone.

use crate::plan::Plan;
use crate::simulation::{self, Simulation};
use core::cell::Cell;
use vi_core::lagrangian::Lagrangian;
use vi_core::stepping::EnergyStepping;
use vi_core::{SVector, StepError};

/// A kind of system.
pub trait Kind<S, const N: usize>: Send + Sync + 'static {
    /// Whether it has a rule.
    const HAS_RULE: bool;

    /// Starts a run by the rule.
    ///
    /// # Errors
    /// What the integrators say of the initial state; [`StepError::NoRule`] for a system without one.
    fn begin<'a>(
        system: S,
        plan: &Plan,
        start: (SVector<f64, N>, SVector<f64, N>),
        evaluations: &'a Cell<u64>,
    ) -> Result<Box<dyn Simulation + 'a>, StepError>
    where
        S: 'a;
    /// The step density at t = 0, if it has a value.
    fn step_density(system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Option<f64>;
}

/// A system with a rule that has a step density.
#[derive(Clone, Copy, Debug)]
pub enum ByRule {}

/// A system without a rule.
#[derive(Clone, Copy, Debug)]
pub enum GaussAlone {}

impl<S: EnergyStepping<N>, const N: usize> Kind<S, N> for ByRule {
    const HAS_RULE: bool = true;

    fn begin<'a>(
        system: S,
        plan: &Plan,
        start: (SVector<f64, N>, SVector<f64, N>),
        evaluations: &'a Cell<u64>,
    ) -> Result<Box<dyn Simulation + 'a>, StepError>
    where
        S: 'a,
    {
        simulation::by_rule(system, plan, start, evaluations)
    }

    fn step_density(system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Option<f64> {
        system.step_density(0.0, q, v).ok().filter(|density| density.is_finite())
    }
}

impl<S: Lagrangian<N>, const N: usize> Kind<S, N> for GaussAlone {
    const HAS_RULE: bool = false;

    fn begin<'a>(
        _: S,
        _: &Plan,
        _: (SVector<f64, N>, SVector<f64, N>),
        _: &'a Cell<u64>,
    ) -> Result<Box<dyn Simulation + 'a>, StepError>
    where
        S: 'a,
    {
        Err(StepError::NoRule { system: S::NAME })
    }

    fn step_density(_: &S, _: &SVector<f64, N>, _: &SVector<f64, N>) -> Option<f64> {
        None
    }
}
