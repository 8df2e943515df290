//! Lyapunov exponents along one run of a type-erased system.
//!
//! In: a system with its parameters, a [`Plan`], the number of exponents. Out: [`Exponents`], which are updated along
//! the run.

use vi_core::derivatives::Lyapunov;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Starts, StepError};
use vi_erased::Plan;
use vi_erased::simulation::vector;

/// Stages of the Gauss steps; the command contains these anyway.
const STAGES: usize = 8;

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

impl<S, const N: usize> Exponents for Lyapunov<Gauss<STAGES>, S, N>
where
    S: Convertible<N>,
{
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

/// The exponents of a system along the run of a plan.
///
/// # Errors
/// The error of the integrator for the initial state.
pub fn begin<'a, S, const N: usize>(system: S, plan: &Plan, count: usize) -> Result<Box<dyn Exponents + 'a>, StepError>
where
    S: Convertible<N> + 'a,
{
    let q = vector(&plan.q, "number of coordinates")?;
    let v = vector(&plan.v, "number of velocities")?;
    let run = system.at(plan.t, q, v).integrate(Gauss::<STAGES>, plan.h)?;
    Ok(Box::new(Lyapunov::new(run, count)?))
}
