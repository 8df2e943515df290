//! Lyapunov exponents along one run of any system, its number of degrees of freedom erased.
//!
//! In: a system with its parameters, a [`Plan`], how many exponents. Out: [`Exponents`], whose estimates follow the run.

use crate::plan::Plan;
use crate::simulation::vector;
use vi_core::collocation::Collocation;
use vi_core::derivatives::Lyapunov;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Integrator as _, State, StepError};

/// Stages of the Gauss steps, which the command has anyway.
const STAGES: usize = 8;

/// Lyapunov exponents along a run.
pub trait Exponents {
    /// Takes so many steps.
    ///
    /// # Errors
    /// That of the step that fails.
    fn advance(&mut self, steps: u64) -> Result<(), StepError>;
    /// Time of the node reached last.
    fn t(&self) -> f64;
    /// Its coordinates.
    fn q(&self) -> &[f64];
    /// The estimates.
    fn exponents(&self) -> Vec<f64>;
}

impl<S, const N: usize> Exponents for Lyapunov<Gauss<S, N, STAGES>, N>
where
    S: Collocation<N> + Convertible<N>,
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
/// What the integrator says of the initial state.
pub fn begin<'a, S, const N: usize>(system: S, plan: &Plan, count: usize) -> Result<Box<dyn Exponents + 'a>, StepError>
where
    S: Collocation<N> + Convertible<N> + 'a,
{
    let q = vector(&plan.q, "number of coordinates")?;
    let v = vector(&plan.v, "number of velocities")?;
    let run = Gauss::<S, N, STAGES>::new(system, State::at(&system, plan.t, q, v), plan.h)?;
    Ok(Box::new(Lyapunov::new(run, count)?))
}
