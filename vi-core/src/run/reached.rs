//! A run at a part of its next step, type-erased, so that the search for events is compiled once for all methods and
//! systems.

use super::Run;
use super::event::Moment;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::state::State;
use alloc::boxed::Box;
use nalgebra::SVector;

/// A type-erased run from one node on.
pub(super) trait ErasedRun<const N: usize> {
    /// Length of a step.
    fn step_length(&self) -> f64;
    /// The end of a step of this length.
    fn reached(&self, length: f64) -> Result<StepEnd<N>, StepError>;
    /// The run after a step of this length.
    fn run_after(&self, length: f64) -> Result<Box<dyn ErasedRun<N> + '_>, StepError>;
}

/// The end of a step.
pub(super) struct StepEnd<const N: usize> {
    pub(super) state: State<N>,
    pub(super) v: SVector<f64, N>,
}

/// The run after a step of this length; a subnormal length is no step.
pub(super) fn moved<M, S, const N: usize>(run: &Run<M, S, N>, length: f64) -> Result<Run<M, S, N>, StepError>
where
    M: Method<S, N>,
    S: Lagrangian<N> + Copy,
{
    let mut aside = run.clone();
    if length.is_normal() {
        aside.step_of(length)?;
    }
    Ok(aside)
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> ErasedRun<N> for Run<M, S, N> {
    fn step_length(&self) -> f64 {
        self.h()
    }

    fn reached(&self, length: f64) -> Result<StepEnd<N>, StepError> {
        let end = moved(self, length)?;
        Ok(StepEnd { state: end.state(), v: end.velocity()? })
    }

    fn run_after(&self, length: f64) -> Result<Box<dyn ErasedRun<N> + '_>, StepError> {
        Ok(Box::new(moved(self, length)?))
    }
}

impl<const N: usize> StepEnd<N> {
    /// The moment of this crossing.
    pub(super) fn moment(&self) -> Moment<N> {
        Moment { t: self.state.t, q: self.state.q, v: self.v }
    }
}
