//! A system that counts how often its equations are evaluated.
//!
//! In: a system. Out: the same system, and a count of the calls that an integrator pays for: a residual with its
//! Jacobian, with or without the gain, the gain of a step, an acceleration; each counts one. Everything else is passed on uncounted.

use core::cell::Cell;
use vi_core::stepping::{EnergyStepping, FixedStepping};
use vi_core::{DiscreteLagrangian, Lagrangian, forward};

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
    forward! { [N f64 S] self => &self.system; [] lagrangian_constants lagrangian energy momentum force flow non_finite }
    forward! { [N f64 S] self => self.counted(); [] acceleration }
}

impl<S: DiscreteLagrangian<N>, const N: usize> DiscreteLagrangian<N> for Counting<'_, S> {
    forward! { [N f64 S] self => &self.system; [] slots }
}

impl<S: FixedStepping<N>, const N: usize> FixedStepping<N> for Counting<'_, S> {
    forward! { [N f64 S] self => self.counted(); [] momentum_equation momentum_residual }
    forward! { [N f64 S] self => &self.system; [] stepping_types momentum_derivatives momentum_rounding discrete_energy }
}

impl<S: EnergyStepping<N>, const N: usize> EnergyStepping<N> for Counting<'_, S> {
    forward! { [N f64 S] self => self.counted(); [] extended_system extended_residual }
    forward! { [N f64 S] self => &self.system; [] step_density extended_derivatives extended_rounding }
}
