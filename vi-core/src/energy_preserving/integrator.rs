//! The energy-preserving run as one integrator among others.
//!
//! In: a run. Out: what [`Integrator`] asks. A change of the parameters or of the state brings the energy `ΔH` to the node, and the run
//! goes on with `E + ΔH`: so `H − E`, from which the length of the next step follows, is what it was.

use super::checkpoint::Checkpoint;
use super::fallback::longest;
use super::interval::{Last, RATIO};
use super::run::Run;
use super::stepper::EnergyPreserving;
use crate::error::StepError;
use crate::integrator::{Hermite, Integrator, changed, own};
use crate::state::State;
use crate::stepping::EnergyStepping;

impl<S, const N: usize> Integrator<N> for EnergyPreserving<S, N>
where
    S: EnergyStepping<N>,
{
    type System = S;
    type Path = Hermite<N>;
    type Checkpoint = Checkpoint<N>;

    const LONGEST: f64 = RATIO;

    own!(node, system, h, checkpoint);

    #[inline(always)]
    fn step(&mut self) -> Result<State<N>, StepError> {
        self.step().map(|_| self.run.node.state())
    }

    fn step_of(&mut self, h: f64) -> Result<State<N>, StepError> {
        self.step_of(h).map(|_| self.run.node.state())
    }

    fn discrete_energy(&self) -> Option<f64> {
        Some(self.discrete_energy())
    }

    fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        let state = self.state();
        let brought = state.energy(&system)? - state.energy(&self.system)?;
        self.system = system;
        self.run.node.add_energy(brought);
        self.run.last.is_step = false;
        self.failure = None;
        Ok(())
    }

    fn set_state(&mut self, state: State<N>) -> Result<(), StepError> {
        let brought = state.energy(&self.system)? - self.state().energy(&self.system)?;
        let v = state.velocity(&self.system)?;
        let mut node = self.run.node.with_state(state);
        node.add_energy(brought);
        self.run = Run { node, last: Last { v, ..self.run.last }, ..self.run };
        let last = self.run.last;
        self.run.resume_after(&last);
        self.failure = None;
        Ok(())
    }

    fn path(&self, before: &State<N>) -> Result<Hermite<N>, StepError> {
        Hermite::between(&self.system, before, &self.state(), self.h())
    }

    fn longest(&self) -> f64 {
        longest(self.run.bounds.as_ref(), self.h())
    }

    fn set_time(&mut self, t: f64) {
        self.run.node.set_time(t);
    }
}
