//! A run of the energy-preserving integrator as one value.
//!
//! In: a run, between two steps. Out: a [`Checkpoint`], and the run again (see [`crate::checkpoint`]).

use super::run::Run;
use super::stepper::EnergyPreserving;
use crate::checkpoint;
use crate::error::StepError;
use crate::real::Scalar;
use crate::stepping::EnergyStepping;
use nalgebra::SVector;

/// Everything that a run of [`EnergyPreserving`] carries, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, T = f64> = checkpoint::Checkpoint<Run<N, T>, T>;

impl<S, const N: usize, T> EnergyPreserving<S, N, T>
where
    S: EnergyStepping<N, T>,
    T: Scalar,
{
    /// Everything that the run carries: the node with its low parts, the last interval, bounds, fallback and switches; and of
    /// which system with which parameters. Finite numbers only, so that a text format without infinities can hold it. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<N, T> {
        let mut run = self.run;
        // The change only extrapolates v, and where it has overflowed the guess goes without it.
        if !run.last.change.iter().all(|entry| entry.is_finite()) {
            run.last.change = SVector::zeros();
        }
        checkpoint::Checkpoint::of(&self.system, S::RULE, run)
    }

    /// The run that was at `checkpoint`.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`] and
    /// [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, T>) -> Result<Self, StepError> {
        let run = checkpoint.run_of(&system, S::RULE)?;
        run.check()?;
        Ok(Self { system, run, failure: None })
    }
}
