//! The run of energy-preserving Gauss steps as one integrator among others.
//!
//! In: a run. Out: what [`Integrator`] asks. A change of the parameters or of the state brings the energy `ΔH` to the node, and the run
//! goes on with `E + ΔH`: so `H − E`, from which the length of the next step follows, is what it was.

use super::run::Checkpoint;
use super::{EnergyPreservingGauss, Phase};
use crate::collocation::Collocation;
use crate::energy_preserving::fallback::{check_step, longest};
use crate::energy_preserving::interval::RATIO;
use crate::error::StepError;
use crate::gauss::{Motion, Run};
use crate::integrator::{Integrator, changed, own};
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;

impl<S, const N: usize, const STAGES: usize> EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    /// Takes one fixed step of the length `h`, in units of time; the energy to preserve stays, with the work done. The next step follows as
    /// if the last one had its own length.
    ///
    /// # Errors
    /// [`StepError::StagesUnsettled`], [`StepError::NonFinite`], and [`StepError::InvalidInput`] for an h that is not positive, or subnormal.
    /// The run is then what it was, and may go on.
    pub fn step_of(&mut self, h: f64) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        check_step("the step h", h)?;
        let step = self.stepper().trial_of(h)?;
        let mut node = step.after.node;
        node.add_energy(step.work);
        node.check_finite(self.gauss.run.node.t)?;
        self.go_on_from(node)?;
        self.course.phase = self.course.phase.map(|phase| Phase { gap: step.residual, ..phase });
        Ok(self.state())
    }

    /// Goes on from a node, as if the last step had led there.
    fn go_on_from(&mut self, node: Node<N>) -> Result<(), StepError> {
        let before = self.gauss.run;
        self.gauss.run = Run::new(&self.gauss.system, node, self.course.h())?;
        self.stepper().measure_excess().inspect_err(|_| self.gauss.run = before)
    }
}

impl<S, const N: usize, const STAGES: usize> Integrator<N> for EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    type System = S;
    type Path = Motion<N, STAGES>;
    type Checkpoint = Checkpoint<N, STAGES>;

    const LONGEST: f64 = RATIO;

    own!(step, step_of, system, h, checkpoint);

    fn node(&self) -> &Node<N> {
        self.gauss.node()
    }

    fn discrete_energy(&self) -> Option<f64> {
        Some(self.discrete_energy())
    }

    fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.gauss.system, change)?;
        let state = self.state();
        let brought = state.energy(&system)? - state.energy(&self.gauss.system)?;
        let before = (self.gauss.system, self.gauss.run.node);
        self.gauss.system = system;
        self.gauss.run.node.add_energy(brought);
        self.stepper().measure_excess().inspect_err(|_| (self.gauss.system, self.gauss.run.node) = before)?;
        self.failure = None;
        Ok(())
    }

    fn set_state(&mut self, state: State<N>) -> Result<(), StepError> {
        let system = &self.gauss.system;
        let brought = state.energy(system)? - self.state().energy(system)?;
        let mut node = self.gauss.run.node.with_state(state);
        node.add_energy(brought);
        self.go_on_from(node)?;
        self.failure = None;
        Ok(())
    }

    fn path(&self, before: &State<N>) -> Result<Motion<N, STAGES>, StepError> {
        self.gauss.path(before)
    }

    fn longest(&self) -> f64 {
        longest(self.course.bounds.as_ref(), self.h())
    }

    fn set_time(&mut self, t: f64) {
        self.gauss.set_time(t);
    }
}
