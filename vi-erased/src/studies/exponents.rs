//! Lyapunov exponents along one run of a type-erased system.
//!
//! In: a system with its parameters, a [`Plan`], the number of exponents. Out: [`Exponents`], which are updated along
//! the run.

use crate::erasable::Runnable;
use crate::plan::{DEFAULT_BOUND_STAGES, Plan, STAGES};
use crate::simulation::vector;
use vi_core::derivatives::Lyapunov;
use vi_core::kind::Kind;
use vi_core::{Gauss, Starts, StepError};

/// Stages of the Gauss steps of a free system and of one with constraints; programs contain these anyway.
const FREE: usize = STAGES[1];
const BOUND: usize = DEFAULT_BOUND_STAGES;

/// Lyapunov exponents along a run.
pub trait Exponents {
    /// Takes `steps` steps.
    ///
    /// # Errors
    /// The error of the failed step.
    fn advance(&mut self, steps: u64) -> Result<(), StepError>;
    /// Time of the last node.
    fn t(&self) -> f64;
    /// Coordinates of the last node.
    fn q(&self) -> &[f64];
    /// The estimates.
    fn exponents(&self) -> Vec<f64>;
}

impl<S: Runnable<N>, const N: usize, const STAGES: usize> Exponents for Lyapunov<Gauss<STAGES>, S, N> {
    fn advance(&mut self, steps: u64) -> Result<(), StepError> {
        self.advance(steps)
    }

    fn t(&self) -> f64 {
        self.run().t()
    }

    fn q(&self) -> &[f64] {
        self.run().node().q.as_slice()
    }

    fn exponents(&self) -> Vec<f64> {
        self.exponents()
    }
}

/// The exponents of the first coordinates of a system, the others of which are at rest, along the run of a plan.
///
/// # Errors
/// The error of the integrator for the initial state.
pub fn begin<S: Runnable<N>, const N: usize>(
    system: S,
    plan: &Plan,
    (count, coordinates): (usize, usize),
) -> Result<Box<dyn Exponents>, StepError> {
    let start = system.at(
        plan.t,
        vector::<N>(&plan.q, "number of coordinates")?,
        vector::<N>(&plan.v, "number of velocities")?,
    );
    if const { S::Kind::COUNT == 0 } {
        Ok(Box::new(Lyapunov::of_first(start.integrate(Gauss::<FREE>, plan.h)?, count, coordinates)?))
    } else {
        Ok(Box::new(Lyapunov::of_first(start.integrate(Gauss::<BOUND>, plan.h)?, count, coordinates)?))
    }
}
